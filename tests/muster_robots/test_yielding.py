"""Robots that wait step aside for those that come, and come back."""

import math

import pytest

from muster.mission.model import Robot
from muster.motion.frames import flu_to_enu
from muster.motion.port import Waypoint
from muster_robots.steering import SteeredRobot, Steering
from muster_robots.yielding import Yielding

DT = 0.05
RADIUS = 0.3


def robot(name, **more):
    return Robot(id=name, position=(0.0, 0.0), radius_m=RADIUS, kinematics="holonomic", **more)


def waiting(name, place, **more):
    return SteeredRobot(robot(name, **more), (*place, 0.0), 0.0, (0.0, 0.0, 0.0), None, False, waits=True)


def going(name, place, aim, velocity=(1.0, 0.0, 0.0)):
    return SteeredRobot(robot(name), (*place, 0.0), 0.0, velocity, Waypoint((*aim, 0.0)), False)


def room(**more):
    return Yielding(arrival_m=0.1, **more)


def aim_of(arranged, name):
    (found,) = (steered.aim for steered in arranged if steered.robot.id == name)
    return None if found is None else found.position[:2]


def test_who_is_in_nobodys_way_stays():
    team = [waiting("a", (0, 0)), going("b", (5, 0), (0, 1))]
    assert room().arranged(0.0, team) == team


def test_who_stands_where_another_goes_steps_aside_and_comes_back():
    it = room()
    aside = aim_of(it.arranged(0.0, [waiting("a", (0, 0)), going("b", (5, 0), (0.2, 0))]), "a")
    assert math.dist(aside, (0.2, 0)) >= 2 * RADIUS + 0.1
    assert math.dist(aside, (0, 0)) < 1.0
    on_it = it.arranged(9.0, [waiting("a", aside), going("b", (0.2, 0), (5, 0))])
    assert aim_of(on_it, "a") == aside
    back = it.arranged(10.0, [waiting("a", aside), going("b", (2, 0), (5, 0))])
    assert aim_of(back, "a") == (0, 0)
    assert aim_of(it.arranged(12.0, [waiting("a", (0, 0)), going("b", (4, 0), (5, 0))]), "a") is None


@pytest.mark.parametrize("stands", [{"waits": False}, {"kind": "air"}, {"radius_m": 0.0}])
def test_who_works_and_who_is_in_nobodys_way_is_not_moved(stands):
    one = waiting("a", (0, 0))
    waits = stands.pop("waits", True)
    one = SteeredRobot(
        Robot(**{"id": "a", "position": (0.0, 0.0), "radius_m": RADIUS, **stands}),
        one.position,
        0.0,
        (0.0, 0.0, 0.0),
        None,
        False,
        waits,
    )
    assert aim_of(room().arranged(0.0, [one, going("b", (5, 0), (0, 0))]), "a") is None


def test_who_blocks_a_way_steps_aside_when_the_other_is_held_up():
    it, still = room(), (0.0, 0.0, 0.0)
    team = [waiting("a", (1, 0)), going("b", (0, 0), (9, 0), still)]
    assert aim_of(it.arranged(0.0, team), "a") is None
    assert aim_of(it.arranged(0.5, team), "a") is None
    aside = aim_of(it.arranged(1.1, team), "a")
    assert abs(aside[1]) >= 2 * RADIUS + 0.1 - 1e-9 or aside[0] > 3.0


COMES = going("b", (5, 0), (0.2, 0))
LEAVES = going("b", (3, 0), (5, 0))


def test_it_steps_onto_nobody():
    crowd = [waiting("a", (0, 0)), waiting("c", (0.8, 0)), going("b", (5, 0), (0, 0))]
    arranged = room().arranged(0.0, crowd)
    assert math.dist(aim_of(arranged, "a"), (0.8, 0)) >= 2 * RADIUS + 0.1


def test_it_goes_only_where_it_may_go_straight_both_there_and_back():
    asked = []

    def to_the_east(who, here, there):
        asked.append((who.id, here[:2], there[:2]))
        return max(here[0], there[0]) > 0.5

    aside = aim_of(room(may_go=to_the_east).arranged(0.0, [waiting("a", (0, 0)), COMES]), "a")
    assert aside[0] > 0.5
    assert asked[-2:] == [("a", (0, 0), aside), ("a", aside, (0, 0))]
    nowhere = room(may_go=lambda *_: False)
    assert aim_of(nowhere.arranged(0.0, [waiting("a", (0, 0)), COMES]), "a") is None


def test_it_does_not_come_back_where_others_have_led_it_behind_a_wall():
    walls = []
    it = room(may_go=lambda *_: not walls)
    aside = aim_of(it.arranged(0.0, [waiting("a", (0, 0)), COMES]), "a")
    walls.append("between it and its post")
    assert aim_of(it.arranged(9.0, [waiting("a", aside), LEAVES]), "a") is None
    walls.clear()  # where it stands is its place now
    assert aim_of(it.arranged(10.0, [waiting("a", aside), LEAVES]), "a") is None


