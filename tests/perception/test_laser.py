"""The scanner against closed forms, against another library's geometry, and when all is turned."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.laser import Scanner, faces_at, points_of

SCANNER = Scanner()
COARSE = Scanner(step_rad=math.radians(5))
angles = st.floats(-math.pi, math.pi)
places = st.tuples(st.floats(-2, 2), st.floats(-2, 2))


def test_the_scanner_of_the_paper():
    """240 degrees by 0.36 are 666.7 steps: 333 to each side of the beam straight ahead."""
    assert len(SCANNER.bearings) == 667
    assert SCANNER.bearings[333] == 0
    assert math.degrees(SCANNER.bearings[-1]) == pytest.approx(119.88)
    assert SCANNER.reach_m == 4


@given(st.floats(0.05, 3.9), angles, st.tuples(*[st.floats(-100, 100)] * 2), angles)
def test_a_wall_at_a_distance(distance, normal, place, heading):
    """At an angle t from the wall's normal a beam is distance / cos t long."""
    x, y = place
    foot = np.array([x + distance * math.cos(normal), y + distance * math.sin(normal)])
    along = 50 * np.array([-math.sin(normal), math.cos(normal)])
    ranges = COARSE.ranges((x, y, heading), np.array([[*(foot - along), *(foot + along)]]))
    cosines = np.cos(heading + COARSE.bearings - normal)
    expected = np.where(cosines > 1e-3, distance / np.maximum(cosines, 1e-3), math.inf)
    sure = np.abs(expected - 4.0) > 1e-6
    np.testing.assert_allclose(ranges[sure], np.where(expected <= 4, expected, math.inf)[sure], rtol=1e-6)


@given(st.floats(0.01, 1), st.floats(0.05, 2.5), angles, angles)
def test_a_circle(radius, gap, direction, heading):
    """At an angle t from its middle D cos t - sqrt(r^2 - D^2 sin^2 t), as far as asin(r / D) to both sides."""
    away = radius + gap
    disc = np.array([[away * math.cos(direction), away * math.sin(direction), radius]])
    ranges = SCANNER.ranges((0.0, 0.0, heading), discs=disc)
    theta = (heading + SCANNER.bearings - direction + math.pi) % (2 * math.pi) - math.pi
    hit = np.abs(theta) < math.asin(radius / away) - 1e-6
    missed = np.abs(theta) > math.asin(radius / away) + 1e-6
    formula = away * np.cos(theta) - np.sqrt(np.maximum(radius**2 - (away * np.sin(theta)) ** 2, 0))
    np.testing.assert_allclose(ranges[hit], formula[hit], atol=1e-6)
    assert np.isinf(ranges[missed]).all()


