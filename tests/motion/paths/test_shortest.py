"""The shortest paths in the plane against all pairs of all vertices, and their lengths against the paths."""

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from tests.motion.paths.brute import cells_region, grid_lengths, region_lengths, sparse_region_lengths
from tests.motion.paths.spaces import grids, places_in, places_on, regions

from muster import core
from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.path import Path
from muster.motion.paths import PLANNERS, PathFinder, find, travel_lengths


def path_lengths(finder, places):
    answers = [[finder.path(a, b) for b in places] for a in places]
    return np.array([[a.length_m if isinstance(a, Path) else np.inf for a in row] for row in answers])


def assert_lengths(space, places, wanted):
    finder, wanted = PathFinder(space), pytest.approx(wanted, rel=1e-9, abs=1e-12)
    assert path_lengths(finder, places) == wanted  # looking where it comes by
    assert finder.lengths(places) == wanted
    assert path_lengths(finder, places) == wanted  # with the graph


@settings(max_examples=40, deadline=None)
@given(st.data())
def test_on_grids_nothing_is_shorter(data):
    space = data.draw(grids(5))
    places = data.draw(places_on(space, 3))
    wanted = grid_lengths(space.grid.blocked, places)
    assert_lengths(space, places, wanted)


@settings(max_examples=40, deadline=None)
@given(regions(), places_in(4))
def test_in_regions_nothing_is_shorter(space, places):
    wanted = region_lengths(space.region, places)
    assert_lengths(space, places, wanted)


def without_pinches(blocked):
    """Where two blocked cells touch at a corner, the free ones beside them are blocked too, until none do."""
    while True:
        a, b, c, d = blocked[:-1, :-1], blocked[:-1, 1:], blocked[1:, :-1], blocked[1:, 1:]
        pinches = (a & d & ~b & ~c) | (b & c & ~a & ~d)
        if not pinches.any():
            return blocked
        blocked[:-1, :-1] |= pinches
        blocked[1:, 1:] |= pinches
        blocked[:-1, 1:] |= pinches
        blocked[1:, :-1] |= pinches


@pytest.mark.long
@pytest.mark.parametrize("seed", range(2))
def test_among_many_corners_nothing_is_shorter(seed):
    """So many that each way is bounded by one over cells, and looked for in an ellipse."""
    rng = np.random.default_rng(seed)
    blocked = without_pinches(rng.random((40, 40)) < (0.07, 0.12)[seed % 2])
    blocked[20, : 32 + seed] = True
    blocked = without_pinches(blocked)
    space = GridSpace(Grid(blocked, 1.0))
    assert core.Ways.on_grid(core.GridMap(blocked)).corners > 256
    free = np.argwhere(~blocked)
    places = free[rng.choice(len(free), 8, replace=False)][:, ::-1] + 0.5
    assert_lengths(space, places, sparse_region_lengths(cells_region(blocked), places))


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("share", [0.01, 0.05, 0.3])
def test_a_way_alone_is_as_long_as_in_the_graph(share):
    rng = np.random.default_rng(7)
    blocked = rng.random((150, 200)) < share
    blocked[75, :180] = True
    ways = core.Ways.on_grid(core.GridMap(blocked))
    free = np.argwhere(~blocked)
    places = free[rng.choice(len(free), 12, replace=False)][:, ::-1] + 0.5
    alone = [[core_length(ways, a, b) for b in places] for a in places]
    while not ways.built:
        ways.build(1000, 1)
    in_graph = [[core_length(ways, a, b) for b in places] for a in places]
    assert np.array(alone) == pytest.approx(np.array(in_graph), rel=1e-9)
    assert np.isfinite(alone).any()


def core_length(ways, a, b):
    way = ways.way(tuple(a), tuple(b))
    return np.linalg.norm(np.diff(way, axis=0), axis=1).sum() if len(way) else np.inf


@pytest.mark.long
def test_the_graph_is_built_when_ways_have_looked_around_as_many_corners():
    blocked = np.random.default_rng(7).random((60, 60)) < 0.2
    ways = core.Ways.on_grid(core.GridMap(blocked))
    free = np.argwhere(~blocked)[:, ::-1] + 0.5
    assert ways.lengths_alone(free[[0, -1]], free[[0, -1]], mutual=True) is not None
    assert not ways.graph_pays
    assert ways.lengths_alone(free, free, mutual=True) is None
    assert ways.graph_pays
    finder = PathFinder(GridSpace(Grid(blocked, 1.0)))
    assert finder.lengths(free[::40]) == pytest.approx(path_lengths(finder, free[::40]), rel=1e-9)


