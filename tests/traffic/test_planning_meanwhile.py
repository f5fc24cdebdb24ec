"""Traffic is planned while robots go on by the plan before: in the mission's time, or in a thread."""

from __future__ import annotations

import math
import threading

import pytest

from muster import Robot
from muster.motion.port import Telemetry, Waypoint
from muster.traffic.journeys.travellers import Move, PlannedMoves
from muster.traffic.reservation.planning import PLANNING_S, DelayedPlanning, ThreadedPlanning
from muster.traffic.reservation.reserved import ReservedTraffic

STEP_S, SPEED = 0.2, 1.0


class Drive:
    """A port to a robot that drives along a line to where it is sent, and works nowhere."""

    robot = "r_0"

    def __init__(self) -> None:
        self.now, self.x, self.passed = 0.0, 0.0, 0
        self.sent: list[tuple[Waypoint, ...]] = []

    def send(self, waypoints):
        self.sent.append(tuple(waypoints))
        self.passed = 0
        return len(self.sent)

    def cancel(self):
        return self.send(())

    def telemetry(self):
        velocity = (0.0, 0.0, 0.0)
        return Telemetry(self.now, (self.x, 0.0, 0.0), 0.0, velocity, abs(self.x), len(self.sent), self.passed)

    def drive(self):
        self.now += STEP_S
        left_m = STEP_S * SPEED
        ahead = self.sent[-1][self.passed :] if self.sent else ()
        for waypoint in ahead:
            away_m = waypoint.position[0] - self.x
            self.x += math.copysign(min(left_m, abs(away_m)), away_m)
            if abs(away_m) > left_m:
                return
            left_m -= abs(away_m)
            self.passed += 1


class Traffic:
    """Traffic of one robot on a line, whose plans lead it by metres to its goal."""

    def __init__(self, planning, before=lambda: None) -> None:
        self.before, self.asked = before, []
        self.drive = Drive()
        self.traffic = ReservedTraffic(self, planning=planning)
        self.port = self.traffic.managed(Robot(id="r_0", position=(0.0, 0.0), radius_m=0.3), self.drive)

    def __call__(self, travellers):
        self.before()
        (start, _), (goal, _) = travellers[0].start, travellers[0].stops[0].at
        self.asked.append(start)
        steps = max(1, math.ceil(abs(goal - start)))
        return PlannedMoves([Move(0, (start + (goal - start) * k / steps, 0.0)) for k in range(1, steps + 1)])

    def go_to(self, x):
        self.port.send([Waypoint((x, 0.0, 0.0))])

    def go_on(self, steps=1):
        for _ in range(steps):
            self.drive.drive()
            self.traffic.look(self.drive.now)

    @property
    def sent_to(self):
        return self.drive.sent[-1][-1].position[0]


def test_the_first_plan_is_there_at_once_and_others_after_a_fixed_time():
    traffic = Traffic(DelayedPlanning())
    traffic.go_to(20.0)
    traffic.go_on()
    assert traffic.sent_to == pytest.approx(2.0)
    traffic.go_on(5)
    assert traffic.drive.x == pytest.approx(1.0)
    traffic.go_to(-20.0)
    traffic.go_on()
    asked_s, last = traffic.drive.now, traffic.asked[-1]
    assert len(traffic.asked) == 2
    while traffic.drive.now < asked_s + PLANNING_S - STEP_S - 1e-9:
        traffic.go_on()
        assert traffic.sent_to == pytest.approx(last)  # it ends what it has begun
    traffic.go_on()
    assert traffic.traffic.plans == 2
    traffic.go_on(20)
    assert traffic.drive.x < last


def test_a_robot_does_not_work_at_its_goal_before_there_is_a_way_to_it():
    """It stands at its last goal, and everything that was planned for it is done."""
    traffic = Traffic(DelayedPlanning())
    traffic.go_to(0.0)
    traffic.go_on(3)
    traffic.go_to(5.0)
    traffic.go_on()
    assert len(traffic.asked) == 2
    assert all(waypoint.position[0] != 5.0 for way in traffic.drive.sent for waypoint in way)
    traffic.go_on(40)
    assert traffic.drive.x == pytest.approx(5.0)


def test_robots_go_on_by_the_plan_before_while_a_thread_plans():
    gate = threading.Event()
    gate.set()
    planning = ThreadedPlanning(takes_s=2.0)
    traffic = Traffic(planning, before=lambda: gate.wait(60))
    planning.clock = lambda: traffic.drive.now
    traffic.go_to(20.0)

    def wait_for_plan(plans):
        for _ in range(1000):
            traffic.go_on()
            if traffic.traffic.plans == plans:
                return
            traffic.traffic.planning._plan.result(60)
        raise AssertionError(traffic.traffic.plans)

    wait_for_plan(1)
    traffic.go_on(5)
    gate.clear()
    before, x = traffic.traffic.plans, traffic.drive.x
    traffic.traffic._planned_s = -math.inf  # another plan is due
    traffic.go_on(5)
    assert traffic.traffic.plans == before
    assert traffic.drive.x == pytest.approx(x + 1.0)
    traffic.go_on(40)
    stood = traffic.drive.x  # as far as the plan that is being made lets it
    assert x + 2.0 <= stood < 20.0
    gate.set()
    wait_for_plan(before + 1)
    assert traffic.asked[-1] == pytest.approx(stood)
    traffic.go_on(200)
    assert traffic.drive.x == pytest.approx(20.0)


def test_what_goes_wrong_in_the_thread_is_raised_where_robots_are_steered():
    gate = threading.Event()

    def fail():
        gate.wait(60)
        raise RuntimeError("no memory")

    traffic = Traffic(ThreadedPlanning(), before=fail)
    traffic.go_to(20.0)
    traffic.go_on()
    gate.set()
    with pytest.raises(RuntimeError, match="no memory"):
        traffic.traffic.planning._plan.result(60)
    with pytest.raises(RuntimeError, match="no memory"):
        traffic.go_on()


def test_a_mission_whose_time_goes_faster_than_the_clock_waits_for_the_plan():
    planning = ThreadedPlanning(takes_s=1.0, clock=lambda: 0.0)
    gate = threading.Event()
    traffic = Traffic(planning, before=lambda: gate.wait(60))
    traffic.go_to(20.0)
    traffic.go_on(3)
    assert (traffic.traffic.plans, planning.result(traffic.drive.now)) == (0, None)
    gate.set()
    traffic.go_on(3)
    assert traffic.traffic.plans == 1