def test_from_within_a_circle_its_far_side_is_seen():
    ranges = COARSE.ranges((0.5, 0.0, 0.0), discs=np.array([[0.0, 0.0, 1.0]]))
    assert ranges[len(ranges) // 2] == pytest.approx(0.5)
    assert np.isfinite(ranges).all()


@given(st.lists(st.tuples(*[st.integers(-5000, 5000).map(lambda k: k / 1000)] * 4), min_size=1, max_size=8), angles)
def test_any_walls_as_shapely_has_them(rows, heading):
    shapely = pytest.importorskip("shapely")
    walls = np.array(rows)
    ranges = COARSE.ranges((0.0, 0.0, heading), walls)
    lines = shapely.union_all(shapely.linestrings(walls.reshape(-1, 2, 2)))
    origin = shapely.Point(0, 0)
    for bearing, met in zip(COARSE.bearings + heading, ranges, strict=True):
        beam = shapely.LineString([(0, 0), (4 * math.cos(bearing), 4 * math.sin(bearing))])
        part = beam.intersection(lines)
        if math.isinf(met):
            # a beam along a wall, or one that only just touches an end, may meet it or not
            assert part.is_empty or shapely.distance(part, shapely.MultiPoint(walls.reshape(-1, 2))) < 1e-6
        else:
            tip = shapely.Point(met * math.cos(bearing), met * math.sin(bearing))
            assert shapely.distance(tip, lines) < 1e-6
            assert part.is_empty or shapely.distance(origin, part) > met - 1e-6


@given(angles, places, angles)
def test_what_is_turned_and_moved_with_its_scanner_looks_the_same(turn, place, heading):
    c, s = math.cos(turn), math.sin(turn)
    turned = np.array([[c, -s], [s, c]])
    walls = np.array([[-1.5, -1.0, 2.0, -1.2], [2.0, -1.2, 1.0, 2.0]])
    disc = np.array([[-1.0, 1.0, 0.3]])
    there = (turned @ [0.2, 0.1] + place, heading + turn)
    moved = np.hstack([walls[:, :2] @ turned.T + place, walls[:, 2:] @ turned.T + place])
    around = np.hstack([disc[:, :2] @ turned.T + place, disc[:, 2:]])
    here = COARSE.ranges((0.2, 0.1, heading), walls, disc)
    again = COARSE.ranges((*there[0], there[1]), moved, around)
    # a beam at a rim may pass on one side of it or on the other
    assert np.sum(~np.isclose(here, again, atol=1e-6)) <= 1


def test_no_beam_slips_through_where_walls_join():
    """A fine ring of walls, each beam aimed at a joint."""
    scanner = Scanner(field_rad=math.radians(350), step_rad=math.radians(1))
    around = np.radians(np.arange(361))
    ring = 2 * np.column_stack([np.cos(around), np.sin(around)])
    ranges = scanner.ranges((0.0, 0.0, 0.0), np.hstack([ring[:-1], ring[1:]]))
    np.testing.assert_allclose(ranges, 2.0, atol=1e-9)


def test_a_map_of_cells_and_one_of_polygons():
    """The borders and sides that stop robots are what the scanner sees."""
    from muster.motion.grid import Grid
    from muster.simulation.walls import borders_of

    blocked = np.zeros((6, 8), dtype=bool)
    blocked[2, 5] = True
    ranges = COARSE.ranges((1.25, 1.25, 0.0), borders_of(Grid(blocked, 0.5)))
    assert ranges[len(ranges) // 2] == pytest.approx(1.25)  # to the cell from x = 2.5
    assert np.isfinite(ranges).all()


@pytest.mark.parametrize("name", ["market-rescue-arena", "floor"])
def test_the_nearest_thing_on_a_shipped_map_is_as_near_as_the_map_says(name):
    """Of polygons and of an image: no beam is shorter than the clearance, and the shortest is hardly longer."""
    pytest.importorskip("shapely")
    import muster
    from muster.motion.map_world import Body, World
    from muster.simulation.walls import faces_and_slabs

    mission = muster.load(name)
    world, body = World.of(mission), Body(0.0, "ground")
    walls = faces_at(faces_and_slabs(world, body)[0], 0.1)
    scanner = Scanner(field_rad=math.radians(359.9), step_rad=math.radians(0.5), reach_m=30.0)
    starts = np.array([robot.position[:2] for robot in mission.robots])
    for place, clearance in zip(starts, world.clearance(starts, "ground"), strict=True):
        nearest = scanner.ranges((*place, 0.3), walls).min()
        assert clearance - 1e-9 <= nearest <= clearance / math.cos(math.radians(0.5)) + 0.01


def test_faces_at_a_height():
    faces = np.array([[0, 0, 1, 0, -math.inf, math.inf], [0, 1, 1, 1, 2.0, 3.0]])
    np.testing.assert_array_equal(faces_at(faces, 0.1), [[0, 0, 1, 0]])
    assert len(faces_at(faces, 2.5)) == 2


def test_points_by_2_8():
    points = points_of(np.array([2.0, math.inf, 1.0]), np.array([-math.pi / 2, 0.0, math.pi / 6]))
    np.testing.assert_allclose(points, [[0, -2], [math.sqrt(3) / 2, 0.5]], atol=1e-12)


def test_noise_is_as_large_as_it_says():
    scanner = Scanner(range_m=0.02, stray_share=0.1)
    exact = np.full(100_000, 2.0)
    exact[::2] = math.inf
    said = scanner.measured(exact, np.random.default_rng(1))
    strays = np.isfinite(said[::2])
    assert strays.mean() == pytest.approx(0.1, abs=0.006)
    assert said[::2][strays].mean() == pytest.approx(2.0, abs=0.1)
    straight = said[1::2][np.abs(said[1::2] - 2) < 0.1]
    assert straight.std() == pytest.approx(0.02, rel=0.05)
    assert said[np.isfinite(said)].max() <= 4
    again = scanner.measured(exact, np.random.default_rng(1))
    np.testing.assert_array_equal(said, again)
    np.testing.assert_array_equal(Scanner().measured(exact, np.random.default_rng(1)), exact)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: Scanner(field_rad=7.0), "field_rad: 7.0; expected a number above 0 and below 2 pi"),
        (lambda: Scanner(step_rad=0.0), "step_rad: 0.0; expected a number above 0, at most field_rad"),
        (lambda: Scanner(reach_m=math.inf), "reach_m: inf; expected a finite number above 0"),
        (lambda: Scanner(range_m=-0.1), "range_m: -0.1; expected a finite number of at least 0"),
        (lambda: Scanner(stray_share=2), "stray_share: 2; expected a number from 0 to 1"),
        (lambda: SCANNER.ranges((0, 0, 0), np.zeros((2, 3))), "walls: shape (2, 3); expected (any, 4)"),
        (lambda: SCANNER.ranges((0, math.nan, 0)), "pose: (0, nan, 0); expected three finite numbers"),
        (
            lambda: SCANNER.ranges((0, 0, 0), discs=np.array([[0, 0, math.inf]])),
            "discs: a number that is not finite; expected metres",
        ),
    ],
)
def test_refusals(call, message):
    with pytest.raises(ParameterError) as refusal:
        call()
    assert str(refusal.value) == message
