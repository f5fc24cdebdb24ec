"""Robots of several sizes on one roadmap: each by its own free space, and apart from all others."""

from __future__ import annotations

import itertools
import math

import numpy as np
import pytest
import shapely
from scipy.sparse import coo_array
from scipy.sparse.csgraph import connected_components

from muster.mission.lanes import Lane, Lanes
from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.motion.free_space import GridSpace, PolygonSpace
from muster.motion.grid import Grid
from muster.motion.map_world import World
from muster.motion.maps.distances import inflated
from muster.motion.maps.polygons import free_region
from muster.motion.path import Path
from muster.motion.paths import PathFinder
from muster.traffic.blockages.impossible_crossings import Crossings
from muster.traffic.journeys.travellers import Stop, Traveller
from muster.traffic.mission_roadmap import MissionRoadmap
from muster.traffic.passages import passages
from muster.traffic.roadmaps.roadmap import Roadmap, layer_of_lanes, layer_of_space
from muster.traffic.roadmaps.robot_sizes import MOST_SIZES, same_ways, sizes

RADII = (0.2, 0.35, 0.7)
MARGIN = 0.02


def parts(roadmap):
    n = len(roadmap.points)
    links = coo_array((np.ones(len(roadmap.edges)), roadmap.edges.T), shape=(n, n))
    return connected_components(links, directed=False)[1]


def clumps(seed):
    """Blocked cells in clumps, with gaps between them of every width."""
    rng = np.random.default_rng(seed)
    blocked = np.kron(rng.random((9, 11)) < rng.choice([0.1, 0.2, 0.3]), np.ones((5, 5))) > 0
    blocked &= rng.random(blocked.shape) < 0.9
    return Grid(blocked, 0.2, (rng.uniform(-5, 5), rng.uniform(-5, 5), rng.choice([0.0, 0.7])))


def joined(spaces, places):
    return Roadmap.joined([layer_of_space(spaces[r], r, places, margin_m=MARGIN) for r in RADII], MARGIN)


@pytest.mark.long(keep=4)
@pytest.mark.parametrize("seed", range(16))
def test_each_size_reaches_the_places_that_its_own_free_space_reaches(seed):
    grid = clumps(seed)
    spaces = {radius: GridSpace(inflated(grid, radius)) for radius in RADII}
    rng = np.random.default_rng(seed)
    cells = np.argwhere(~spaces[RADII[0]].grid.blocked)[:, ::-1]
    places = grid.to_map(cells[rng.integers(len(cells), size=8)] + rng.random((8, 2)))
    roadmap = joined(spaces, places)
    part = parts(roadmap)
    points = roadmap.places.reshape(len(RADII), len(places))
    for layer, radius in enumerate(RADII):
        finder = PathFinder(spaces[radius])
        for a, b in itertools.combinations(range(len(places)), 2):
            one, other = points[layer, [a, b]]
            is_joined = one >= 0 and other >= 0 and part[one] == part[other]
            assert is_joined == isinstance(finder.path(places[a], places[b]), Path), (radius, a, b)


@pytest.mark.parametrize("seed", range(4))
def test_each_edge_is_free_for_the_robots_of_its_layer(seed):
    grid = clumps(seed)
    roadmap = joined({radius: GridSpace(inflated(grid, radius)) for radius in RADII}, [])
    row, column = np.nonzero(grid.blocked)
    squares = shapely.STRtree(shapely.box(column, row, column + 1, row + 1))
    pieces = shapely.linestrings(grid.to_grid(roadmap.points)[roadmap.edges])
    away_m = roadmap.radii_m[roadmap.edge_layer] / grid.resolution_m - 1e-6
    assert len(squares.query(pieces, predicate="dwithin", distance=away_m)[0]) == 0
    assert set(roadmap.edge_layer) == set(range(len(RADII)))


