"""Dijkstra, A* and Theta* on grids: against SciPy, each other, and an independent check of what is free."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.paths.brute import grid_sees
from tests.motion.paths.spaces import grids, places_on, regions

from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, Prism, PrismSpace
from muster.motion.grid import Grid
from muster.motion.path import NoPath, Path
from muster.motion.paths import PLANNERS, find
from muster.motion.paths.on_grid import Parameters

ON_GRIDS = ("dijkstra", "a-star", "theta-star", "shortest")


def cell_lengths(blocked, start):
    """SciPy's lengths from the cell `start` (row, column) over eight neighbours without cut corners."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    rows, columns = blocked.shape
    links = []
    for row, column in np.argwhere(~blocked):
        for down, right in ((0, 1), (1, 0), (1, 1), (1, -1)):
            r, c = row + down, column + right
            corner_is_free = 0 <= r < rows and 0 <= c < columns and not blocked[row : r + 1, sorted((column, c))].any()
            if corner_is_free:
                links.append((row * columns + column, r * columns + c, np.hypot(down, right)))
    if not links:
        links = [(0, 0, 0.0)]
    a, b, weights = (list(column) for column in zip(*links, strict=True))
    graph = csr_array((weights, (a, b)), shape=(blocked.size, blocked.size))
    return dijkstra(graph, directed=False, indices=start[0] * columns + start[1]).reshape(rows, columns)


def length(answer):
    return answer.length_m if isinstance(answer, Path) else np.inf


@settings(max_examples=60)
@given(st.data())
def test_dijkstra_and_a_star_are_as_short_as_scipy_says(data):
    space = data.draw(grids(12))
    blocked = space.grid.blocked
    if blocked.all():
        return
    free = np.argwhere(~blocked)
    start, goal = (free[data.draw(st.integers(0, len(free) - 1))] for _ in range(2))
    wanted = cell_lengths(blocked, start)[*goal]
    for planner in ("dijkstra", "a-star"):
        assert length(find(space, start[::-1] + 0.5, goal[::-1] + 0.5, planner=planner)) == pytest.approx(
            wanted, rel=1e-9
        )


@settings(max_examples=80)
@given(st.data())
def test_each_planner_is_at_most_as_long_as_the_one_before(data):
    space = data.draw(grids(12))
    start, goal = data.draw(places_on(space, 2))
    answers = [find(space, start, goal, planner=planner) for planner in ON_GRIDS]
    lengths = [length(answer) for answer in answers]
    assert lengths[1] == pytest.approx(lengths[0], rel=1e-9)
    assert lengths[2] <= lengths[1] * (1 + 1e-12) or lengths[1] == np.inf == lengths[2]
    assert lengths[3] <= lengths[2] * (1 + 1e-12) or lengths[2] == np.inf


@settings(max_examples=60)
@given(st.data())
def test_paths_stay_in_free_cells_and_join_the_points_given(data):
    space = data.draw(grids())
    start, goal = data.draw(places_on(space, 2))
    for planner in ON_GRIDS:
        answer = find(space, start, goal, planner=planner)
        if isinstance(answer, NoPath):
            continue
        assert tuple(answer.points[0]) == start
        assert tuple(answer.points[-1]) == goal
        for a, b in zip(answer.points, answer.points[1:], strict=False):
            assert grid_sees(space.grid.blocked, a, b), (planner, a, b)


@settings(max_examples=20, deadline=None)
@given(st.integers(0, 2**32 - 1))
def test_over_open_ground_theta_star_stays_in_free_cells(seed):
    """Few blocks on much ground: each look passes over many columns at once."""
    rng = np.random.default_rng(seed)
    blocked = rng.random((40, 50)) < 0.01
    for row, column, down, right in rng.integers(0, 25, (3, 4)):
        blocked[row : row + down, column : column + right] = True
    free = np.argwhere(~blocked)
    if len(free) < 2:
        return
    start, goal = free[rng.choice(len(free), 2)][:, ::-1] + 0.5
    space = GridSpace(Grid(blocked, 1.0))
    answer = find(space, start, goal, planner="theta-star")
    assert length(find(space, start, goal)) <= length(answer) * (1 + 1e-12)
    assert length(answer) <= length(find(space, start, goal, planner="a-star")) * (1 + 1e-12)
    if isinstance(answer, Path):
        assert all(grid_sees(blocked, a, b) for a, b in zip(answer.points, answer.points[1:], strict=False))


