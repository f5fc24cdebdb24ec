"""Dubins words against the circles they are made of, and the planner that strings them together."""

import math

import numpy as np
import pytest
import shapely
from hypothesis import example, given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.free_space import PolygonSpace
from muster.motion.path import NoPath
from muster.motion.paths import find
from muster.motion.paths.dubins import Parameters
from muster.motion.paths.dubins_words import words

metres, angle, radii = st.floats(-5, 5), st.floats(-7, 7), st.floats(0.1, 3)
poses = st.tuples(metres, metres, angle)
ROOM = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(4, 2, 6, 10)))


def circle(pose, radius, side):
    x, y, heading = pose
    return np.array([x - side * radius * math.sin(heading), y + side * radius * math.cos(heading)])


@given(start=poses, end=poses, radius=radii)
def test_every_word_ends_at_the_pose(start, end, radius):
    found = words(start, end, radius)
    assert {"LSL", "RSR"} <= {path.word for path in found}
    for path in found:
        assert path.end[:2] == pytest.approx(end[:2], abs=1e-6)
        assert math.remainder(path.end[2] - end[2], 2 * math.pi) == pytest.approx(0, abs=1e-6)
        assert min(path.lengths_m) >= 0


@given(start=poses, end=poses, radius=radii)
def test_straight_pieces_are_common_tangents(start, end, radius):
    """Outer tangents are as long as the centres are apart; inner ones are a leg of a right triangle."""
    for path in words(start, end, radius):
        if path.word[1] != "S":
            continue
        sides = [1 if letter == "L" else -1 for letter in (path.word[0], path.word[2])]
        apart = np.linalg.norm(circle(end, radius, sides[1]) - circle(start, radius, sides[0]))
        squared = apart**2 if sides[0] == sides[1] else apart**2 - 4 * radius**2
        assert path.lengths_m[1] == pytest.approx(math.sqrt(max(squared, 0)), abs=1e-4)


@given(start=poses, end=poses, radius=radii)
@example(start=(0.0, 0.0, -0.7606050866537855), end=(0.0, 0.0, -0.7606050866537855), radius=1.0)
def test_the_way_back_is_as_long(start, end, radius):
    turned = [(x, y, heading + math.pi) for x, y, heading in (end, start)]
    assert words(*turned, radius)[0].length_m == pytest.approx(words(start, end, radius)[0].length_m, abs=1e-4)


def test_known_words():
    assert words((0, 0, 0), (4, 0, 0), 1)[0].length_m == pytest.approx(4)
    half = words((0, 0, 0), (0, 2, math.pi), 1)[0]
    assert half.length_m == pytest.approx(math.pi)
    about = words((0, 0, 0), (0, 0, math.pi), 1)[0]  # turn about on the spot: three arcs
    assert (about.word in ("LRL", "RLR"), about.length_m) == (True, pytest.approx(math.pi * 7 / 3))


@pytest.mark.parametrize("radius", [0.1, 0.5, 1.0])
def test_the_planner_keeps_curvature_and_walls(radius):
    params = Parameters(turning_radius_m=radius, start_heading_rad=math.pi, goal_heading_rad=0.0)
    found = find(ROOM, (1.5, 5), (8, 5), planner="dubins", params=params)
    assert ROOM.region.covers(shapely.LineString(found.points))
    steps = np.diff(found.points, axis=0)
    headings = np.arctan2(steps[:, 1], steps[:, 0])
    turns = np.abs(np.remainder(np.diff(headings) + np.pi, 2 * np.pi) - np.pi)
    lengths = np.linalg.norm(steps, axis=1)
    assert turns.max() <= 0.0501
    assert (turns <= (lengths[:-1] + lengths[1:]) / 2 / radius * 1.01 + 1e-6).all()
    assert abs(math.remainder(headings[0] - math.pi, 2 * math.pi)) < 0.03
    assert abs(headings[-1]) < 0.03


def test_a_radius_that_the_room_does_not_leave_is_told():
    answer = find(
        ROOM, (1, 5), (9, 5), planner="dubins", params=Parameters(turning_radius_m=8.0, start_heading_rad=math.pi)
    )
    assert isinstance(answer, NoPath)
    assert "turning radius of 8 m" in answer.detail


@pytest.mark.parametrize("wrong", [{"turning_radius_m": 0}, {"start_heading_rad": math.inf}])
def test_parameters_check_themselves(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        Parameters(**wrong)
