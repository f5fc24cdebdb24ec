"""Who waits in traffic for whom, what that counts, and how jams end."""

import math
from dataclasses import replace

import pytest
from tests.execution.test_executor import kinds, line, plan_of
from tests.execution.world import Point, World, carry_out

from muster import Robot
from muster.execution.deadlocks.traffic_waits import TrafficWaits
from muster.execution.executor import Executor
from muster.execution.reports.report import report_of
from muster.execution.robots.monitor import Limits
from muster.execution.robots.robot_state import Activity, RobotState
from muster.execution.status import status_of
from muster.execution.supervision import NoLeader
from muster.mission.model import Event
from muster.motion.leg_times import LegTimes
from muster.motion.port import Waypoint
from muster.state.robot_events import RobotStuck
from muster.state.robots import KnownRobot
from muster.state.traffic_account import HeldUp, TrafficAccount


def standing(name, place, *points, activity=Activity.DRIVING, radius_m=0.3):
    """A robot that is to pass points, and stands where it is."""
    robot = Robot(id=name, position=place, radius_m=radius_m)
    port = Point(robot)
    port.step(0.0)
    state = RobotState(robot, KnownRobot(robot), port, None, LegTimes(1.0), in_time=False, last_heard_s=0.0)
    state.hear(0.0)
    if points:
        state.send(0.0, activity, [Waypoint((*point, 0.0), hold_s=100.0) for point in points])
    state.activity = activity
    return state


def waiting_among(*states, looks=4):
    """By robot for whom it waits, after some looks."""
    waits = TrafficWaits({state.robot.id: state for state in states})
    for k in range(looks):
        list(waits.look(0.5 * k))
    return {robot: waits.waits_for(robot) for robot in waits.waits}, waits


def test_those_wait_who_have_one_before_them():
    works = standing("w", (5, 0), (5, 0), activity=Activity.WORKING)
    near, behind = standing("a", (4.3, 0), (5, 0.1)), standing("b", (3.5, 0), (5, 0.1), activity=Activity.RETURNING)
    elsewhere = standing("c", (3, 3), (5, 3))
    found, waits = waiting_among(works, near, behind, elsewhere)
    assert found == {"a": "w", "b": "a"}
    assert waits.jams() == set()  # work ends


def test_of_two_at_work_close_by_the_one_that_is_off_its_place_waits():
    works = standing("w", (5, 0), (5, 0), activity=Activity.WORKING)
    off = standing("o", (5.65, 0), (5.0, 0), activity=Activity.WORKING)
    assert waiting_among(works, off)[0] == {"o": "w"}


def test_the_way_around_a_corner_counts_and_what_is_behind_does_not():
    behind = standing("b", (-0.65, 0), activity=Activity.IDLE)
    turns = standing("t", (0, 0), (0.2, 0), (0.2, 2), radius_m=0.3)
    beside = standing("s", (0.2, 0.75), activity=Activity.IDLE)
    assert waiting_among(behind, turns)[0] == {}
    assert waiting_among(behind, turns, beside)[0] == {"t": "s"}


def test_points_and_bodies_of_another_kind_hold_nobody_up():
    assert waiting_among(standing("a", (0, 0), (5, 0)), standing("p", (0.5, 0), radius_m=0.0))[0] == {}


def test_who_is_sent_another_way_that_is_longer_has_its_time_anew():
    state = standing("a", (0, 0), (5, 0))
    waits = TrafficWaits({"a": state})
    told_m = {0.0: 5.0, 1.0: 4.9, 2.0: 4.8, 3.0: 20.0, 4.0: 19.9}
    sent_round = {}
    for now, left_m in told_m.items():
        state.telemetry = replace(state.telemetry, left_m=left_m, order=state.order)
        list(waits.look(now))
        sent_round[now] = set(waits.sent_round)
    assert sent_round == {0.0: set(), 1.0: set(), 2.0: set(), 3.0: {"a"}, 4.0: set()}
    assert waits.progress["a"].least_m == 20.0


def test_a_short_halt_is_no_wait():
    found, waits = waiting_among(standing("a", (0, 0), (5, 0)), standing("b", (0.65, 0), (0.65, 5)), looks=2)
    assert found == {"a": ""}
    assert waits.with_waits(TrafficAccount()).pairs == {}