@settings(max_examples=25)
@given(regions(), st.integers(0, 2**32 - 1))
def test_paths_over_a_region_stay_in_it(space, seed):
    points = np.random.default_rng(seed).uniform((0, 0), (16, 12), (2, 2))
    for planner in ("a-star", "theta-star"):
        answer = find(space, *points, planner=planner, params=Parameters(resolution_m=0.25))
        if isinstance(answer, Path):
            assert space.region.buffer(1e-9).covers(shapely.LineString([*answer.points, answer.points[-1]]))


@pytest.mark.parametrize("planner", PLANNERS)
def test_no_path_is_a_value_with_its_reason(planner):
    blocked = np.zeros((6, 6), dtype=bool)
    blocked[3] = True
    space = GridSpace(Grid(blocked, 0.5, (10.0, 20.0, 0.3)))
    to_map = space.grid.to_map
    here, wall, beyond = to_map(np.array([[1.5, 1.5], [2.5, 3.5], [4.5, 5.5]]))
    assert find(space, wall, here, planner=planner).reason == "start blocked"
    assert find(space, here, wall, planner=planner).reason == "goal blocked"
    assert find(space, here, (0.0, 0.0), planner=planner).reason == "goal blocked"
    assert find(space, here, beyond, planner=planner).reason == (
        "not found" if planner in ("rrt-star", "rrt", "potential-field") else "disconnected"
    )


@pytest.mark.parametrize("planner", PLANNERS)
def test_nothing_passes_between_blocked_cells_that_touch(planner):
    blocked = np.zeros((8, 8), dtype=bool)
    blocked[np.arange(8), np.arange(8)] = True
    assert isinstance(find(GridSpace(Grid(blocked, 1.0)), (5.5, 0.5), (0.5, 5.5), planner=planner), NoPath)


@pytest.mark.parametrize("planner", PLANNERS)
def test_from_a_point_to_itself(planner):
    answer = find(GridSpace(Grid(np.zeros((3, 3), dtype=bool), 1.0)), (1.2, 1.2), (1.2, 1.2), planner=planner)
    assert answer.points.tolist() == [[1.2, 1.2]]


def test_a_turned_grid_gives_the_same_lengths():
    rng = np.random.default_rng(3)
    blocked = rng.random((20, 30)) < 0.2
    plain, turned = GridSpace(Grid(blocked, 1.0)), GridSpace(Grid(blocked, 0.05, (100.0, -40.0, 2.1)))
    ends = np.argwhere(~blocked)[[0, -1]][:, ::-1] + 0.5
    for planner in ("dijkstra", "a-star", "shortest"):  # theta-star breaks ties by the last bit
        there = length(find(turned, *turned.grid.to_map(ends), planner=planner))
        assert there == pytest.approx(0.05 * length(find(plain, *ends, planner=planner)), rel=1e-9)
        assert np.isfinite(there)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"planner": "astar"}, "planner: astar; expected shortest"),
        ({"start": (1, 2, 3, 4)}, "start: an array of shape"),
        ({"goal": (1, np.nan)}, "goal: not finite"),
        ({"seed": -1}, "seed: -1"),
    ],
)
def test_what_is_wrong_is_named(change, message):
    asked = {"start": (0.5, 0.5), "goal": (1.5, 1.5), "planner": "a-star"} | change
    with pytest.raises(ParameterError, match=message):
        find(GridSpace(Grid(np.zeros((3, 3), dtype=bool), 1.0)), **asked)


def test_grids_are_not_for_the_air():
    space = PrismSpace(shapely.box(0, 0, 1, 1), (Prism(shapely.box(2, 2, 3, 3), 0, 1),))
    with pytest.raises(ParameterError, match="expected shortest, rrt-star or rrt"):
        find(space, (0, 0, 0), (1, 1, 1), planner="a-star")


def test_a_region_too_coarse_around_the_start_says_so():
    space = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(1, 1, 9, 9)))
    answer = find(space, (0.5, 0.5), (9.5, 9.5), planner="a-star", params=Parameters(resolution_m=2.0))
    assert answer.reason == "start blocked"
    assert "a grid of 2 m" in answer.detail