@pytest.mark.parametrize("seed", range(6))
def test_two_that_move_one_after_the_other_by_what_edges_say_keep_their_distance(seed):
    """Of every two sizes: who stands at a point that an edge does not come near to is not touched by who drives it."""
    rng = np.random.default_rng(seed)
    grid = clumps(seed + 50)
    roadmap = joined({radius: GridSpace(inflated(grid, radius)) for radius in RADII}, [])
    for edge in rng.choice(len(roadmap.edges), size=120, replace=False):
        u, v = roadmap.edges[edge]
        piece = shapely.linestrings(roadmap.points[[u, v]])
        away_m = shapely.distance(piece, shapely.points(roadmap.points))
        apart_m = roadmap.radii_m[roadmap.layer[u]] + roadmap.radii_m[roadmap.layer] + MARGIN
        leaves = np.linalg.norm(roadmap.points - roadmap.points[u], axis=1) <= away_m + 1e-9
        near = np.zeros(len(roadmap.points), dtype=bool)
        near[roadmap.reached(int(edge))] = True
        assert (near == ((away_m < apart_m) & ~leaves)).all()


def hall(*gaps):
    """Rooms of 6 x 6 m side by side, and doors between them of these widths in the middle."""
    walls = [shapely.box(6.0 * k - 0.1, 0, 6.0 * k + 0.1, 6) for k in range(1, len(gaps) + 1)]
    doors = [shapely.box(6.0 * k - 0.2, 3 - gap / 2, 6.0 * k + 0.2, 3 + gap / 2) for k, gap in enumerate(gaps, 1)]
    cut = [part for wall, door in zip(walls, doors, strict=True) for part in shapely.get_parts(wall.difference(door))]
    boundary = ((0, 0), (6.0 * (len(gaps) + 1), 0), (6.0 * (len(gaps) + 1), 6), (0, 6))
    return Map(boundary=boundary, zones=tuple(Zone(polygon=tuple(one.exterior.coords)[:-1]) for one in cut))


def robot(name, radius, at, **more):
    return Robot(id=name, position=at, radius_m=radius, **more)


def going(who, goal, **more):
    return Traveller(who, who.position[:2], (Stop(goal),), **more)


def moves_of(made, travellers):
    found = made.plan()(travellers).moves
    return [[move.to for move in found if move.traveller == k] for k in range(len(travellers))]


def touched(travellers, moves):
    """Whether one that moves comes nearer to one that stands than both radii, move by move."""
    at = {k: np.array(who.start) for k, who in enumerate(travellers)}
    for move in moves:
        piece = shapely.LineString([at[move.traveller], move.to])
        mine = travellers[move.traveller].robot.radius_m
        for k, place in at.items():
            apart = piece.distance(shapely.Point(place))
            leaves = apart >= math.dist(place, at[move.traveller]) - 1e-9
            if k != move.traveller and not leaves and apart < mine + travellers[k].robot.radius_m + MARGIN - 1e-6:
                return True
        at[move.traveller] = np.array(move.to)
    return False


@pytest.mark.long
def test_of_three_sizes_each_gets_as_far_as_its_gaps_let_it():
    """The doors are 2.0, 1.2 and 0.6 m wide."""
    rooms = [(3.0, 1.0), (9.0, 1.0), (15.0, 1.0), (21.0, 1.0)]
    team = tuple(robot(f"r{radius}", radius, (3.0, 1.5 + 1.6 * k)) for k, radius in enumerate((0.2, 0.4, 0.8)))
    tasks = tuple(Task(id=f"t{k}", position=place) for k, place in enumerate(rooms[1:]))
    mission = Mission(robots=team, tasks=tasks, map=hall(2.0, 1.2, 0.6))
    made = MissionRoadmap.of(mission)
    alone = Crossings(
        made.roadmap, [made.points([one.position], one)[0] for one in team], [one.radius_m for one in team]
    )
    reached = [
        [alone.reaches(alone.starts[k], point) for point in made.points(rooms[1:], one)] for k, one in enumerate(team)
    ]
    assert reached == [[True, True, True], [True, True, False], [True, False, False]]
    plan = made.plan()
    for k, one in enumerate(team):
        assert plan.reaches([going(one, rooms[0])], 0, rooms[1:]) == reached[k]


