"""What every path planner keeps, in regions and on grids."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.paths.brute import grid_sees
from tests.motion.paths.spaces import grids, places_in, regions

from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.maps.free_points import free
from muster.motion.path import NoPath, Path
from muster.motion.paths import PLANNERS, find
from muster.motion.paths.dubins import Parameters as Dubins
from muster.motion.paths.random_tree import TreeParameters
from muster.motion.paths.rrt_star import Parameters as RrtStar

EFFORT = {
    "rrt": TreeParameters(iterations=300),
    "rrt-star": RrtStar(iterations=300),
    "dubins": Dubins(turning_radius_m=0.2),
}
COMPLETE = ("shortest", "bug")
REASONS = ("start blocked", "goal blocked", "disconnected", "not found")
every_planner = pytest.mark.parametrize("planner", PLANNERS)


def answer_of(space, ends, planner, seed=0):
    return find(space, *ends, planner=planner, seed=seed, params=EFFORT.get(planner))


def kept(space, ends, planner, answer):
    """Ends, length and reasons as the interface promises them."""
    shortest = find(space, *ends)
    if isinstance(answer, NoPath):
        assert answer.reason in REASONS
        if planner in COMPLETE or answer.reason == "disconnected":
            assert isinstance(shortest, NoPath)
        return False
    assert answer.points[0].tolist() == pytest.approx(list(ends[0]), abs=0)
    assert answer.points[-1].tolist() == pytest.approx(list(ends[1]), abs=0)
    assert isinstance(shortest, Path)
    assert answer.length_m >= shortest.length_m * (1 - 1e-9)
    return True


@pytest.mark.long(keep=5)
@every_planner
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_in_regions(planner, data):
    space, ends = data.draw(regions()), data.draw(places_in(2))
    answer = answer_of(space, ends, planner)
    if kept(space, ends, planner, answer) and len(answer.points) > 1:
        assert space.region.buffer(1e-6).covers(shapely.LineString(answer.points))


@pytest.mark.long(keep=5)
@every_planner
@settings(max_examples=25, deadline=None)
@given(data=st.data())
def test_on_grids(planner, data):
    space = data.draw(grids())
    rows, columns = space.grid.shape
    ends = [(data.draw(st.integers(0, columns - 1)) + 0.5, data.draw(st.integers(0, rows - 1)) + 0.5) for _ in range(2)]
    answer = answer_of(space, ends, planner)
    if kept(space, ends, planner, answer):
        for a, b in zip(answer.points[:-1], answer.points[1:], strict=True):
            assert free(space, a + np.linspace(0, 1, 20)[:, None] * (b - a)).all()
            assert planner not in ("shortest", "theta-star") or grid_sees(space.grid.blocked, a, b)


@pytest.mark.long(keep=5)
@every_planner
def test_the_same_for_the_same_seed(planner):
    space = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(4, 2, 6, 9)))
    once, again = (answer_of(space, ((1, 5), (9, 6)), planner, seed=3) for _ in range(2))
    assert type(once) is type(again)
    assert isinstance(once, NoPath) or np.array_equal(once.points, again.points)


@every_planner
def test_no_way_is_a_value(planner):
    walled = PolygonSpace(shapely.box(0, 0, 4, 10).union(shapely.box(6, 0, 10, 10)))
    answer = answer_of(walled, ((1, 5), (9, 5)), planner)
    assert isinstance(answer, NoPath)
    blocked = np.zeros((9, 9), dtype=bool)
    blocked[:, 4] = True
    blocked[4, 4], blocked[4, 3] = False, True  # free at corners alone
    blocked[4, 5] = True
    assert isinstance(answer_of(GridSpace(Grid(blocked, 1.0)), ((0.5, 4.5), (8.5, 4.5)), planner), NoPath)


@every_planner
def test_a_path_to_the_start_is_a_point(planner):
    space = PolygonSpace(shapely.box(0, 0, 10, 10))
    answer = answer_of(space, ((2, 3), (2, 3)), planner)
    assert answer.length_m == 0
