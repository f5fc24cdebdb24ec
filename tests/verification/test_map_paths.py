"""The judge's shortest ways: known lengths, brute force, and what every shortest way obeys."""

import math
from fractions import Fraction
from itertools import permutations

import numpy as np
import pytest
import shapely
from tests.verification.brute_paths import among_polygons, over_cells, random_cells, star

from muster.motion.free_space import GridSpace, PolygonSpace, Prism, PrismSpace
from muster.motion.grid import Grid
from muster.motion.maps.narrow_places import necks
from muster.motion.maps.polygons import free_region, grown
from muster.verification.air_paths import AirPaths
from muster.verification.map_paths import PlanePaths

ARENA = shapely.box(0, 0, 40, 40)
SQUARE = shapely.box(15, 15, 25, 25)


def metres(space, start, end):
    ways = PlanePaths(space, [start, end])
    there, back = ways.metres(start, end), ways.metres(end, start)
    assert there == back
    return there


def cells(*rows, resolution=1.0, origin=(0.0, 0.0, 0.0)):
    """A space from text, the top row first; # is blocked."""
    return GridSpace(Grid(np.array([[c == "#" for c in row] for row in rows[::-1]]), resolution, origin))


def test_around_a_wall():
    space = PolygonSpace(ARENA.difference(shapely.box(19, 10, 21, 40)))
    assert metres(space, (10, 20), (30, 20)) == pytest.approx(2 * math.hypot(9, 10) + 2, rel=1e-8)


def test_around_a_square_and_along_its_side():
    space = PolygonSpace(ARENA.difference(SQUARE))
    assert metres(space, (10, 20), (30, 20)) == pytest.approx(10 + 2 * math.hypot(5, 5), rel=1e-8)
    assert metres(space, (15, 15), (15, 25)) == pytest.approx(10, rel=1e-8)
    assert metres(space, (15, 20), (25, 20)) == pytest.approx(20, rel=1e-8)


def round_corners(radius):
    """Past two corners of the square, grown by a radius, between points 5 m before and behind it, halfway up."""
    away = math.hypot(5, 5)
    turn = math.atan2(5, 5) + math.asin(radius / away)
    return 10 + 2 * (math.sqrt(away**2 - radius**2) + radius * turn)


@pytest.mark.parametrize("radius", [0.1, 0.5, 2.0])
def test_a_round_body_goes_along_tangents_and_arcs(radius):
    found = metres(PolygonSpace(free_region(ARENA, [SQUARE], radius)), (10, 20), (30, 20))
    assert round_corners(radius) <= found <= round_corners(radius) * 1.001


@pytest.mark.parametrize(
    ("rows", "start", "end", "expected"),
    [
        ((".....", ".###.", "....."), (0.5, 1.5), (4.5, 1.5), 3 + 2 * math.hypot(0.5, 0.5)),
        (("..#..", "..#..", "....."), (0.5, 2.5), (4.5, 2.5), 1 + 2 * math.hypot(1.5, 1.5)),
        ((".....", "....."), (0.5, 0.5), (4.5, 1.5), math.hypot(4, 1)),
        ((".#", "#."), (0.5, 1.5), (1.5, 0.5), None),  # no squeezing through a corner
        ((".#.", "#..", "..."), (0.5, 2.5), (2.5, 2.5), None),
        ((".#", "#."), (0.5, 1.5), (1, 1), math.hypot(0.5, 0.5)),  # but up to it
        ((".#", "#."), (1.5, 0.5), (1, 1), math.hypot(0.5, 0.5)),
    ],
)
def test_ways_over_cells(rows, start, end, expected):
    found = metres(cells(*rows), start, end)
    assert found == (None if expected is None else pytest.approx(expected, rel=1e-9))


@pytest.mark.parametrize("origin", [(0.0, 0.0, 0.0), (-31.3, 7.7, 0.4)])
def test_a_grid_anywhere(origin):
    space = cells(".....", ".###.", ".....", resolution=0.05, origin=origin)
    start, end = map(tuple, space.grid.to_map(np.array([[0.5, 1.5], [4.5, 1.5]])).tolist())
    assert metres(space, start, end) == pytest.approx(0.05 * (3 + 2 * math.hypot(0.5, 0.5)), rel=1e-9)


