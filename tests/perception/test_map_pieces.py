"""Pieces of maps that robots build each for itself, and the map that they make."""

import copy
import itertools
import struct
import zlib

import numpy as np
import pytest

from muster.mission.errors import ParameterError
from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.motion.map_world import World, body_of
from muster.perception.laser import LIDAR
from muster.perception.map_pieces import PieceMaker, PooledMap, unpacked
from muster.perception.occupancy_map import Scan
from muster.perception.team_map import TeamMap
from muster.simulation import KinematicWorld

ROOM = 900


def walled(*starts):
    wall = Zone(polygon=((4.0, 0.0), (4.3, 0.0), (4.3, 6.0), (4.0, 6.0)))
    robots = tuple(Robot(id=f"r_{k}", position=at, radius_m=0.2) for k, at in enumerate(starts))
    ground = Map(boundary=((0.0, 0.0), (10.0, 0.0), (10.0, 8.0), (0.0, 8.0)), zones=(wall,))
    return Mission(robots=robots, tasks=(Task(id="t", position=(9.0, 1.0)),), map=ground, rules=Rules(travel="map"))


@pytest.fixture(scope="module")
def built():
    """The map that is known beforehand, the maps of two robots of their own, and the pieces of each."""
    mission = walled((2.0, 2.0), (6.0, 6.0))
    world, known = KinematicWorld(mission, seed=0), TeamMap(World.of(mission), mission)
    own, pieces = [], []
    for number, robot in enumerate(mission.robots):
        mine = copy.deepcopy(known)
        maker, told = PieceMaker(mine, ROOM), []
        for heading in (0.0, 0.004, 0.008):
            x, y = world.positions[number, :2]
            mine.see(Scan.of((x, y, heading), world.scan(robot.id, LIDAR)), LIDAR, body_of(robot), 0.0)
            maker.cover(world.positions[number, :2], robot.radius_m)
            told += maker.pieces()
        own.append(mine)
        pieces.append(told)
    return known, own, pieces


def pooled(known, tracks):
    """The map of pieces in the order of (track, piece)."""
    pool = PooledMap(copy.deepcopy(known))
    for track, piece in tracks:
        pool.add(track, piece)
    settled(pool)
    return pool


def settled(pool):
    pool.map.begin_look()
    pool.settle()
    return pool.map.end_look()


def as_arrays(team_map):
    return [
        array
        for seen in team_map.layer_maps
        for array in (
            seen.hits,
            seen.passes,
            seen.occupied,
            seen.clearances,
            seen.offsets_in(np.argwhere(seen.occupied)),
        )
    ]


def test_pieces_carry_what_a_robot_has_seen(built):
    known, own, pieces = built
    pool = pooled(known, [("r_0", piece) for piece in pieces[0]])
    for there, seen in zip(pool.map.layer_maps, own[0].layer_maps, strict=True):
        assert seen.occupied.any()
        assert (there.occupied == seen.occupied).all()
        assert (there.known >= seen.known).all()
        cells = np.argwhere(seen.occupied)
        assert np.abs(there.points_in(cells) - seen.points_in(cells)).max() < seen.frame.resolution_m  # as first hit
    assert max(map(len, pieces[0])) <= ROOM


def test_the_map_depends_on_no_order_of_robots(built):
    known, _, pieces = built
    tracks = [[(name, piece) for piece in told] for name, told in zip("ab", pieces, strict=True)]
    one = pooled(known, tracks[0] + tracks[1])
    mixed = [piece for pair in itertools.zip_longest(*tracks) for piece in pair if piece is not None]
    for other in (pooled(known, tracks[1] + tracks[0]), pooled(known, mixed)):
        assert all((a == b).all() for a, b in zip(as_arrays(one.map), as_arrays(other.map), strict=True))