def test_wide_robots_around_it_do_not_keep_a_small_one_from_a_narrow_door():
    small = robot("small", 0.2, (3.0, 3.0))
    wide = [robot(f"wide {k}", 0.8, at) for k, at in enumerate([(1.0, 1.0), (1.0, 5.0), (5.0, 0.9), (4.9, 5.1)])]
    mission = Mission(robots=(small, *wide), tasks=(Task(id="t", position=(9.0, 3.0)),), map=hall(0.6))
    travellers = [going(small, (9.0, 3.0)), *(Traveller(one, one.position[:2], fixed=True) for one in wide)]
    made = MissionRoadmap.of(mission)
    moves, _, cut_off = made.plan()(travellers)
    assert [move.to for move in moves if move.traveller == 0][-1] == (9.0, 3.0)
    assert not touched(travellers, moves)
    assert cut_off == frozenset()


def corridor_hall(width):
    """Two rooms of 6 x 6 m, and a corridor of 8 m between them."""
    rooms = shapely.union_all([shapely.box(0, 0, 6, 6), shapely.box(14, 0, 20, 6)])
    return shapely.union(rooms, shapely.box(5.5, 3 - width / 2, 14.5, 3 + width / 2))


def sized(shape, radii, places=()):
    team = tuple(robot(f"r{radius}", radius, places[0] if places else (3.0, 3.0)) for radius in radii)
    tasks = tuple(Task(id=f"t{k}", position=place) for k, place in enumerate(places[1:]))
    return MissionRoadmap.of(
        Mission(robots=team, tasks=tasks, map=Map(boundary=tuple(shape.exterior.coords)[:-1]))
    ).roadmap


def in_corridor(roadmap, layer):
    x = roadmap.points[:, 0]
    return (x > 7) & (x < 13) & (roadmap.layer == layer)


def test_small_robots_pass_each_other_in_a_corridor_where_a_wide_one_has_room_alone():
    """It holds two small ones side by side, or a wide one."""
    roadmap = sized(corridor_hall(1.8), (0.3, 0.7))
    small, wide = (in_corridor(roadmap, layer) for layer in (0, 1))
    assert roadmap.passable[small].all()
    assert not roadmap.passable[wide].any()
    assert not roadmap.passed[1, small].any(), "a small one that rests there keeps the wide one out"
    assert not roadmap.passed[0, wide].any(), "and the wide one small ones"
    assert not roadmap.holding[small | wide].any()
    assert {int(roadmap.layer[one.points[0]]) for one in passages(roadmap)} == {1}


def test_a_wide_robot_rests_where_small_ones_get_past_it():
    roadmap = sized(corridor_hall(3.0), (0.3, 0.7))
    wide = in_corridor(roadmap, 1)
    assert roadmap.passed[0, wide].any()
    assert roadmap.holding[roadmap.layer == 1].any()


@pytest.mark.parametrize(("width", "passes"), [(1.8, False), (2.1, True), (2.2, True), (3.0, True)])
def test_a_wide_and_a_small_robot_swap_only_where_the_corridor_holds_both(width, passes):
    """In a dead end, each to where the other is."""
    roadmap = sized(shapely.box(0, 0, 6, width), (0.3, 0.7), [(1.0, 0.9), (5.0, 0.9)])
    small, wide = roadmap.places.reshape(2, 2)
    crossings = Crossings(roadmap, [int(small[0]), int(wide[1])], [0.3, 0.7])
    assert (crossings.ends_apart(0, 1, (int(small[1]), int(wide[0]))) is None) == passes
    assert (crossings.blocking(0, [int(small[1])]) is None) == passes


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
def test_a_wide_robot_does_not_meet_a_small_one_in_a_passage_for_one_of_both(kinematics):
    shape = corridor_hall(1.8)
    boundary = tuple(shape.exterior.coords)[:-1]
    small, wide = (
        robot("small", 0.3, (3.0, 3.0), kinematics=kinematics),
        robot("wide", 0.7, (17.0, 3.0), kinematics=kinematics),
    )
    mission = Mission(robots=(small, wide), tasks=(), map=Map(boundary=boundary))
    travellers = [going(small, (17.0, 3.0)), going(wide, (3.0, 3.0))]
    moves = MissionRoadmap.of(mission).plan()(travellers).moves
    assert not touched(travellers, moves)
    ends = [[move.to for move in moves if move.traveller == k][-1] for k in (0, 1)]
    assert ends == [(17.0, 3.0), (3.0, 3.0)]