@settings(max_examples=30, deadline=None)
@given(regions(), st.integers(0, 2**32 - 1))
def test_paths_stay_in_the_region(space, seed):
    a, b = np.random.default_rng(seed).uniform((0, 0), (16, 12), (2, 2))
    answer = find(space, a, b)
    if isinstance(answer, Path):
        assert space.region.buffer(1e-6).covers(shapely.LineString(answer.points))
    else:
        assert (answer.reason == "start blocked") == (not space.region.covers(shapely.Point(a)))


@pytest.mark.parametrize("kind", ["grid", "region"])
def test_lengths_are_symmetric_and_those_of_the_paths(kind):
    rng = np.random.default_rng(5)
    if kind == "grid":
        space = GridSpace(Grid(rng.random((60, 80)) < 0.3, 0.25, (3.0, -2.0, 0.7)))
        places = space.grid.to_map(rng.uniform((0, 0), (80, 60), (20, 2)))
    else:
        holes = [shapely.Point(p).buffer(1.5) for p in rng.uniform(0, 30, (20, 2))]
        space = PolygonSpace(shapely.box(0, 0, 30, 30).difference(shapely.unary_union(holes)))
        places = rng.uniform(0, 30, (20, 2))
    finder = PathFinder(space)
    lengths = finder.lengths(places)
    assert (lengths == lengths.T).all()
    assert np.isfinite(lengths).any()
    assert np.isinf(lengths).any()
    assert lengths == pytest.approx(path_lengths(finder, places), rel=1e-9)
    assert (lengths == travel_lengths(space, places, places.copy(), threads=2)).all()
    others = rng.permutation(places) + 0.01
    assert travel_lengths(space, places, others) == pytest.approx(travel_lengths(space, others, places).T, rel=1e-9)


def test_around_a_square():
    space = PolygonSpace(shapely.box(0, 0, 10, 10).difference(shapely.box(4, 2, 6, 9)))
    answer = find(space, (1, 5), (9, 5))
    assert answer.points.tolist() == [[1, 5], [4, 2], [6, 2], [9, 5]]
    assert answer.length_m == pytest.approx(2 * np.sqrt(18) + 2)


def test_rooms_without_a_door_are_disconnected():
    space = PolygonSpace(shapely.union(shapely.box(0, 0, 1, 1), shapely.box(2, 0, 3, 1)))
    assert find(space, (0.5, 0.5), (2.5, 0.5)).reason == "disconnected"
    assert find(space, (1.5, 0.5), (2.5, 0.5)).reason == "start blocked"
    assert find(space, (0.5, 0.5), (1e12, 0.5)).reason == "goal blocked"


def test_a_place_on_the_border_is_free():
    space = PolygonSpace(shapely.box(0, 0, 3, 3).difference(shapely.box(1, 1, 2, 2)))
    assert find(space, (1, 1.5), (2, 1.5)).length_m == pytest.approx(2.0)
    assert find(space, (0, 0), (3, 3)).length_m == pytest.approx(2 * np.sqrt(5))


@pytest.mark.parametrize("planner", PLANNERS)
def test_an_empty_space_is_blocked_everywhere(planner):
    space = PolygonSpace(shapely.Polygon())
    assert find(space, (0, 0), (1, 1), planner=planner).reason == "start blocked"
    assert np.isinf(travel_lengths(space, [(0, 0)], [(0, 0)])).all()


def test_no_places_no_lengths():
    assert travel_lengths(
        GridSpace(Grid(np.zeros((2, 2), dtype=bool), 1.0)), np.empty((0, 2)), np.empty((0, 2))
    ).shape == (0, 0)


@pytest.mark.parametrize(("places", "threads"), [([1.0, 2.0], 1), ([[1.0]], 1), ([[0.5, 0.5]], 0)])
def test_bad_places_are_named(places, threads):
    with pytest.raises(ParameterError):
        travel_lengths(GridSpace(Grid(np.zeros((2, 2), dtype=bool), 1.0)), places, places, threads)


def test_what_leaves_the_region_is_not_clear():
    finder = PathFinder(PolygonSpace(shapely.box(0, 0, 10, 10)))
    assert finder.clear(np.array([[1.0, 5.0], [10.0, 5.0]]))
    assert not finder.clear(np.array([[0.2, 5.0], [-0.2, 5.0]]))
    assert not finder.clear(np.array([[-0.2, 5.0], [-3.0, 5.0]]))