def test_the_map_of_the_first_pieces_is_as_it_was_then_to_the_bit(built):
    known, _, pieces = built
    counts = {"a": 2, "b": 1}
    tracks = [(name, piece) for name, told in zip("ab", pieces, strict=True) for piece in told[: counts[name]]]
    then, whole = pooled(known, tracks), pooled(known, [("a", p) for p in pieces[0]] + [("b", p) for p in pieces[1]])
    again, later = copy.deepcopy(known), as_arrays(whole.map)
    whole.enter_first(counts, again)
    assert all((a == b).all() for a, b in zip(as_arrays(then.map), as_arrays(again), strict=True))
    assert all((a == b).all() for a, b in zip(later, as_arrays(whole.map), strict=True))
    whole.enter_first({}, again)
    assert not any(seen.known.any() for seen in again.layer_maps)


def test_clearances_are_those_of_the_obstacles_that_there_are_after_some_have_gone(built):
    """A robot saw another one as an obstacle, and then the ground behind it."""
    known, _, pieces = built
    pool = pooled(known, [("a", piece) for piece in pieces[0]])
    seen = pool.map.layer_maps[0]
    at = 30 * seen.frame.shape[1] + 30
    for ghost in (piece_of(hits=[at]), piece_of(free=[(at, 1)])):
        pool.add("b", ghost)
        assert settled(pool)
    without = pooled(known, [("a", piece) for piece in pieces[0]])
    assert (seen.clearances == without.map.layer_maps[0].clearances).all()


def test_what_a_robot_has_covered_is_no_obstacle_whoever_saw_one_there(built):
    known, _, _ = built
    at = 30 * known.layer_maps[0].frame.shape[1] + 30
    ghosts = [(name, piece_of(hits=[at])) for name in "abcdefg"]
    pool = pooled(known, [*ghosts, ("h", piece_of(free=[(at, 1)]))])
    assert pool.map.layer_maps[0].occupied[30, 30]
    pool.add("h", piece_of(covered=[(at, 1)]))
    settled(pool)
    assert not pool.map.layer_maps[0].occupied[30, 30]


def piece_of(layer=0, free=(), covered=(), hits=(), offsets=None):
    """A piece of runs, each (how far it begins after the one before, its length), and of cells with obstacles."""
    numbers = [n for runs in (free, covered) for column in zip(*runs, strict=True) for n in column]
    numbers += np.diff(hits, prepend=0).astype(int).tolist() if len(hits) else []
    offsets = bytes(2 * len(hits)) if offsets is None else offsets
    head = struct.pack("<BIII", layer, len(free), len(covered), len(hits))
    return zlib.compress(head + np.array(numbers, "<u4").tobytes() + offsets)


@pytest.mark.parametrize(
    "piece",
    [
        b"",
        b"not compressed",
        zlib.compress(b"short"),
        zlib.compress(bytes(13)) + b"more",
        zlib.compress(bytes(13))[:-3],
        zlib.compress(bytes(40 * 2**20)),
        piece_of(layer=9),
        piece_of(free=[(0, 0)]),
        piece_of(free=[(0, 101)]),
        piece_of(free=[(90, 11)]),
        piece_of(free=[(0, 2**32 - 1), (2**32 - 1, 2**32 - 1)]),
        piece_of(free=[(0, 5), (4, 5)]),
        piece_of(free=[(3, 1)], hits=[3]),
        piece_of(hits=[100]),
        piece_of(hits=[5], offsets=b"\0"),
    ],
)
def test_what_is_no_piece_is_refused_in_a_line(piece):
    with pytest.raises(ParameterError, match=r"^piece of a map: .*; expected [^\n]*$"):
        unpacked(piece, [100])


def test_a_piece_that_is_none_counts_as_an_empty_one(built):
    known, _, pieces = built
    pool = PooledMap(copy.deepcopy(known))
    with pytest.raises(ParameterError):
        pool.add("a", b"none")
    for piece in pieces[0]:
        pool.add("a", piece)
    settled(pool)
    again = copy.deepcopy(known)
    pool.enter_first({"a": 1}, again)
    assert not any(seen.known.any() for seen in again.layer_maps)