@pytest.mark.parametrize("seed", range(30))
def test_random_cells_as_by_brute_force(seed):
    random = np.random.default_rng(seed)
    size = tuple(random.integers(2, 8, 2))
    blocked = random_cells(random, size, random.choice([0.15, 0.3, 0.4]))
    parts = int(random.choice([1, 2, 10]))
    start, end = (tuple(Fraction(int(random.integers(0, parts * m + 1)), parts) for m in size[::-1]) for _ in range(2))
    space = GridSpace(Grid(blocked, 0.1, (3.3, -8.1, 0.3)))
    here, there = map(tuple, space.grid.to_map(np.array([start, end], dtype=float)).tolist())
    expected = over_cells(blocked, start, end) if start != end else None
    found = metres(space, here, there)
    if start != end:
        assert found == (None if expected is None else pytest.approx(0.1 * expected, rel=1e-8))


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", range(12))
def test_random_polygons_as_by_brute_force(seed):
    random = np.random.default_rng(seed)
    rings = [star(random, np.array(tile), 9, int(random.integers(3, 6))) for tile in ((12, 12), (32, 12), (22, 32))]
    rings = [ring for ring in rings if shapely.Polygon(ring).is_valid and shapely.Polygon(ring).area > 0]
    boundary = [(0, 0), (44, 0), (44, 44), (25, 40), (0, 44)]
    region = shapely.difference(shapely.Polygon(boundary), shapely.union_all([shapely.Polygon(r) for r in rings]))
    ends = []
    while len(ends) < 2:
        point = tuple(map(int, random.integers(0, 45, 2)))
        if region.intersects(shapely.Point(point)) and point not in ends:
            ends.append(point)
    expected = among_polygons(boundary, rings, *ends)
    assert metres(PolygonSpace(region), *ends) == pytest.approx(expected, rel=1e-7)


def noisy(random):
    return GridSpace(Grid(random_cells(random, (30, 40), 0.25), 0.1))


def among(random):
    zones = [shapely.Polygon(star(random, np.array(tile), 8, 6)) for tile in ((10, 10), (30, 10), (10, 30), (30, 30))]
    return PolygonSpace(free_region(ARENA, [zone for zone in zones if zone.is_valid and zone.area > 0], 0.4))


@pytest.mark.parametrize(("make", "extent"), [(noisy, (4, 3)), (among, (40, 40))])
@pytest.mark.parametrize("seed", range(4))
def test_a_metric_no_shorter_than_the_straight_line(make, extent, seed):
    random = np.random.default_rng(seed)
    space = make(random)
    places = [tuple(point) for point in (random.random((9, 2)) * extent).tolist()]
    ways = PlanePaths(space, places)
    length = {(a, b): ways.metres(a, b) for a in places for b in places}
    reached = [a for a in places if length[a, a] == 0]
    assert len(reached) >= 3
    assert all(length[a, b] is None for a in places if a not in reached for b in places)
    for a, b, c in permutations(reached, 3):
        assert length[a, b] == length[b, a]
        if length[a, b] is not None:
            assert length[a, b] >= math.dist(a, b)
            if length[b, c] is not None:
                assert length[a, c] <= length[a, b] + length[b, c] + 1e-7


def test_straight_where_nothing_is_in_the_way():
    assert metres(PolygonSpace(ARENA), (1, 2), (39, 17)) == math.dist((1, 2), (39, 17))
    assert metres(PolygonSpace(ARENA), (0, 0), (40, 40)) == math.dist((0, 0), (40, 40))
    assert metres(cells("....", "...."), (0, 0), (4, 2)) == math.hypot(4, 2)


def test_no_way():
    split = PolygonSpace(ARENA.difference(shapely.box(19, 0, 21, 40)))
    assert metres(split, (10, 20), (30, 20)) is None
    assert metres(PolygonSpace(ARENA.difference(SQUARE)), (20, 20), (1, 1)) is None
    assert metres(PolygonSpace(ARENA), (1, 1), (41, 1)) is None
    assert metres(cells(".#.", ".#."), (0.5, 0.5), (2.5, 0.5)) is None
    assert metres(cells(".#.", "..."), (0.5, 0.5), (1.5, 1.5)) is None
    assert metres(cells("##", "##"), (0.5, 0.5), (1.5, 1.5)) is None
    assert metres(PolygonSpace(shapely.MultiPolygon()), (0.5, 0.5), (1.5, 1.5)) is None


def test_nothing_passes_where_two_free_parts_meet_in_a_point():
    parts = shapely.MultiPolygon([shapely.box(0, 0, 1, 1), shapely.box(1, 1, 2, 2)])
    assert metres(PolygonSpace(parts), (0.5, 0.5), (1.5, 1.5)) is None


def test_a_place_that_is_not_known_is_refused():
    with pytest.raises(KeyError):
        PlanePaths(PolygonSpace(ARENA), [(1, 1)]).metres((1, 1), (2, 2))


def test_on_the_ground_height_rises_evenly_along_the_way():
    space = PolygonSpace(ARENA.difference(SQUARE))
    plane = 10 + 2 * math.hypot(5, 5)
    assert metres(space, (10, 20, 1), (30, 20, 4)) == pytest.approx(math.hypot(plane, 3), rel=1e-8)
    assert metres(space, (1, 1, 1), (2, 2, 4)) == math.dist((1, 1, 1), (2, 2, 4))


def in_air(prisms, start, end, region=ARENA):
    ways = AirPaths(PrismSpace(region, (*prisms, *necks(region, prisms))))
    there = ways.metres(start, end)
    assert there == ways.metres(end, start)
    return there


WALL = shapely.box(19.5, 0, 20.5, 40)
AROUND = 10 + 2 * math.hypot(5, 5)


