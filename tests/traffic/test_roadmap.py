"""The roadmap against geometry that knows nothing of it: Shapely's distances, and SciPy's labels of free cells."""

import numpy as np
import pytest
import shapely

from muster.mission.errors import ParameterError
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace
from muster.motion.grid import Grid
from muster.motion.maps.distances import inflated
from muster.motion.maps.polygons import free_region
from muster.motion.paths import PathFinder
from muster.traffic.roadmaps.edge_conflicts import conflicts
from muster.traffic.roadmaps.exact_ways import Network
from muster.traffic.roadmaps.lane_network import network
from muster.traffic.roadmaps.roadmap import Roadmap

RADIUS = 0.3


def groups(roadmap):
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components

    n = len(roadmap.points)
    links = coo_array((np.ones(len(roadmap.edges)), roadmap.edges.T), shape=(n, n))
    return connected_components(links, directed=False)[1]


def to_goal(roadmap, goal):
    """Metres along edges from each point to a goal."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import dijkstra

    n = len(roadmap.points)
    return dijkstra(coo_array((roadmap.lengths_m, roadmap.edges.T[::-1]), shape=(n, n)).tocsr(), indices=int(goal))


def noisy_grid(seed):
    """Blocked cells in clumps: rooms, bends and gaps of every width; some are turned, some coarse."""
    rng = np.random.default_rng(seed)
    resolution = rng.choice([0.1, 0.2, 0.5])
    clumps = rng.random((20, 25)) < rng.choice([0.1, 0.2, 0.3])
    clumps[3, 3:6] = clumps[3:6, 3] = False
    blocked = np.kron(clumps, np.ones((3, 3))) > 0
    return Grid(blocked, resolution, (rng.uniform(-5, 5), rng.uniform(-5, 5), rng.choice([0.0, 0.7])))


def free_points(space, count, seed):
    """Random points of the free space, metres."""
    rng = np.random.default_rng(seed)
    free = np.argwhere(~space.grid.blocked)[:, ::-1]
    return space.grid.to_map(free[rng.integers(len(free), size=count)] + rng.random((count, 2)))


@pytest.mark.long(keep=5)
@pytest.mark.parametrize("seed", range(15))
def test_a_roadmap_connects_what_the_free_cells_connect(seed):
    from scipy.ndimage import label

    space = GridSpace(inflated(noisy_grid(seed), RADIUS))
    assert not space.grid.blocked.all()
    places = free_points(space, 20, seed)
    roadmap = Roadmap.of(space, RADIUS, places)
    assert (roadmap.places >= 0).all()
    np.testing.assert_allclose(roadmap.points[roadmap.places], places, atol=1e-9)
    parts, count = label(~space.grid.blocked)
    cells = space.grid.to_grid(roadmap.points).astype(int)
    part, group = parts[cells[:, 1], cells[:, 0]], groups(roadmap)
    assert set(part) == set(range(1, count + 1))
    assert len({(int(a), int(b)) for a, b in zip(part, group, strict=True)}) == count == len(set(group))


@pytest.mark.long(keep=5)
@pytest.mark.parametrize("seed", range(10))
def test_a_robot_on_an_edge_touches_no_blocked_cell(seed):
    grid = noisy_grid(seed)
    space = GridSpace(inflated(grid, RADIUS))
    roadmap = Roadmap.of(space, RADIUS, free_points(space, 5, seed))
    ends = grid.to_grid(roadmap.points)[roadmap.edges]
    row, column = np.nonzero(grid.blocked)
    squares = shapely.STRtree(shapely.box(column, row, column + 1, row + 1))
    away = RADIUS / grid.resolution_m + roadmap.clearance_m / grid.resolution_m
    for piece, least in zip(shapely.linestrings(ends), away, strict=True):
        assert len(squares.query(piece, predicate="dwithin", distance=least - 1e-6)) == 0
    inside = shapely.box(0, 0, *grid.shape[::-1])
    assert (shapely.distance(shapely.points(ends.reshape(-1, 2)), inside.exterior) >= away.repeat(2) - 1e-6).all()


def walls(seed):
    """A hall of 12 x 10 m with boxes in it, and gaps between them of every width."""
    rng = np.random.default_rng(seed)
    low = rng.uniform((0, 0), (11, 9), size=(14, 2))
    return [shapely.box(*corner, *(corner + rng.uniform(0.3, 2.5, size=2))) for corner in low]


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(10))
def test_a_roadmap_connects_what_a_region_connects_and_keeps_the_radius(seed):
    obstacles, hall = walls(seed), shapely.box(0, 0, 12, 10)
    space = PolygonSpace(free_region(hall, obstacles, RADIUS))
    roadmap = Roadmap.of(space, RADIUS)
    pieces = shapely.linestrings(roadmap.points[roadmap.edges])
    away = np.minimum(shapely.distance(pieces, shapely.union_all(obstacles)), shapely.distance(pieces, hall.exterior))
    assert (away >= RADIUS + roadmap.clearance_m - 1e-6).all()
    parts = shapely.get_parts(space.region)
    within = np.array([shapely.dwithin(part, shapely.points(roadmap.points), 1e-9) for part in parts])
    assert (within.sum(axis=0) == 1).all()
    assert len(set(groups(roadmap))) == len(parts)
    assert set(within.argmax(axis=0)) == set(range(len(parts)))


def test_a_gap_narrower_than_a_cell_is_passed():
    hall = shapely.box(0, 0, 10, 4)
    halves = [shapely.box(4.9, 0, 5.1, 1.6985), shapely.box(4.9, 2.3, 5.1, 4)]  # 0.6015 m between them
    space = PolygonSpace(free_region(hall, halves, RADIUS))
    roadmap = Roadmap.of(space, RADIUS, [(1, 1), (9, 3)])
    one, other = groups(roadmap)[roadmap.places]
    assert one == other


@pytest.mark.parametrize("wide_m", [0.66, 0.7, 0.76])
def test_ways_round_blocks_are_as_short_as_they_are_in_passages_that_hardly_fit(wide_m):
    side_m, count = 2.1, 3
    pitch_m = side_m + wide_m
    extent_m = count * pitch_m + wide_m
    corners_m = [wide_m + k * pitch_m for k in range(count)]
    blocks = [shapely.box(x, y, x + side_m, y + side_m) for x in corners_m for y in corners_m]
    region = shapely.box(0, 0, extent_m, extent_m).difference(shapely.union_all(blocks)).buffer(-RADIUS)
    turn = np.array([[np.cos(0.2), np.sin(0.2)], [-np.sin(0.2), np.cos(0.2)]])
    space = PolygonSpace(shapely.transform(region, lambda points: points @ turn))
    middles_m = [wide_m / 2 + k * pitch_m for k in range(count + 1)]
    places = np.array([(x, y + 0.3 * pitch_m) for x in middles_m for y in middles_m[:-1]]) @ turn
    roadmap, finder = Roadmap.of(space, RADIUS, places), PathFinder(space)
    one_m = to_goal(roadmap, roadmap.places[5])
    for place, point in zip(places, roadmap.places, strict=True):
        assert one_m[point] <= finder.path(place, places[5]).length_m + pitch_m / 2


def test_a_place_on_the_border_of_the_free_space_is_joined():
    space = PolygonSpace(free_region(shapely.box(0, 0, 10, 4), [], RADIUS))
    roadmap = Roadmap.of(space, RADIUS, [(RADIUS, RADIUS), (0.1, 0.1), (9.7, 2)])
    assert roadmap.places[1] == -1
    np.testing.assert_allclose(roadmap.points[roadmap.places[[0, 2]]], [(RADIUS, RADIUS), (9.7, 2)])
    assert set(roadmap.places[[0, 2]]) <= set(roadmap.edges.ravel())


@pytest.mark.parametrize("seed", range(10))
def test_the_points_that_an_edge_comes_near_to_are_all_those(seed):
    rng = np.random.default_rng(seed)
    points = rng.uniform(0, 6, size=(40, 2))
    points[20] = (points[0] + points[1]) / 2  # a distance of 0 to the middle of an edge
    edges = np.concatenate([[[0, 1], [1, 0]], rng.integers(0, 40, size=(60, 2))])
    edges = edges[edges[:, 0] != edges[:, 1]]
    reach = rng.uniform(0.3, 1.5)
    start, point, metres = conflicts(points, edges, reach)
    for k, (u, v) in enumerate(edges):
        piece = shapely.LineString(points[[u, v]])
        away = {w: 0.0 if w == v else piece.distance(shapely.Point(points[w])) for w in range(40) if w != u}
        near = {w: d for w, d in away.items() if d < reach and d < np.linalg.norm(points[w] - points[u]) - 1e-9}
        found = dict(zip(point[start[k] : start[k + 1]], metres[start[k] : start[k + 1]], strict=True))
        assert found == pytest.approx(near)


def hall_with(width_m, length_m=6.0):
    """Two rooms of 5 x 5 m and a corridor between them."""
    rooms = shapely.union_all([shapely.box(0, 0, 5, 5), shapely.box(5 + length_m, 0, 10 + length_m, 5)])
    corridor = shapely.box(4, 2.5 - width_m / 2, 6 + length_m, 2.5 + width_m / 2)
    return PolygonSpace(free_region(shapely.union(rooms, corridor), [], RADIUS))


def in_corridor(roadmap):
    return (roadmap.points[:, 0] > 5.7) & (roadmap.points[:, 0] < 10.3)


def test_a_corridor_for_one_has_one_lane_down_its_middle_and_nowhere_to_rest():
    roadmap = Roadmap.of(hall_with(0.9), RADIUS)
    inside = in_corridor(roadmap)
    np.testing.assert_allclose(roadmap.points[inside, 1], 2.5, atol=1e-6)
    assert np.diff(np.sort(roadmap.points[inside, 0])).min() >= roadmap.reach
    assert not roadmap.holding[inside].any()
    assert roadmap.holding[roadmap.points[:, 0] < 4].all()


@pytest.mark.parametrize("wide", [5, 6])
def test_a_passage_between_cells_has_its_lane_down_the_middle(wide):
    """Of a width of 5 or 6 cells, 0.1 m each: in the midst of a cell, or between two."""
    blocked = np.ones((60, 40), dtype=bool)
    blocked[:20] = blocked[40:] = blocked[:, 10 : 10 + wide] = False
    roadmap = Roadmap.of(GridSpace(Grid(blocked, 0.1)), RADIUS)
    inside = (roadmap.points[:, 1] > 2.5) & (roadmap.points[:, 1] < 3.5)
    assert inside.sum() > 0
    np.testing.assert_allclose(roadmap.points[inside, 0], 1 + 0.1 * wide / 2, atol=1e-9)


def test_a_corridor_for_two_has_two_lanes_on_which_robots_pass_each_other():
    roadmap = Roadmap.of(hall_with(1.4), RADIUS)
    inside = in_corridor(roadmap)
    rows = np.unique(roadmap.points[inside, 1])
    assert len(rows) == 2
    assert rows[1] - rows[0] >= roadmap.reach
    assert roadmap.holding[inside].all()


def test_resting_points_of_open_space_are_out_of_each_others_way():
    roadmap = Roadmap.of(None, RADIUS, [(0, 0), (20, 10)])
    lanes = np.setdiff1d(np.arange(len(roadmap.points)), roadmap.places)
    gaps = np.linalg.norm(roadmap.points[lanes, None] - roadmap.points[None, lanes], axis=2)
    assert gaps[~np.eye(len(lanes), dtype=bool)].min() >= roadmap.reach
    middle = roadmap.point_at(10, 5)
    out = np.arange(roadmap.out_start[middle], roadmap.out_start[middle + 1])
    assert (roadmap.edges[out, 0] == middle).all()
    assert len(out) == 8
    straight = out[roadmap.lengths_m[out] < 1.2 * roadmap.reach]
    assert len(straight) == 4
    assert all(roadmap.reached(k).tolist() == [roadmap.edges[k, 1]] for k in straight)
    assert roadmap.passable.all()


def test_a_field_that_is_wide_for_its_robots_has_about_as_many_points_as_may_be():
    space = GridSpace(Grid(np.zeros((200, 300), dtype=np.bool_), 0.5))
    made = network(space, 1.0, np.array([[75.0, 50.0]]), 1000)
    assert 900 < len(made.points) < 1200


def test_the_nearest_point_of_a_place_is_its_own():
    places = [(1.23, 2.34), (3.21, 1.11), (1.23, 2.34)]
    roadmap = Roadmap.of(None, RADIUS, places)
    assert [roadmap.point_at(*place) for place in places] == roadmap.places.tolist()
    assert roadmap.places[0] == roadmap.places[2] != roadmap.places[1]


@pytest.mark.parametrize(
    ("space", "radius", "places", "message"),
    [
        (None, RADIUS, [], "expected the plane, or None and some places"),
        (PrismSpace(shapely.box(0, 0, 1, 1), ()), RADIUS, [(0, 0)], "with heights"),
        (None, 0.0, [(0, 0)], "radius_m: 0.0; expected a finite number above 0"),
        (None, float("nan"), [(0, 0)], "radius_m: nan"),
    ],
)
def test_what_no_roadmap_is_made_of_is_refused(space, radius, places, message):
    with pytest.raises(ParameterError, match=message):
        Roadmap.of(space, radius, places)


def test_a_robot_rests_neither_in_a_passage_nor_before_another_ones_place():
    """A robot at the place itself keeps nobody from it."""
    place = (8, 3.21)  # off the lattice
    roadmap = Roadmap.of(hall_with(0.9), RADIUS, [place, (2.4, 2.4)])
    hall = np.linalg.norm(roadmap.points - (2.4, 2.4), axis=1) < roadmap.reach
    assert hall.sum() > 1
    assert np.flatnonzero(roadmap.holding & hall).tolist() == [roadmap.places[1]]
    assert roadmap.passable[hall].all()
    assert roadmap.places[0] == -1
    assert not roadmap.holding[in_corridor(roadmap)].any()


def test_of_points_at_one_place_one_is_left():
    points = np.array([[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0]])
    edges = np.array([[0, 1], [1, 2], [2, 3], [0, 2]])
    made = Network(points, np.ones(4, dtype=np.bool_), edges, np.array([0.4, 0.1, 0.5, 0.4]), np.array([2, -1, 3]))
    one = made.merged()
    np.testing.assert_array_equal(one.points, [[0, 0], [1, 0], [2, 0]])
    np.testing.assert_array_equal(one.edges, [[0, 1], [1, 2]])
    np.testing.assert_array_equal(one.clearance_m, [0.4, 0.5])
    np.testing.assert_array_equal(one.places, [1, -1, 2])
