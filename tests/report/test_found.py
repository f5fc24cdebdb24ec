"""Pictures of points of interest and of what a camera saw: what is drawn is what was given."""

import numpy as np
import pytest

pytest.importorskip("matplotlib")
pytest.importorskip("cv2")
pytest.importorskip("scipy")

from muster.perception.clusters import by_tag
from muster.perception.detection import Sighting, Sightings
from muster.perception.estimates import RawEstimates
from muster.perception.matching import error_table
from muster.perception.points_of_interest import points_of_interest
from muster.report.figures.styles import ALARM
from muster.report.found import plot_found
from muster_physics.camera_view import with_sightings

TRUTH = {"1": (0.0, 0.0), "2": (5.0, 5.0), "3": (9.0, 0.0)}


def drawn():
    parts = [
        RawEstimates.at([[0.1, 0.0], [0.0, 0.2], [0.2, 0.2]], [1, 1, 1], "r_0"),
        RawEstimates.at([[5.0, 5.1], [-4.0, 8.0]], [2, 7], "r_1"),
    ]
    raw = RawEstimates.joined(parts)
    points = points_of_interest(raw, by_tag(raw, 1.0))
    table = error_table([point.position for point in points], TRUTH, farthest_m=1.0)
    return raw, points, table, plot_found(raw, points, table, TRUTH, "six tags")


def test_estimates_are_drawn_by_robot_and_the_truth_by_name():
    from matplotlib.colors import to_hex

    raw, points, _, ax = drawn()
    dots = [line.get_xydata().tolist() for line in ax.lines if line.get_marker() == "."]
    assert dots == [raw.positions[:3].tolist(), raw.positions[3:].tolist()]
    crosses = {tuple(line.get_xydata()[0]): to_hex(line.get_color()) for line in ax.lines if line.get_marker() == "+"}
    assert set(crosses) == set(TRUTH.values())
    assert [place for place, color in crosses.items() if color == ALARM.lower()] == [TRUTH["3"]]
    circles = {tuple(line.get_xydata()[0]): to_hex(line.get_color()) for line in ax.lines if line.get_marker() == "o"}
    assert set(circles) == {tuple(point.position) for point in points}
    assert [place for place, color in circles.items() if color == ALARM.lower()] == [(-4.0, 8.0)]
    assert {"1", "2", "3"} <= {text.get_text() for text in ax.texts}
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["seen by r_0", "seen by r_1"]


def test_the_facts_are_those_of_the_table():
    _, _, table, ax = drawn()
    (facts,) = [text.get_text() for text in ax.texts if text.get_gid() == "facts"]
    worst = table.matches[0]
    assert facts == (
        f"2 of 3 found · mean error {table.mean_error_m:.3f} m · greatest {worst.error_m:.3f} m ({worst.name})"
        " · 1 where nothing is"
    )


def test_an_ellipse_is_three_deviations_wide_and_drawn_only_where_known():
    _, points, _, ax = drawn()
    (ellipse,) = ax.patches
    squares = np.sort(np.linalg.eigvalsh(points[0].covariance))
    np.testing.assert_allclose(sorted([ellipse.width, ellipse.height]), 6 * np.sqrt(squares))


def test_nothing_seen_is_a_picture_of_what_is_there():
    nothing = RawEstimates.joined([])
    ax = plot_found(nothing, (), error_table([], TRUTH), TRUTH, "nothing")
    assert [text.get_text() for text in ax.texts if text.get_gid() == "facts"] == ["0 of 3 found"]


@pytest.mark.parametrize("shape", [(100, 120), (100, 120, 3)])
def test_tags_are_drawn_into_the_image(shape):
    image = np.full(shape, 90, dtype=np.uint8)
    square = np.array([[20.5, 20.5], [60.5, 20.5], [60.5, 60.5], [20.5, 60.5]])
    sighting = Sighting(3, square.mean(axis=0), square, 0, 80.0)
    once = with_sightings(image, Sightings((sighting,), ()))
    assert once.shape == (100, 120, 3)
    assert (image == 90).all()
    assert once[60, 40].tolist() == [0, 190, 90]
    assert once[20, 40].tolist() == [60, 120, 255]
    assert (once[40, 40] == 90).all()
    assert (once[61:, 62:] != 90).any() or (once[50:61, 62:] != 90).any()  # the id, at the lower right
    twice = with_sightings(image, Sightings((sighting,), (3,)))
    assert twice[60, 40].tolist() == [220, 30, 30]