def test_robots_face_to_face_are_a_jam_and_so_is_one_before_an_idle_one():
    ring = standing("a", (0, 0), (5, 0)), standing("b", (0.65, 0), (-5, 0))
    assert waiting_among(*ring)[1].jams() == {frozenset("ab")}
    third = standing("c", (-0.65, 0), (5, 0))
    assert waiting_among(third, *ring)[1].jams() == {frozenset("ab")}
    idle = standing("a", (0, 0), (5, 0)), standing("i", (0.65, 0), activity=Activity.IDLE)
    assert waiting_among(*idle)[1].jams() == {frozenset("ai")}


def test_an_account_adds_up_and_keeps_the_longest():
    once = HeldUp.once(3.0, (1.0, 0.0, 0.0))
    assert once.and_again(5.0, (2.0, 0.0, 0.0)) == HeldUp(8.0, 2, 5.0, (2.0, 0.0, 0.0))
    assert once.and_again(1.0, (2.0, 0.0, 0.0)) == HeldUp(4.0, 2, 3.0, (1.0, 0.0, 0.0))


def between(first_s, last_s, robot, other):
    """For `each` of `carry_out`: a robot says for so long that it waits for another."""

    def each(world, executor):
        world.ports[robot].waits_for = other if first_s <= world.now < last_s else ""

    return each


def test_who_waits_is_not_stuck_however_long_and_it_is_counted_and_shown():
    mission, seen = line(40.0, 200.0, robots=2), []
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"], r_1=["1"]), world.ports, limits=Limits(stuck_after_s=10))
    holds_up = between(5, 155, "r_0", "r_1")

    def each(world, executor):
        holds_up(world, executor)
        seen.append(status_of(executor).robots["r_0"])

    carry_out(executor, world, each=each, until=1000)
    report = report_of(executor.account)
    assert executor.crew["r_0"].done == ["0"]
    assert not {"robot_sent_again", RobotStuck.kind, "traffic_jam"} & set(kinds(executor))
    assert [(row.robot, row.waits_for, row.times) for row in report.traffic] == [("r_0", "r_1", 1)]
    assert report.traffic[0].waiting_s == pytest.approx(150, abs=1.1)
    assert report.traffic[0].position == pytest.approx((5, 0, 0), abs=0.6)
    assert report.waiting_s == report.waiting_by_cause_s["traffic"] == report.traffic[0].waiting_s
    waits, goes_on = (e for e in executor.events if e.kind in ("waits_in_traffic", "goes_on"))
    assert goes_on.data["until_s"] - waits.data["since_s"] == pytest.approx(report.waiting_s)
    shown = [status for status in seen if status.activity == "in traffic"]
    assert {(status.held_up_by, status.task, status.waits) for status in shown} == {
        ("r_1", "0", "waits in traffic for r_1")
    }
    assert len(shown) * 0.1 == pytest.approx(150, abs=2.5)


def test_a_wait_that_is_not_over_is_in_the_report_too():
    mission = line(40.0, 200.0, robots=2)
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"], r_1=["1"]), world.ports)
    carry_out(executor, world, each=between(5, 155, "r_0", "r_1"), until=50)
    assert report_of(executor.account).waiting_s == pytest.approx(45, abs=1.1)


def jammed(**limits):
    """Two robots that say for ever that each waits for the other."""
    mission = line(40.0, 50.0, robots=2)
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"], r_1=["1"]), world.ports, limits=Limits(**limits))

    def each(world, executor):
        for one, other in (("r_0", "r_1"), ("r_1", "r_0")):
            both = executor.crew[one].route and executor.crew[other].route
            world.ports[one].waits_for = other if both and world.now >= 5 else ""

    return carry_out(executor, world, each=each, until=1000)


def test_in_a_jam_one_after_the_other_stands_aside_it_is_told_once_and_one_gives_up():
    executor = jammed(aside_after_s=5, aside_s=2, jam_after_s=20)
    asides = [event.data["robot"] for event in executor.events if event.kind == "robot_stands_aside"]
    assert asides[:4] == ["r_0", "r_1", "r_0", "r_1"]
    jams = [event for event in executor.events if event.kind == "traffic_jam"]
    assert [sorted(event.data["robots"]) for event in jams] == [["r_0", "r_1"]]
    assert not {state.out for state in executor.crew.values()} - {""}
    refused = [event.data for event in executor.events if event.kind == "task_refused"]
    assert refused[0]["reason"].startswith("jam: held up by r_")
    assert executor.done
    assert sorted(executor.ledger.ends_s) == ["0", "1"]  # the other robot did it, too


