"""Lasers in both worlds: fixed scenes, walls of shipped maps, who is seen, and errors by seed."""

import math
from dataclasses import replace
from importlib.util import find_spec

import numpy as np
import pytest

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Map, Mission, Robot, Zone
from muster.motion.map_world import World, body_of
from muster.perception.laser import Scanner, faces_at, points_of
from muster.perception.spikes import SpikeParameters, landmarks
from muster.simulation import KinematicWorld, Laser
from muster.simulation.walls import faces_and_slabs

THICK_M = 0.01
"""A wall of the physics world reaches so far to both sides of its face."""


def made(name, mission, **how):
    if name == "physics":
        if find_spec("mujoco") is None:  # not imported here: first it must be said how it draws
            pytest.skip("the extra `physics` is not installed")
        from muster_physics import PhysicsWorld

        return PhysicsWorld(mission, **how)
    return KinematicWorld(mission, **how)


@pytest.fixture(params=["kinematic", "physics"])
def make(request):
    return lambda mission, **how: made(request.param, mission, **how)


def robot(name, x, y, **how):
    return Robot(id=name, position=(x, y), **({"radius_m": 0.2, "kinematics": "holonomic"} | how))


def room(*robots, zones=()):
    corners = ((-3.0, -3.0), (3.0, -3.0), (3.0, 3.0), (-3.0, 3.0))
    return Mission(robots=robots, tasks=(), map=Map(boundary=corners, zones=zones))


def towards(scanner, ranges, degrees):
    """The range of the beam that is nearest to a bearing."""
    return ranges[np.abs(scanner.bearings - math.radians(degrees)).argmin()]


def test_a_wall_a_robot_and_a_cylinder(make):
    """Distances by hand; a robot is as large as its radius, or half of it where it has its true body."""
    world, scanner = make(room(robot("a", 0, 0), robot("b", 2, 0))), Scanner()
    ranges = world.scan("a", scanner, np.array([[0.0, 1.5, 0.05]]))
    assert ranges.shape == (667,)
    true_body = not isinstance(world, KinematicWorld)
    assert towards(scanner, ranges, 0) == pytest.approx(1.9 if true_body else 1.8, abs=1e-3)
    assert towards(scanner, ranges, 90) == pytest.approx(1.45, abs=1e-3)
    assert towards(scanner, ranges, -90) == pytest.approx(3.0 - THICK_M * true_body, abs=1e-3)
    assert towards(scanner, ranges, -45) == np.inf
    (mark,) = landmarks(ranges, scanner.bearings, SpikeParameters(largest_m=0.08))
    assert mark.position == pytest.approx((0.0, 1.5), abs=0.005)


def test_it_looks_where_the_robot_looks(make):
    world, scanner = make(room(robot("a", 1, 0, heading_deg=90))), Scanner(reach_m=10)
    ranges = world.scan("a", scanner)
    assert [towards(scanner, ranges, at) for at in (0, 90, -90)] == pytest.approx([3, 4, 2], abs=0.011)


@pytest.mark.parametrize("name", ["floor", "market-rescue-arena", "yard"])
def test_both_worlds_see_the_walls_of_a_map_alike(name):
    """Each robot alone: what the physics world's beams hit is on a wall of the map, and no beam goes through one."""
    mission, scanner = muster.load(name), Scanner(reach_m=20)
    height_m = 0.05
    for one in mission.robots:
        alone = replace(mission, robots=(one,), tasks=(), events=())
        kinematic, physical = (made(world, alone) for world in ("kinematic", "physics"))
        exact, cast = (world.scan(one.id, scanner, height_m=height_m) for world in (kinematic, physical))
        assert np.isfinite(exact).any()
        assert (cast <= exact + 1e-6).all()
        near = np.isfinite(exact)
        assert np.median(exact[near] - cast[near]) <= 1.5 * THICK_M
        (x, y, *_), turn = one.position, math.radians(one.heading_deg)
        hits = points_of(cast, scanner.bearings) @ [[math.cos(turn), math.sin(turn)], [-math.sin(turn), math.cos(turn)]]
        z = one.position[2] if mission.dimensions == 3 else 0.0
        walls = faces_at(faces_and_slabs(World.of(mission), body_of(one))[0], z + height_m)
        assert distances(hits + np.array([x, y]), walls).max() <= THICK_M * math.sqrt(2) + 1e-6


