"""Robots that go to goals: each goal is given once, again only where it was not delivered, and arrivals are noticed."""

import threading
from dataclasses import replace

import pytest
from tests.muster_robots.conformance.adapters import PLACES, Yard

import muster
from muster.mission.errors import NetworkError
from muster.mission.model import Mission, Robot, Task
from muster.motion.port import Waypoint
from muster_robots.custody_settings import CustodySettings
from muster_robots.goal_fleet import LEASE_S, GoalFleet

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
    until_s, events = fleet.time_s + seconds, []
    while fleet.time_s + 1e-6 < until_s:
        events += fleet.advance(until_s)
    return events


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


def restart(yard, robot):
    """A robot's computer starts again: it stands, and knows no goal."""
    yard.move()
    yard.bodies[robot].goal = None


def test_a_robot_that_has_lost_its_goal_gets_it_again(yard, fleet):
    fleet.ports["r_0"].send([Waypoint((20.0, 1.0, 0.0))])
    go_on(fleet, 3.0)
    restart(yard, "r_0")
    go_on(fleet, 30.0)
    assert yard.orders == [("r_0", (20.0, 1.0))] * 2
    assert fleet.ports["r_0"].telemetry().passed == 1


def test_a_robot_that_is_to_hold_and_drives_is_told_again(yard, fleet):
    fleet.ports["r_0"].cancel()
    go_on(fleet, 1.0)
    yard.bodies["r_0"].goal = (30.0, 1.0)  # it goes on with what it was told by whomever
    go_on(fleet, 10.0)
    assert yard.orders == [("r_0", None)] * 2
    assert yard.bodies["r_0"].place[0] < 10.0


def test_a_robot_that_comes_back_takes_part_when_it_holds(yard, fleet):
    fleet.ports["r_0"].send([Waypoint((40.0, 1.0, 0.0))])
    go_on(fleet, 1.0)
    yard.silence("r_0")
    go_on(fleet, 10.0)
    fleet.ports["r_0"].cancel()  # as the executor does, whose tasks go to others
    heard_s = fleet.ports["r_0"].telemetry().time_s
    yard.wake("r_0")
    go_on(fleet, 1.0)
    assert fleet.ports["r_0"].telemetry().time_s == heard_s
    go_on(fleet, 4.0)
    assert fleet.ports["r_0"].telemetry().time_s > fleet.time_s - 1.0
    assert yard.orders[-1] == ("r_0", None)


def test_a_mission_goes_on_with_a_robot_that_restarts_and_one_that_is_away_for_a_while(yard):
    kept = CustodySettings(link_lost_s=3.0)
    fleet = GoalFleet(MISSION, yard, custody=kept, clock=yard.clock, wait=yard.clock.advance)
    assert fleet.limits.silent_after_s == 3.0
    fleet.robots_not_ready()
    acts = {1.0: lambda: restart(yard, "r_0"), 2.0: lambda: yard.silence("r_1"), 14.0: lambda: yard.wake("r_1")}

    def go(seconds, advance=yard.clock.advance):
        advance(seconds)
        for at_s in [at_s for at_s in acts if at_s <= yard.clock.now()]:
            acts.pop(at_s)()

    fleet._wait = go
    report = muster.carry_out(MISSION, muster.solve(MISSION, "greedy"), fleet, traffic="free")
    assert sorted(report.tasks_done) == sorted(task.id for task in MISSION.tasks)
    assert not acts


def test_a_robot_that_flaps_is_put_out_for_good(yard):
    kept = CustodySettings(silences=1, link_lost_s=3.0)
    fleet = GoalFleet(MISSION, yard, custody=kept, clock=yard.clock, wait=yard.clock.advance)
    events = []
    for _ in range(3):
        yard.silence("r_1")
        events += go_on(fleet, 4.0)
        yard.wake("r_1")
        events += go_on(fleet, 6.0)
    assert [(event.robot_fails, event.reason) for event in events] == [
        ("r_1", "silent, or without an answer, more than 1 times in 120 s")
    ]


def test_a_robot_that_a_person_drives_is_told_nothing_and_takes_part_again(yard, fleet):
    fleet.ports["r_0"].send([Waypoint((20.0, 1.0, 0.0))])
    go_on(fleet, 2.0)
    body, pose = yard.bodies["r_0"], yard.pose
    yard.pose = lambda name, one: replace(pose(name, one), taken_by="a joystick" if one is body else "")
    body.goal = (5.0, 20.0)
    go_on(fleet, 5.0)
    fleet.ports["r_0"].cancel()
    go_on(fleet, 3.0)
    assert fleet.ports["r_0"].telemetry().suspended == "pilot: a joystick"
    assert yard.orders == [("r_0", (20.0, 1.0))]
    assert fleet.ports["r_1"].telemetry().suspended == ""
    body.goal, yard.pose = None, pose
    go_on(fleet, 12.0)
    assert fleet.ports["r_0"].telemetry().suspended == ""


class LeasedYard(Yard):
    """Its robots stop by themselves where nobody has renewed their orders for a while."""

    until_s = 0.0

    def renew(self, seconds):
        self.until_s = self.clock.now() + seconds

    def move(self):
        if self.clock.now() > self.until_s:
            for body in self.bodies.values():
                body.goal = None
        super().move()


def test_orders_hold_while_they_are_renewed_and_are_given_again_where_that_came_late():
    yard = LeasedYard()
    fleet = GoalFleet(MISSION, yard, clock=yard.clock, wait=yard.clock.advance)
    fleet.robots_not_ready()
    fleet.ports["r_0"].send([Waypoint((60.0, 1.0, 0.0))])
    go_on(fleet, 2 * LEASE_S)
    assert yard.bodies["r_0"].place[0] > 5.0 + 2 * LEASE_S - 2.0
    for _ in range(40):  # Muster is killed, or plans for long
        yard.clock.advance(0.5)
        yard.move()
    left_at = yard.bodies["r_0"].place[0]
    assert left_at < 5.0 + 3 * LEASE_S + 2.0
    go_on(fleet, 10.0)
    assert yard.orders == [("r_0", (60.0, 1.0))] * 2
    assert yard.bodies["r_0"].place[0] > left_at + 3.0
