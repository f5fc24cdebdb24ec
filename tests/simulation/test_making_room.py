"""Robots without work make room for those who have some, wherever they stand, and come back."""

import itertools

import numpy as np
import pytest
from tests.simulation.scenes import mission, robot

from muster.mission.model import Map
from muster.motion.port import Waypoint
from muster.simulation import KinematicWorld

KINDS = ("holonomic", "differential-drive", "quadcopter")
METHODS = ("orca", "rvo", "hrvo")
HERE, THERE, AWAY = (10.0, 0.0, 0.0), (10.0, 0.1, 0.0), (16.0, 4.0, 0.0)


def disc(name, place, **given):
    return robot(name, place, **({"radius_m": 0.3} | given))


def until_there(world, name, limit_s):
    """Let time go by until a robot has carried out its order; returns when."""
    while not world.idle(name) and world.time_s < limit_s:
        world.advance(limit_s)
    assert world.idle(name)
    return world.time_s


def off(world, name, place):
    return float(np.linalg.norm(world.positions[list(world.ports).index(name)] - place))


@pytest.mark.parametrize(
    ("kind", "method", "speed", "acceleration"),
    list(itertools.product(KINDS, (*METHODS, "avo"), (0.5, 2.0), (None, 1.0))),
)
def test_one_that_has_nothing_to_do_leaves_the_way_point_of_another(kind, method, speed, acceleration):
    given = {"kinematics": kind, "speed_mps": speed, "acceleration_mps2": acceleration}
    world = KinematicWorld(mission(disc("a", (0.0, 0.0), **given), disc("b", HERE[:2], **given)), avoidance=method)
    world.ports["a"].send([Waypoint(THERE)])
    assert until_there(world, "a", 60.0) < 10.0 / speed + 15.0
    assert world.distances_m["a"] < 13.0
    assert off(world, "a", THERE) <= 0.05
    assert world.contacts == ()


@pytest.mark.parametrize(("kind", "method"), list(itertools.product(KINDS, METHODS)))
def test_it_stays_beside_while_the_other_works_and_then_comes_back(kind, method):
    given = {"kinematics": kind}
    world = KinematicWorld(mission(disc("a", (0.0, 0.0), **given), disc("b", HERE[:2], **given)), avoidance=method)
    world.ports["a"].send([Waypoint(THERE, hold_s=40.0), Waypoint(AWAY)])
    world.advance(30.0)
    driven = world.distances_m["b"]
    world.advance(45.0)
    assert off(world, "a", THERE) <= 0.05
    assert world.distances_m["b"] == pytest.approx(driven, abs=0.01)  # it stands
    until_there(world, "a", 100.0)
    world.advance(world.time_s + 10.0)
    assert off(world, "b", HERE) <= 0.021
    assert world.contacts == ()


@pytest.mark.parametrize(
    ("kind", "method", "apart"),
    [(kind, *how) for kind in KINDS for how in (("orca", 0.9), ("rvo", 1.5), ("hrvo", 1.5))],
)
def test_one_among_many_that_have_nothing_to_do_gets_to_the_middle(kind, method, apart):
    places = [(6.0 + apart * x, apart * y) for x in (-1, 0, 1) for y in (-1, 0, 1)]
    crowd = [disc(f"s_{k}", place, kinematics=kind) for k, place in enumerate(places)]
    world = KinematicWorld(mission(disc("go", (0.0, 0.0), kinematics=kind), *crowd), avoidance=method)
    world.ports["go"].send([Waypoint((6.0, 0.0, 0.0), hold_s=5.0), Waypoint((0.0, 0.0, 0.0))])
    until_there(world, "go", 150.0)
    assert world.contacts == ()
    world.advance(world.time_s + 60.0)
    driven = dict(world.distances_m)
    world.advance(world.time_s + 20.0)
    assert world.distances_m == pytest.approx(driven, abs=0.05)  # they do not drive each other about


@pytest.mark.parametrize(("kind", "method"), list(itertools.product(("holonomic", "differential-drive"), METHODS)))
def test_one_in_a_corner_comes_out(kind, method):
    room = Map(boundary=((0, 0), (8, 0), (8, 8), (0, 8)))
    given = {"kinematics": kind}
    team = mission(disc("a", (6.0, 6.0), **given), disc("b", (0.4, 0.4), **given), map=room)
    world = KinematicWorld(team, avoidance=method)
    world.ports["a"].send([Waypoint((0.35, 0.35, 0.0), hold_s=5.0), Waypoint((6.0, 6.0, 0.0))])
    until_there(world, "a", 120.0)
    world.advance(world.time_s + 15.0)
    assert off(world, "b", (0.4, 0.4, 0.0)) <= 0.021
    assert world.contacts == ()


def test_one_in_a_corridor_goes_around_the_corner_into_a_niche():
    corners = ((-6, -0.5), (6, -0.5), (6, 0.5), (3.5, 0.5), (3.5, 2), (2.5, 2), (2.5, 0.5), (-6, 0.5))
    team = mission(disc("go", (-4.0, 0.0)), disc("idle", (1.0, 0.0)), map=Map(boundary=corners))
    world = KinematicWorld(team)
    world.ports["go"].send([Waypoint((5.0, 0.0, 0.0))])
    until_there(world, "go", 60.0)
    assert world.distances_m["go"] < 11.0
    world.advance(world.time_s + 20.0)
    assert off(world, "idle", (1.0, 0.0, 0.0)) <= 0.021
    assert world.contacts == ()


def test_drones_make_room_in_space():
    given = {"kind": "air", "kinematics": "quadcopter"}
    world = KinematicWorld(mission(disc("a", (0.0, 0.0, 3.0), **given), disc("b", (8.0, 0.0, 3.0), **given)))
    world.ports["a"].send([Waypoint((8.0, 0.0, 3.0), hold_s=5.0), Waypoint((8.0, 6.0, 3.0))])
    until_there(world, "a", 60.0)
    world.advance(world.time_s + 15.0)
    assert off(world, "b", (8.0, 0.0, 3.0)) <= 0.021
    assert world.contacts == ()


def test_one_that_is_broken_does_not_move():
    world = KinematicWorld(mission(disc("a", (0.0, 0.0)), disc("b", HERE[:2])))
    world.fail("b")
    world.ports["a"].send([Waypoint(THERE)])
    world.advance(60.0)
    assert world.distances_m["b"] == 0.0
    assert not world.idle("a")


def test_one_that_waits_for_a_place_makes_room_too():
    world = KinematicWorld(mission(disc("works", HERE[:2]), disc("waits", (0.0, 0.0)), disc("late", (0.0, 3.0))))
    world.ports["works"].send([Waypoint(HERE, hold_s=60.0), Waypoint(AWAY)])
    world.ports["waits"].send([Waypoint(HERE)])
    world.advance(20.0)
    x, y, _ = world.positions[1].tolist()
    world.ports["late"].send([Waypoint((x - 0.1, y, 0.0))])
    until_there(world, "late", 50.0)
    assert off(world, "late", (x - 0.1, y, 0.0)) <= 0.05
    until_there(world, "waits", 120.0)
    assert world.contacts == ()


def test_a_queue_of_robots_for_one_place_is_served():
    team = mission(*(disc(f"r_{k}", (3.0 * k, 0.0)) for k in range(6)))
    world = KinematicWorld(team, seed=2)
    for port in world.ports.values():
        port.send([Waypoint((7.0, 4.0, 0.0), hold_s=10.0)])
    for name in world.ports:
        until_there(world, name, 200.0)
    assert world.contacts == ()