@pytest.mark.parametrize(
    ("polygon", "floor", "ceiling", "start", "end", "expected"),
    [
        (WALL, -math.inf, 5, (10, 20, 1), (30, 20, 1), 1 + 2 * math.hypot(9.5, 4)),
        (WALL, 5, math.inf, (10, 20, 9), (30, 20, 9), 1 + 2 * math.hypot(9.5, 4)),
        (WALL, -math.inf, 5, (10, 20, 9), (30, 20, 9), 20),
        (WALL, -math.inf, 5, (18.5, 5, 1), (39, 30, 1), 34.690507424),  # SciPy's minimum over points of both rims
        (WALL, -math.inf, math.inf, (10, 20, 1), (30, 20, 1), None),
        (WALL, -math.inf, 5, (20, 20, 4), (30, 20, 1), None),
        (WALL, -math.inf, 5, (10, 20, 1), (30, 20, -1), None),  # below the ground
        (SQUARE, -math.inf, math.inf, (10, 20, 1), (30, 20, 1), AROUND),
        (SQUARE, -math.inf, math.inf, (10, 20, 1), (30, 20, 11), math.hypot(AROUND, 10)),
        (SQUARE, -math.inf, 3, (10, 20, 1), (30, 20, 1), 10 + 2 * math.hypot(5, 2)),
        (grown(SQUARE, 0.5), -math.inf, math.inf, (10, 20, 1), (30, 20, 1), round_corners(0.5)),
        (grown(SQUARE, 0.5), -math.inf, math.inf, (10, 20, 1), (30, 20, 9), math.hypot(round_corners(0.5), 8)),
    ],
)
def test_ways_in_the_air(polygon, floor, ceiling, start, end, expected):
    found = in_air([Prism(polygon, floor, ceiling)], start, end)
    if expected is None:
        assert found is None
    else:
        assert expected * (1 - 1e-7) <= found <= expected * 1.005


@pytest.mark.parametrize(
    "prisms",
    [
        [Prism(shapely.box(19.5, 0, 20.5, 13), -math.inf, 9), Prism(shapely.box(19.5, 13, 20.5, 40), -math.inf, 9)],
        [Prism(WALL, -math.inf, 4), Prism(WALL, 4, 9)],
    ],
)
def test_nothing_passes_where_prisms_touch(prisms):
    expected = 1 + 2 * math.hypot(9.5, 5)
    assert expected * (1 - 1e-6) <= in_air(prisms, (10, 20, 4), (30, 20, 4)) <= expected * 1.005


def test_a_gap_much_narrower_than_the_prisms_beside_it_is_the_shortest_way():
    """Over both, or around them, is a way too: the gap is seen before it is needed."""
    prisms = [Prism(shapely.box(19.5, a, 20.5, b), -math.inf, 9) for a, b in ((-1, 18), (18.02, 39))]
    expected = 1 + 2 * math.hypot(9.5, 1.98)
    assert expected * (1 - 1e-6) <= in_air(prisms, (10, 20, 4), (30, 20, 4)) <= expected * 1.005


def test_the_boundary_of_the_air():
    corner = shapely.Polygon([(0, 0), (40, 0), (40, 10), (10, 10), (10, 40), (0, 40)])
    found = in_air([], (5, 35, 1), (35, 5, 1), corner)
    assert found == pytest.approx(2 * math.hypot(5, 25), rel=5e-3)


@pytest.mark.long(keep=2)
@pytest.mark.parametrize("seed", range(5))
def test_endless_prisms_are_as_polygons(seed):
    random = np.random.default_rng(seed)
    zones = [shapely.Polygon(star(random, np.array(t), 7, 5)) for t in ((10, 10), (30, 10), (10, 30), (30, 30))]
    zones = [grown(zone, 0.4) for zone in zones if zone.is_valid and zone.area > 0]
    start, end = (1.0, 2.0), (38.0, 37.0)
    plane = metres(PolygonSpace(shapely.difference(ARENA, shapely.union_all(zones))), start, end)
    found = in_air([Prism(zone, -math.inf, math.inf) for zone in zones], (*start, 1.0), (*end, 6.0))
    assert found == pytest.approx(math.hypot(plane, 5), rel=5e-3)


def test_each_part_of_a_region_has_its_corners():
    wall = shapely.box(19, -1, 21, 41)
    space = PolygonSpace(ARENA.difference(shapely.union_all([wall, shapely.box(5, 5, 10, 30)])))
    assert metres(space, (4, 20), (11, 20)) == pytest.approx(5 + 2 * math.hypot(1, 10), rel=1e-8)
    assert metres(space, (4, 20), (30, 20)) is None


@pytest.mark.parametrize("seed", range(10))
def test_no_way_leads_through_another_place(seed):
    blocked = random_cells(np.random.default_rng(seed), (6, 6), 0.4)
    space, start, end = GridSpace(Grid(blocked, 1.0)), (0.5, 0.5), (5.5, 5.5)
    pinches_too = [(float(x), float(y)) for x in range(7) for y in range(7)]
    assert PlanePaths(space, [start, end, *pinches_too]).metres(start, end) == metres(space, start, end)
