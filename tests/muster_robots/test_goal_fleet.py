"""Robots that go to goals: each goal is given once, again only where it was not delivered, and arrivals are noticed."""

import threading

import pytest
from tests.muster_robots.conformance.adapters import PLACES, Yard

import muster
from muster.mission.errors import NetworkError
from muster.mission.model import Mission, Robot, Task
from muster.motion.port import Waypoint
from muster_robots.goal_fleet import GoalFleet

MISSION = Mission(
    robots=tuple(Robot(id=name, position=place, radius_m=0.2) for name, place in PLACES.items()),
    tasks=tuple(Task(id=f"t_{k}", position=(8.0, 1.0 + k), duration_s=2.0) for k in range(4)),
)
EAST, NORTH = (7.0, 1.0, 0.0), (7.0, 2.0, 0.0)


@pytest.fixture
def yard():
    return Yard()


@pytest.fixture
def fleet(yard):
    made = GoalFleet(MISSION, yard, clock=yard.clock, wait=yard.clock.advance)
    assert made.robots_not_ready() == {}
    return made


def go_on(fleet, seconds):
    until_s = fleet.time_s + seconds
    while fleet.time_s + 1e-6 < until_s:
        fleet.advance(until_s)


def test_a_mission_takes_one_order_a_goal(yard, fleet):
    report = muster.carry_out(MISSION, muster.solve(MISSION, "greedy"), fleet, traffic="free")
    assert len(report.tasks_done) == 4
    goals = [order for order in yard.orders if order[1] is not None]
    assert sorted(place for _, place in goals) == sorted(task.position for task in MISSION.tasks)
    assert [robot for robot, place in yard.orders if place is None] == ["r_0", "r_1"]  # at the end they are to stay


def test_an_order_that_says_nothing_new_is_sent_all_the_same_and_then_never_again(yard, fleet):
    """It is sent again on purpose: the robot may have lost it."""
    for _ in range(2):
        fleet.ports["r_0"].send([Waypoint(EAST)])
        go_on(fleet, 1.0)
    assert yard.orders == [("r_0", EAST[:2])] * 2


def test_way_points_at_one_place_are_one_goal(yard, fleet):
    fleet.ports["r_0"].send([Waypoint(EAST), Waypoint(EAST, hold_s=1.0, label="work"), Waypoint(NORTH)])
    go_on(fleet, 10.0)
    assert yard.orders == [("r_0", EAST[:2]), ("r_0", NORTH[:2])]
    assert fleet.ports["r_0"].telemetry().passed == 3


def test_what_is_not_delivered_is_sent_again_and_counts_as_taken_only_then(yard, fleet):
    yard.silence("r_0")
    order = fleet.ports["r_0"].send([Waypoint(EAST)])
    fleet.ports["r_1"].send([Waypoint(NORTH)])
    go_on(fleet, 3.0)
    assert yard.orders == [("r_1", NORTH[:2])]
    assert fleet.ports["r_0"].telemetry().order != order
    assert fleet.not_told == ["r_0"]
    yard.wake("r_0")
    go_on(fleet, 4.0)
    assert yard.orders == [("r_1", NORTH[:2]), ("r_0", EAST[:2])]
    assert (fleet.ports["r_0"].telemetry().order, fleet.ports["r_0"].telemetry().passed) == (order, 1)
    assert fleet.not_told == []


def test_only_the_newest_order_is_delivered_late(yard, fleet):
    yard.silence("r_0")
    fleet.ports["r_0"].send([Waypoint(EAST)])
    go_on(fleet, 1.0)
    fleet.ports["r_0"].send([Waypoint(NORTH)])
    go_on(fleet, 1.0)
    yard.wake("r_0")
    go_on(fleet, 1.0)
    assert yard.orders == [("r_0", NORTH[:2])]


def test_a_robot_that_cannot_be_told_to_stop_is_named(yard, fleet):
    yard.silence("r_1")
    fleet.stop()
    assert fleet.not_told == ["r_1"]
    assert yard.orders == [("r_0", None)]


def test_a_server_that_does_not_answer_is_a_silence_that_is_logged_once(yard, fleet, caplog):
    go_on(fleet, 1.0)
    heard_s, answers = fleet.ports["r_0"].telemetry().time_s, yard.poses
    yard.poses = refuses
    go_on(fleet, 3.0)
    assert fleet.ports["r_0"].telemetry().time_s == heard_s < fleet.time_s - 2.5
    assert caplog.messages == ["the server of the robots is not reached: OSError: connection refused"]
    yard.poses = answers
    go_on(fleet, 1.0)
    assert fleet.time_s - fleet.ports["r_0"].telemetry().time_s < 0.5


def test_an_error_of_the_adapter_itself_is_no_silence(yard, fleet):
    yard.poses = lambda: {}["no such key"]
    with pytest.raises(KeyError):
        go_on(fleet, 1.0)


@pytest.mark.parametrize(("poses", "why"), [(dict, "no pose"), (None, "OSError: connection refused")])
def test_robots_that_do_not_report_are_named(yard, poses, why):
    yard.poses = poses or refuses
    with pytest.raises(NetworkError, match=rf"^robot r_0: {why} within 0 s \(and 1 more\); expected its pose$"):
        GoalFleet.ready(MISSION, yard, threading.Event(), wait_s=0.0)


def refuses():
    raise OSError("connection refused")
