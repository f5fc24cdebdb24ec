"""A robot that goes by its laser: at the safe distance, with bounded curvature, and told where it fails."""

import math

import numpy as np
import pytest
import shapely

from muster.mission.errors import ParameterError
from muster.motion.path import NoPath
from muster.perception.laser import Scanner
from muster.simulation.unknown_obstacles import Parameters, drive


def box(x, y, width, height):
    corners = [(x, y), (x + width, y), (x + width, y + height), (x, y + height)]
    return [(*corners[k], *corners[(k + 1) % 4]) for k in range(4)]


def gap(found, walls):
    return shapely.LineString(found.poses[:, :2]).distance(
        shapely.MultiLineString([((a, b), (c, d)) for a, b, c, d in walls])
    )


def test_without_obstacles_it_goes_straight():
    found = drive(np.empty((0, 4)), (0, 0, 0), (5, 0), Parameters())
    assert found.path.length_m == pytest.approx(5, abs=0.06)
    assert len(found.edges) == 0


@pytest.mark.parametrize("seed", range(4))
def test_around_boxes_at_the_safe_distance(seed):
    random = np.random.default_rng(seed)
    walls = np.concatenate([box(*random.uniform((2, 1), (10, 7)), *random.uniform(0.2, 0.8, 2)) for _ in range(6)])
    params = Parameters(scanner=Scanner(step_rad=math.radians(1), range_m=0.005, stray_share=0.002), safe_m=0.35)
    found = drive(walls, (0.5, 4, 0), (11.5, 4), params, seed=seed)
    assert math.dist(found.poses[-1, :2], (11.5, 4)) <= 0.05
    assert gap(found, walls) > 0.25
    turns = np.abs(np.remainder(np.diff(found.poses[:, 2]) + np.pi, 2 * np.pi) - np.pi)
    assert turns.max() <= params.step_m / params.turning_radius_m + 1e-9


def test_it_takes_the_nearer_side_and_the_edge_is_that_of_the_inflated_obstacle():
    walls = np.array(box(4, -0.5, 0.5, 3))
    found = drive(walls, (0, 0, 0), (8, 0), Parameters(safe_m=0.3))
    assert found.path.points[:, 1].min() < -0.7
    assert found.path.points[:, 1].max() < 0.1
    edges = shapely.points(found.edges)
    corner = shapely.Point(4, -0.5)
    assert min(shapely.distance(edges, corner)) == pytest.approx(0.3, abs=0.06)


def test_a_closed_room_is_not_left():
    found = drive(np.array(box(-2, -2, 4, 4)), (0, 0, 0), (6, 0), Parameters(patience=3))
    assert isinstance(found, NoPath)
    assert found.reason == "not found"


@pytest.mark.parametrize("name", ["turning_radius_m", "safe_m", "patience"])
def test_parameters_check_themselves(name):
    with pytest.raises(ParameterError, match=name):
        Parameters(**{name: 0})