def test_nobody_waits_for_ever_for_one_that_is_out():
    mission = line(40.0, robots=2, events=[Event(at_s=1, robot_fails="r_1")])
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports, limits=Limits(stuck_after_s=10))
    carry_out(executor, world, each=between(5, 1000, "r_0", "r_1"), until=1000)
    assert executor.done
    assert "unreachable: r_1 stands there, out (r_0)" in executor.lost()["0"]
    assert not executor.crew["r_0"].out


def test_one_that_has_nothing_to_do_and_makes_no_room_is_out_until_it_moves():
    class Leader(NoLeader):
        def makes_no_room(self, robot):
            return robot == "r_1" and 5 <= world.now < 20

    mission = line(40.0, robots=2)
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0"]), world.ports, leader=Leader())
    carry_out(executor, world, until=10)
    assert executor.crew["r_1"].out == RobotStuck.kind
    assert next(e.data for e in executor.events if e.kind == RobotStuck.kind)["reason"] == "makes no room for others"
    assert not executor.crew["r_0"].out


def test_all_wait_anew_where_one_that_was_out_takes_part_again():
    """Else one would give up for r_2 what r_1 kept from it."""
    waits_on, out, moves = standing("r_0", (4.3, 0), (6, 0)), standing("r_1", (9, 9)), standing("r_2", (5, 0))
    out.known.out = moves.known.out = RobotStuck.kind
    _, waits = waiting_among(waits_on, out, moves, looks=8)
    assert waits.progress["r_0"].behind_s["r_2"] > 2.0
    out.known.out = ""
    list(waits.look(4.0))
    assert waits.progress["r_0"].behind_s["r_2"] == 0.5


def test_waits_for_one_that_goes_out_count_anew_as_ways_lead_round_it_from_then_on():
    waits_on, holds_up = standing("r_0", (4.3, 0), (6, 0)), standing("r_1", (5, 0))
    _, waits = waiting_among(waits_on, holds_up, looks=8)
    assert waits.progress["r_0"].behind_s["r_1"] > 2.0
    holds_up.known.out = RobotStuck.kind
    list(waits.look(4.0))
    list(waits.look(4.5))
    assert waits.progress["r_0"].behind_s["r_1"] == 1.0


def test_a_task_given_up_in_a_jam_behind_one_that_is_out_is_tried_again_when_that_is_back():
    """Traffic that steers r_0 knows a way past r_1, so that the task is not called unreachable."""
    events = [Event(at_s=1, robot_fails="r_1"), Event(at_s=100, robot_returns="r_1")]
    mission = line(40.0, 50.0, robots=2, events=events, only_robots=["r_0"])
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0", "1"]), world.ports, limits=Limits(stuck_after_s=10))
    holds_up = between(5, 60, "r_0", "r_1")

    def each(world, executor):
        holds_up(world, executor)
        port = world.ports["r_0"]
        left = port.waypoints[port.passed :]
        port.last = replace(port.last, left_m=math.dist(port.position, left[0].position) if left else 0.0)

    carry_out(executor, world, each=each, until=1000)
    refused = [event.data for event in executor.events if event.kind == "task_refused"]
    assert (refused[0]["task"], refused[0]["reason"]) == ("0", "jam: held up by r_1, out")
    assert sorted(executor.crew["r_0"].done) == ["0", "1"]


def test_a_robot_that_was_stuck_is_back_when_it_moves():
    mission = line(40.0, 60.0)
    later = Event(at_s=100, new_task=replace(mission.tasks[1], id="2"))  # nothing would wait for it otherwise
    mission = replace(mission, events=(later,))
    world = World(mission)
    executor = Executor(mission, plan_of(r_0=["0", "1"]), world.ports, limits=Limits(stuck_after_s=10))
    port = world.ports["r_0"]

    def each(world, executor):
        port.broken = 5 <= world.now < 60
        if executor.crew["r_0"].out and world.now > 60:
            port.position = (port.position[0] + 0.05, *port.position[1:])  # somebody has freed it

    carry_out(executor, world, each=each, until=1000)
    stuck, back = (next(e for e in executor.events if e.kind == kind) for kind in (RobotStuck.kind, "robot_returns"))
    assert stuck.data["reason"] == "no progress with nobody in its way"
    assert back.data == {"robot": "r_0", "reason": "it moves again"}
    assert executor.crew["r_0"].done == ["0", "1", "2"]
