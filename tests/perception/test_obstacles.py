"""Obstacles of a scan: the median, clusters, shapes with their sizes, and the edges of Figure 2.1."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.perception.laser import Scanner
from muster.perception.obstacles import Detection, clusters, median, obstacles

SCANNER = Scanner()


def box(x, y, length, width, turn):
    corners = np.array([[-length, -width], [length, -width], [length, width], [-length, width]]) / 2
    c, s = math.cos(turn), math.sin(turn)
    corners = corners @ np.array([[c, s], [-s, c]]) + [x, y]
    return np.hstack([corners, np.roll(corners, -1, axis=0)])


def seen(walls=None, discs=None, scanner=SCANNER, detection=None):
    walls = np.empty((0, 4)) if walls is None else walls
    discs = np.empty((0, 3)) if discs is None else np.array(discs, dtype=float)
    return obstacles(scanner.ranges((0, 0, 0), walls, discs), scanner.bearings, detection)


def test_the_median_takes_salt_and_pepper_out():
    ranges = np.array([2.0, 2.0, 0.1, 2.0, 2.1, math.inf, 2.1, 2.2])
    np.testing.assert_array_equal(median(ranges, 3), [2.0, 2.0, 2.0, 2.0, 2.1, 2.1, 2.2, 2.1])
    assert median(ranges, 1) is ranges


def test_clusters_are_cut_at_gaps():
    bearings = np.radians(np.arange(6.0))
    parts = clusters(np.array([1.0, 1.0, 1.5, 1.5, math.inf, 1.5]), bearings, 0.1)
    assert [len(part) for part in parts] == [2, 3]  # one missing beam is no gap at this distance
    assert clusters(np.full(6, math.inf), bearings, 0.1) == []


@given(st.floats(0.5, 3), st.floats(-1.5, 1.5), st.floats(0.1, 0.3))
def test_a_round_obstacle(away, bearing, radius):
    (obstacle,) = seen(discs=[[away * math.cos(bearing), away * math.sin(bearing), radius]])
    shape = obstacle.shape
    assert shape.name == "circle"
    assert shape.length_m == shape.width_m == pytest.approx(2 * radius, abs=0.03)
    assert math.dist(shape.position, (away * math.cos(bearing), away * math.sin(bearing))) < 0.03


@given(st.floats(1.5, 2.5), st.floats(-1.5, 1.5), st.floats(0.3, 0.6), st.floats(0.3, 0.6), st.floats(0.7, 0.87))
def test_a_box_seen_over_its_corner(away, bearing, length, width, turn):
    """Turned by about an eighth against the line of sight, so that two sides are seen well."""
    x, y = away * math.cos(bearing), away * math.sin(bearing)
    (obstacle,) = seen(box(x, y, length, width, bearing + turn))
    shape = obstacle.shape
    assert shape.name == "rectangle"
    assert shape.length_m == pytest.approx(max(length, width), abs=0.04)
    assert shape.width_m == pytest.approx(min(length, width), abs=0.04)
    assert math.dist(shape.position, (x, y)) < 0.04


def test_a_wall_is_a_line():
    (obstacle,) = seen(np.array([[1.0, -0.5, 1.0, 0.5]]))
    assert obstacle.shape.name == "line"
    assert obstacle.shape.position == pytest.approx((1.0, 0.0), abs=0.01)
    assert obstacle.shape.length_m == pytest.approx(1.0, abs=0.02)
    assert obstacle.shape.width_m == 0


def test_what_bulges_away_is_no_circle():
    """A niche, seen from within."""
    around = np.linspace(-1.0, 1.0, 40)
    points = np.column_stack([np.cos(around), np.sin(around)])
    walls = np.hstack([points[:-1], points[1:]])
    (obstacle,) = seen(walls)
    assert obstacle.shape.name == "unknown"
    assert obstacle.shape.length_m == pytest.approx(2 * math.sin(1.0), abs=0.02)
    assert obstacle.shape.width_m == pytest.approx(1 - math.cos(1.0), abs=0.02)


def test_the_obstacle_of_reference_22():
    """Up to 1 m large, up to 10 m away."""
    scanner = Scanner(reach_m=12.0)
    (obstacle,) = seen(box(10.5, 0.0, 1.0, 1.0, 0.0), scanner=scanner)
    assert obstacle.shape.name == "line"
    assert obstacle.shape.length_m == pytest.approx(1.0, abs=2 * 10 * scanner.step_rad)
    assert obstacle.shape.position[0] == pytest.approx(10.0, abs=0.01)


def test_two_obstacles_from_right_to_left():
    right, left = seen(discs=[[1.0, 0.6, 0.2], [1.0, -0.6, 0.15]])
    assert right.shape.position[1] < 0 < left.shape.position[1]


def test_strays_are_no_obstacles():
    noisy = Scanner(range_m=0.003, stray_share=0.02)
    disc = np.array([[1.5, 0.0, 0.3]])
    ranges = noisy.measured(SCANNER.ranges((0, 0, 0), discs=disc), np.random.default_rng(1))
    (obstacle,) = obstacles(ranges, SCANNER.bearings, Detection(window=5, fewest=5))
    assert obstacle.shape.name == "circle"
    assert obstacle.shape.position == pytest.approx((1.5, 0.0), abs=0.03)
    assert len(obstacles(ranges, SCANNER.bearings, Detection(window=1, fewest=1))) > 5


@given(st.floats(0.6, 3), st.floats(-1.5, 1.5), st.floats(0.05, 0.3), st.floats(0.05, 0.2))
def test_the_edges_of_a_grown_circle_are_where_lines_of_sight_touch_it(away, bearing, radius, margin):
    """Of radius r + margin: asin((r + margin) / D) to both sides of its middle, to a beam and a half."""
    (obstacle,) = seen(
        discs=[[away * math.cos(bearing), away * math.sin(bearing), radius]], detection=Detection(window=1)
    )
    turn = math.asin((radius + margin) / away)
    for edge, side in zip(obstacle.edges(margin), (turn, -turn), strict=True):
        off = math.atan2(edge[1], edge[0]) - bearing
        assert off == pytest.approx(side, abs=1.5 * SCANNER.step_rad + 0.01)
        assert away - radius - margin < np.hypot(*edge) < away


def test_within_the_margin_the_way_around_begins_where_the_robot_is():
    (obstacle,) = seen(np.array([[0.2, -0.5, 0.2, 0.5]]))
    left, right = obstacle.edges(0.6)
    assert np.hypot(*left) == np.hypot(*right) == 0


def test_refusals():
    with pytest.raises(ParameterError, match=r"^window: 2; expected an odd number of at least 1$"):
        Detection(window=2)
    with pytest.raises(ParameterError, match=r"^fewest: 0; expected a whole number of at least 1$"):
        Detection(fewest=0)
    with pytest.raises(ParameterError, match=r"^gap_m: 0; expected a finite number above 0$"):
        Detection(gap_m=0)
    with pytest.raises(ParameterError, match=r"expected \(n,\) twice"):
        obstacles(np.zeros(3), np.zeros(4))
