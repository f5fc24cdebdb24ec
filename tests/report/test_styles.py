from itertools import combinations

from muster.report.figures.styles import LEFT_OUT, PALETTE, luminance, robot_style


def contrast(one: str, other: str) -> float:
    """WCAG 2 contrast ratio."""
    light, dark = sorted((luminance(one), luminance(other)), reverse=True)
    return (light + 0.05) / (dark + 0.05)


def test_thirty_two_robots_all_look_different():
    assert len({robot_style(k) for k in range(32)}) == 32


def test_no_colour_is_faint_on_white():
    assert min(contrast(color, "#ffffff") for color in PALETTE) > 2


def test_numbers_are_legible_on_every_colour():
    inks = {"white": "#ffffff", "#111111": "#111111"}
    assert min(contrast(robot_style(k).color, inks[robot_style(k).ink]) for k in range(8)) > 3.5


def test_no_robot_is_the_grey_of_what_is_left_out():
    assert LEFT_OUT not in PALETTE


def seen(color: str) -> tuple[float, ...]:
    """Linear light of a colour as a deuteranope sees it; matrix of Vienot, Brettel and Mollon (1999)."""
    channels = [int(color[k : k + 2], 16) / 255 for k in (1, 3, 5)]
    red, green, blue = (c**2.2 for c in channels)
    return (0.29275 * red + 0.70725 * green, -0.02234 * red + 0.02234 * green + blue)


def test_colours_differ_for_deuteranopes_too():
    for one, other in combinations(PALETTE, 2):
        apart = [abs(a ** (1 / 2.2) - b ** (1 / 2.2)) for a, b in zip(map_of(one), map_of(other), strict=True)]
        assert max(apart) > 0.08, (one, other)


def map_of(color: str) -> tuple[float, ...]:
    return tuple(max(value, 0.0) for value in seen(color))


def test_luminance_of_known_colours():
    assert luminance("#000000") == 0
    assert abs(luminance("#ffffff") - 1) < 1e-12
    assert abs(luminance("#0072B2") - 0.1524) < 1e-3
