"""Bug 2, potential fields and RRT: what each promises beyond the common interface."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.paths.spaces import places_in, regions

from muster.mission.errors import ParameterError
from muster.motion.free_space import PolygonSpace, Prism, PrismSpace
from muster.motion.path import NoPath, Path
from muster.motion.paths import find
from muster.motion.paths.bug import Parameters as Bug
from muster.motion.paths.potential_field import Parameters as Field
from muster.motion.paths.random_tree import TreeParameters

ROOM = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(4, 2, 6, 8)))
POCKET = shapely.box(0, 0, 10, 10).difference(
    shapely.box(6, 2, 7, 8).union(shapely.box(4, 2, 6, 3)).union(shapely.box(4, 7, 6, 8))
)


@pytest.mark.parametrize(("side", "corners"), [("left", [(4, 8), (6, 8)]), ("right", [(4, 2), (6, 2)])])
def test_the_bug_turns_to_its_side(side, corners):
    found = find(ROOM, (1, 4), (9, 4), planner="bug", params=Bug(side=side))
    assert found.points.tolist() == [[1, 4], [4, 4], *map(list, corners), [6, 4], [9, 4]]


@settings(max_examples=40)
@given(data=st.data())
def test_the_bug_goes_no_farther_than_its_bound(data):
    """[lumelsky1987], theorem 3: the line, and half of each border as often as the line crosses it."""
    space, (start, goal) = data.draw(regions()), data.draw(places_in(2))
    found = find(space, start, goal, planner="bug")
    if isinstance(found, NoPath):
        return
    line, bound = shapely.LineString([start, goal]), np.hypot(*np.subtract(goal, start))
    for polygon in shapely.get_parts(space.region):
        for ring in (polygon.exterior, *polygon.interiors):
            bound += ring.length * len(shapely.get_parts(ring.intersection(line))) / 2
    assert found.length_m <= bound + 1e-6


def test_a_field_reaches_the_goal_around_a_post():
    space = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.Point(5, 5.2).buffer(0.5)))
    found = find(space, (1, 5), (9, 5), planner="potential-field")
    assert isinstance(found, Path)
    assert found.length_m < 9
    gaps = shapely.distance(space.region.boundary, shapely.points(found.points))
    assert gaps.min() > 0.05


def test_a_field_is_caught_in_a_pocket_and_says_where():
    answer = find(PolygonSpace(POCKET), (5, 5), (9, 5), planner="potential-field")
    assert isinstance(answer, NoPath)
    assert answer.reason == "not found"
    assert answer.detail.startswith("a local minimum at (")
    assert "m from the goal" in answer.detail


def test_a_goal_beside_a_wall_is_reached_all_the_same():
    assert isinstance(find(ROOM, (1, 9), (3.99, 5), planner="potential-field"), Path)


@pytest.mark.parametrize("seed", range(3))
def test_rrt_stops_at_its_first_path(seed):
    first = find(ROOM, (1, 5), (9, 5), planner="rrt", seed=seed)
    later = find(ROOM, (1, 5), (9, 5), planner="rrt", seed=seed, params=TreeParameters(iterations=50_000))
    assert np.array_equal(first.points, later.points)
    assert first.length_m > find(ROOM, (1, 5), (9, 5), planner="rrt-star", seed=seed).length_m
    steps = np.linalg.norm(np.diff(first.points, axis=0), axis=1)
    assert steps.max() <= np.hypot(10, 10) / 10 + 1e-9


def test_rrt_flies():
    space = PrismSpace(shapely.box(0, 0, 20, 20), (Prism(shapely.box(9, -5, 11, 25), 0, 3),))
    found = find(space, (5, 10, 1), (15, 10, 1), planner="rrt")
    assert found.points[:, 2].max() >= 3


@pytest.mark.parametrize(
    ("wrong", "what"),
    [
        (lambda: Bug(side="up"), "side: up; expected left, right"),
        (lambda: Field(steps=0), "steps: 0"),
        (lambda: TreeParameters(goal_share=2), "goal_share"),
    ],
)
def test_parameters_check_themselves(wrong, what):
    with pytest.raises(ParameterError, match=what):
        wrong()