def test_a_lane_that_is_too_narrow_for_one_leads_the_other():
    nodes = {"a": (0.0, 0.0), "b": (5.0, 0.0), "c": (10.0, 0.0), "d": (5.0, 5.0)}
    edges = (
        Lane(start="a", end="b", both_ways=True),
        Lane(start="b", end="c", width_m=1.0, both_ways=True),
        Lane(start="b", end="d", both_ways=True),
        Lane(start="d", end="c", both_ways=True),
    )
    lanes = Lanes(nodes=nodes, edges=edges)
    team = robot("small", 0.3, (0.0, 0.0)), robot("wide", 0.7, (2.0, 0.0))
    tasks = (Task(id="t", position=(10.0, 0.0)),)
    made = MissionRoadmap.of(Mission(robots=team, tasks=tasks, lanes=lanes))
    assert [[lane.number for lane in lanes] for lanes in made.closed] == [[], [1]]
    small, wide = (moves_of(made, [going(one, (10.0, 0.0))])[0] for one in team)
    assert small[-1] == wide[-1] == (10.0, 0.0)
    assert (5.0, 5.0) in wide
    assert (5.0, 5.0) not in small


def test_a_door_closes_what_lies_in_the_way_of_each_size():
    """A zone that closes leaves a gap of 0.8 m beside it: room for the small robot alone."""
    zone = Zone(id="door", polygon=((5.0, 0.0), (7.0, 0.0), (7.0, 5.2), (5.0, 5.2)), open=True)
    mission = Mission(
        robots=(robot("small", 0.3, (2.0, 3.0)), robot("wide", 0.8, (2.0, 1.0))),
        tasks=(Task(id="t", position=(10.0, 3.0)),),
        map=Map(boundary=((0, 0), (12, 0), (12, 6), (0, 6)), zones=(zone,)),
    )
    plan = MissionRoadmap.of(mission).plan()
    travellers = [going(one, (10.0, 3.0)) for one in mission.robots]
    for closed, reached in (((), [True, True]), (("door",), [True, False])):
        plan.close(closed)
        assert [plan.reaches([one], 0, [(10.0, 3.0)])[0] for one in travellers] == reached


def test_a_robot_of_another_size_that_joins_gets_a_layer_of_its_own():
    mission = Mission(robots=(robot("wide", 0.8, (3.0, 3.0)),), tasks=(), map=hall(1.0))
    plan = MissionRoadmap.of(mission).plan()
    for radius in (0.2, 1.2):
        who = going(robot("new", radius, (2.0, 3.0)), (9.0, 3.0))
        assert plan.reaches([who], 0, [(9.0, 3.0)]) == [radius < 0.5]
    assert plan.roadmap.radii_m.tolist() == [0.2, 0.8, 1.2]


def test_a_robot_without_a_radius_takes_no_part():
    team = robot("point", 0.0, (1.0, 1.0)), robot("small", 0.3, (3.0, 3.0))
    made = MissionRoadmap.of(Mission(robots=team, tasks=(Task(id="t", position=(9.0, 3.0)),), map=hall(1.0)))
    assert made.roadmap.radii_m.tolist() == [0.3]
    assert [one.id for one in made.robots] == ["small"]


def test_what_the_roadmap_has_no_way_to_is_reached_where_free_space_leads_there():
    """A place in a nook that no point of the roadmap sees is not called unreachable."""
    mission = Mission(robots=(robot("r", 0.3, (3.0, 3.0)),), tasks=(), map=hall(1.0))
    plan = MissionRoadmap.of(mission).plan()
    emptied = plan.roadmap.keeping(np.zeros(len(plan.roadmap.edges), dtype=bool))
    plan.roadmap = emptied
    one = going(mission.robots[0], (9.0, 3.0))
    assert plan.reaches([one], 0, [(9.0, 3.0), (30.0, 3.0), (6.0, 1.0)]) == [True, False, False]


