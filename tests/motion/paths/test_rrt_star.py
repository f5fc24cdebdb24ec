"""RRT*: free, the same for a seed, near the shortest in the end."""

import numpy as np
import pytest
import shapely

from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, Prism, PrismSpace
from muster.motion.grid import Grid
from muster.motion.path import NoPath
from muster.motion.paths import find
from muster.motion.paths.rrt_star import Parameters

ROOM = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(4, 2, 6, 10)))
SHORTEST = 2 * np.hypot(3, 3) + 2


@pytest.mark.parametrize("seed", range(3))
def test_within_five_percent_and_free(seed):
    answer = find(ROOM, (1, 5), (9, 5), planner="rrt-star", seed=seed)
    assert SHORTEST * (1 - 1e-9) <= answer.length_m <= 1.05 * SHORTEST
    assert ROOM.region.buffer(1e-6).covers(shapely.LineString(answer.points))
    assert answer.points[[0, -1]].tolist() == [[1, 5], [9, 5]]


def test_more_iterations_are_never_longer():
    lengths = [
        find(ROOM, (1, 5), (9, 5), planner="rrt-star", seed=4, params=Parameters(iterations=n)).length_m
        for n in (1000, 3000, 9000)
    ]
    assert lengths == sorted(lengths, reverse=True)


def test_the_seed_decides():
    once, again, other = (find(ROOM, (1, 5), (9, 5), planner="rrt-star", seed=seed).points for seed in (1, 1, 2))
    assert np.array_equal(once, again)
    assert not np.array_equal(once, other)


def test_on_a_grid():
    blocked = np.zeros((50, 50), dtype=bool)
    blocked[10:, 20:30] = True
    answer = find(GridSpace(Grid(blocked, 0.2)), (1, 5), (9, 5), planner="rrt-star")
    assert SHORTEST * (1 - 1e-9) <= answer.length_m <= 1.05 * SHORTEST


def test_in_the_air():
    space = PrismSpace(shapely.box(0, 0, 20, 20), (Prism(shapely.box(9, -5, 11, 25), 0, 3),))
    answer = find(space, (5, 10, 1), (15, 10, 1), planner="rrt-star", params=Parameters(iterations=20_000))
    shortest = 2 * np.hypot(4, 2) + 2
    assert shortest * (1 - 1e-9) <= answer.length_m <= 1.05 * shortest


def test_too_few_samples_do_not_find():
    answer = find(ROOM, (1, 5), (9, 5), planner="rrt-star", params=Parameters(iterations=1))
    assert isinstance(answer, NoPath)
    assert answer.reason == "not found"


@pytest.mark.parametrize("wrong", [{"iterations": 0}, {"step_m": 0.0}, {"goal_share": 2.0}, {"reach": -1.0}])
def test_parameters_check_themselves(wrong):
    with pytest.raises(ParameterError, match=next(iter(wrong))):
        Parameters(**wrong)