def test_who_was_moved_by_somebody_else_is_not_brought_back():
    it = room()
    for k in range(50):
        assert aim_of(it.arranged(0.05 * k, [waiting("a", (0.1 * k, 0)), going("b", (0, 9), (9, 9))]), "a") is None


@pytest.mark.parametrize("when", ["on its way aside", "standing aside", "on its way back", "back"])
def test_who_is_pushed_while_it_makes_room_is_not_brought_back(when):
    it = room()
    aside = aim_of(it.arranged(0.0, [waiting("a", (0, 0)), COMES]), "a")
    if when != "on its way aside":
        it.arranged(1.0, [waiting("a", aside), COMES])
    if when in ("on its way back", "back"):
        assert aim_of(it.arranged(5.0, [waiting("a", aside), LEAVES]), "a") == (0, 0)
    if when == "back":
        assert aim_of(it.arranged(6.0, [waiting("a", (0, 0)), LEAVES]), "a") is None
    far = (-0.3, 0.0) if when == "back" else (-0.6, -1.6)
    for k in range(3):
        assert aim_of(it.arranged(7.0 + k, [waiting("a", far), LEAVES]), "a") is None


def test_who_makes_room_again_and_again_comes_back_to_where_it_began():
    it, place = room(), (0.0, 0.0)
    for k in range(5):
        aside = aim_of(it.arranged(10.0 * k, [waiting("a", place), COMES]), "a")
        assert aim_of(it.arranged(10.0 * k + 5, [waiting("a", aside), LEAVES]), "a") == (0, 0)
        place = (0.09, 0.0)  # as near as counts as there
        assert aim_of(it.arranged(10.0 * k + 8, [waiting("a", place), LEAVES]), "a") is None


def test_one_works_where_another_waits_and_nobody_touches():
    """Steered together: b works 0.4 m from where a waits, goes home, and a is back where it was."""
    bodies = {"a": robot("a"), "b": robot("b")}
    places = {"a": (0.0, 0.0), "b": (4.0, 0.0)}
    velocities = dict.fromkeys(places, (0.0, 0.0, 0.0))
    steering, it = Steering(interval_s=DT, space=False), room()
    reached_s = None
    apart = math.inf
    for k in range(800):
        now = k * DT
        aim = (0.4, 0.0) if reached_s is None or now < reached_s + 3 else (4.0, 0.0)
        there = math.dist(places["b"], aim) < 0.1
        if there and aim[0] < 1 and reached_s is None:
            reached_s = now
        team = [
            SteeredRobot(bodies["a"], (*places["a"], 0.0), 0.0, velocities["a"], None, False, waits=True),
            SteeredRobot(bodies["b"], (*places["b"], 0.0), 0.0, velocities["b"], Waypoint((*aim, 0.0)), there),
        ]
        for name, (*body, _) in steering.velocities(it.arranged(now, team)).items():
            velocities[name] = tuple(map(float, flu_to_enu(body, 0.0)))
            places[name] = tuple(p + DT * v for p, v in zip(places[name], velocities[name], strict=False))
        apart = min(apart, math.dist(places["a"], places["b"]))
    assert reached_s is not None
    assert apart >= 2 * RADIUS
    assert math.dist(places["a"], (0, 0)) < 0.15
    assert math.dist(places["b"], (4, 0)) < 0.15


@pytest.mark.parametrize("heard_share", [0.2, 0.4, 0.7, 1.0])
@pytest.mark.parametrize("work", [(0.0, 0.0), (0.3, 0.2)])
def test_two_that_meet_at_one_place_do_not_stand_off_where_one_is_heard_late(heard_share, work):
    """Of each second b is heard for a share, and stands for the rest: under load that is so."""
    bodies = {"a": robot("a"), "b": robot("b")}
    places = {"a": (0.0, 0.0), "b": (4.0, 0.0)}
    velocities = dict.fromkeys(places, (0.0, 0.0, 0.0))
    steering, it = Steering(interval_s=DT, space=False), room()
    turns, aside = 0, False  # how often a sets out to come back
    for k in range(1600):
        now = k * DT
        there = math.dist(places["b"], work) < 0.1
        if there:
            break
        heard = now % 1.0 < heard_share
        aim = Waypoint((*work, 0.0)) if heard else None
        team = [
            SteeredRobot(bodies["a"], (*places["a"], 0.0), 0.0, velocities["a"], None, False, waits=True),
            SteeredRobot(bodies["b"], (*places["b"], 0.0), 0.0, velocities["b"], aim, there),
        ]
        arranged = it.arranged(now, team)
        comes_back = aim_of(arranged, "a") == (0.0, 0.0)
        turns += comes_back and aside
        aside = not comes_back
        for name, (*body, _) in steering.velocities(arranged).items():
            velocities[name] = tuple(map(float, flu_to_enu(body, 0.0)))
            places[name] = tuple(p + DT * v for p, v in zip(places[name], velocities[name], strict=False))
    assert there
    assert turns == 0