def test_who_stands_for_good_in_a_door_is_the_proof_that_nobody_gets_through_it():
    small, wide = robot("small", 0.3, (3.0, 3.0)), robot("broken", 0.3, (6.0, 3.0))
    mission = Mission(robots=(small, wide), tasks=(), map=hall(1.8))
    travellers = [going(small, (9.0, 3.0)), Traveller(wide, (6.0, 3.0), fixed=True)]
    plan = MissionRoadmap.of(mission).plan()
    assert plan.reaches(travellers, 0, [(9.0, 3.0)]) == [False]
    beside = [travellers[0], Traveller(wide, (6.0, 2.4), fixed=True)]
    assert plan.reaches(beside, 0, [(9.0, 3.0)]) == [True]


def test_many_sizes_share_layers_as_long_as_the_same_gaps_are_open_to_them():
    radii = [0.3 + 0.01 * k for k in range(12)]
    found = sizes(radii, lambda radius, wider: True)
    assert len(found) == MOST_SIZES
    assert max(radii) in found
    assert all(any(radius <= one <= 1.25 * radius for one in found) for radius in radii)
    assert sizes(radii, lambda radius, wider: False) == tuple(sorted(radii))


@pytest.mark.parametrize(("gap", "alike"), [(0.5, True), (0.9, False), (3.0, True)])
def test_free_spaces_are_alike_unless_a_gap_is_open_to_one_alone(gap, alike):
    """For radii of 0.4 and 0.5 m; there are two gaps, the other one 2 m wide."""
    walls = [shapely.box(5.9, 0, 6.1, 2), shapely.box(5.9, 4, 6.1, 6), shapely.box(5.9, 6 + gap, 6.1, 12)]
    spaces = [PolygonSpace(free_region(shapely.box(0, 0, 12, 12), walls, radius)) for radius in (0.4, 0.5)]
    assert same_ways(*spaces) == alike
    rows = np.arange(120)[:, np.newaxis] * 0.1 + 0.05
    wall = ((rows < 2) | ((rows > 4) & (rows < 6)) | (rows > 6 + gap)) & (np.arange(120) // 2 == 30)
    grids = [GridSpace(inflated(Grid(wall, 0.1), radius)) for radius in (0.4, 0.5)]
    assert same_ways(*grids) == alike


def test_lanes_for_two_sizes_hold_as_many_as_their_capacity():
    lanes = Lanes(
        nodes={"a": (0.0, 0.0), "b": (20.0, 0.0)},
        edges=(Lane(start="a", end="b", capacity=2, both_ways=True),),
    )
    roadmap = Roadmap.joined([layer_of_lanes(lanes, radius, margin_m=MARGIN) for radius in (0.3, 0.7)], MARGIN)
    inner = (roadmap.points[:, 0] > 0) & (roadmap.points[:, 0] < 20)
    into = inner[roadmap.edges[:, 1]] & ~inner[roadmap.edges[:, 0]]
    half = roadmap.points[:, 0] <= 10
    for edge in np.flatnonzero(into):
        side = half == half[roadmap.edges[edge, 1]]
        missed = np.setdiff1d(np.flatnonzero(inner & side), roadmap.reached(int(edge)))
        assert len(missed) == 0


def test_the_world_of_a_mission_with_several_sizes_is_read_once(monkeypatch):
    read = []
    monkeypatch.setattr(World, "of_travel", classmethod(lambda cls, mission: read.append(1) or World.of(mission)))
    team = tuple(robot(f"r{k}", radius, (3.0, 1.0 + 2 * k)) for k, radius in enumerate((0.2, 0.4, 0.8)))
    MissionRoadmap.of(Mission(robots=team, tasks=(), map=hall(2.0)))
    assert len(read) == 1


@pytest.mark.long(keep=1)
@pytest.mark.parametrize("seed", range(8))
def test_rows_along_walls_of_a_grid_repeat_no_point_of_the_layer(seed):
    grid = clumps(seed)
    world = World(2, 0.0, grid, None, ())
    place = tuple(grid.to_map(np.argwhere(~inflated(grid, 0.7).blocked)[:1, ::-1] + 0.5)[0].tolist())
    team = tuple(robot(f"r{radius}", radius, place) for radius in RADII)
    mission = Mission(robots=team, tasks=(), map=Map(image="x.png", resolution_m=0.2), rules=Rules(travel="map"))
    roadmap = MissionRoadmap.of(mission, world).roadmap
    assert roadmap.lengths_m.min() > 0