def distances(points, walls):
    """From points (n, 2) to the nearest of walls (k, 4): (n,)."""
    start, way = walls[None, :, :2], walls[None, :, 2:] - walls[None, :, :2]
    away = points[:, None] - start
    share = np.clip((away * way).sum(axis=2) / (way**2).sum(axis=2), 0, 1)
    return np.linalg.norm(away - share[:, :, None] * way, axis=2).min(axis=1)


def test_it_sees_walls_that_stop_its_robot_and_no_others(make):
    square = ((1.0, -1.0), (2.0, -1.0), (2.0, 1.0), (1.0, 1.0))
    low = Zone(polygon=square, forbidden_to=("ground",))
    mission = room(robot("a", 0, 0), robot("d", 0, 0, kind="air"), zones=(low,))
    world, scanner = make(mission), Scanner()
    assert towards(scanner, world.scan("a", scanner), 0) == pytest.approx(1.0, abs=0.011)
    assert towards(scanner, world.scan("d", scanner), 0) == pytest.approx(3.0, abs=0.011)


@pytest.mark.parametrize("kinematics", ["holonomic", "differential-drive"])
@pytest.mark.parametrize("height_m", [None, 0.02, 0.08])
def test_a_robot_does_not_see_itself(make, kinematics, height_m):
    world = make(room(robot("a", 0, 0, kinematics=kinematics)))
    assert world.scan("a", Scanner(reach_m=2.5), height_m=height_m).min() == np.inf


def test_a_laser_above_others_looks_over_them(make):
    world, scanner = make(room(robot("a", 0, 0), robot("b", 2, 0))), Scanner()
    assert towards(scanner, world.scan("a", scanner, height_m=0.3), 0) == pytest.approx(3.0, abs=0.011)


def test_in_space_it_sees_who_is_at_its_height(make):
    """Both worlds: the drone at the height of the laser, not the one above it."""
    how = {"kind": "air", "kinematics": "quadcopter", "radius_m": 0.7}
    places = {"a": (0.0, 0.0, 2.0), "b": (2.0, 0.0, 2.0), "c": (0.0, 2.0, 4.0)}
    robots = tuple(Robot(id=name, position=place, **how) for name, place in places.items())
    world, scanner = make(Mission(robots=robots, tasks=())), Scanner()
    ranges = world.scan("a", scanner)
    assert 1.2 < np.min(ranges[np.abs(scanner.bearings) < 0.3]) < 1.9
    assert towards(scanner, ranges, 90) == np.inf


def test_who_joins_is_seen(make):
    world, scanner = make(room(robot("a", 0, 0))), Scanner(reach_m=2.5)
    assert world.scan("a", scanner).min() == np.inf
    world.join(robot("b", 2, 0))
    assert 1.7 < world.scan("a", scanner).min() < 2


def test_errors_are_by_seed_robot_and_moment(make):
    world, scanner = make(room(robot("a", -1, 0), robot("b", 1, 0))), Scanner(range_m=0.01, stray_share=0.01)
    first, second = Laser(world, "a", scanner, seed=1), Laser(world, "a", scanner, seed=1)
    there = first.scan()
    assert np.array_equal(there, first.scan())
    assert np.array_equal(there, second.scan())
    assert not np.array_equal(there, Laser(world, "a", scanner, seed=2).scan())
    other = Laser(world, "b", scanner, seed=1).scan()
    exact = [world.scan(name, scanner) for name in "ab"]
    both = np.isfinite([there, other, *exact]).all(axis=0)
    off = np.array([there, other])[:, both] - np.array(exact)[:, both]
    assert abs(np.corrcoef(off)[0, 1]) < 0.5
    world.step()
    assert not np.array_equal(there, first.scan())


def test_without_errors_a_laser_measures_what_is_there(make):
    world = make(room(robot("a", 0, 0)))
    laser = Laser(world, "a")
    assert np.array_equal(laser.scan(), world.scan("a", laser.scanner))
    assert len(laser.bearings) == 667


def test_words_for_what_cannot_be(make):
    world = make(room(robot("rover", 0, 0)))
    with pytest.raises(ParameterError, match=r"robot rovr: not in the world; expected one of it.*rover"):
        world.scan("rovr", Scanner())
    with pytest.raises(ParameterError, match="height_m: nan; expected a finite number"):
        world.scan("rover", Scanner(), height_m=math.nan)
    with pytest.raises(ParameterError, match=r"discs: shape \(1, 2\); expected \(any, 3\)"):
        world.scan("rover", Scanner(), np.zeros((1, 2)))
    with pytest.raises(ParameterError, match="seed: -1; expected a whole number"):
        Laser(world, "rover", seed=-1)
