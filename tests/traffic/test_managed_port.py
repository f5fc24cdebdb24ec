"""A robot in traffic that drops its order while it may drive counts as broken, and is told anew."""

from __future__ import annotations

import pytest

from muster import Robot
from muster.motion.port import Telemetry, Waypoint
from muster.traffic.journeys.travellers import Move, PlannedMoves
from muster.traffic.reservation.reserved import NO_PROGRESS_S, RETRY_S, ReservedTraffic

GOAL = (9.0, 0.0, 0.0)


class Drive:
    """A port to a robot that drives at some speed, and notes what is sent to it."""

    robot = "r_0"

    def __init__(self) -> None:
        self.now, self.x, self.speed = 0.0, 0.0, 0.0
        self.sent: list[tuple[Waypoint, ...]] = []

    def send(self, waypoints):
        self.sent.append(tuple(waypoints))
        return len(self.sent)

    def cancel(self):
        return self.send(())

    def telemetry(self):
        return Telemetry(self.now, (self.x, 0.0, 0.0), 0.0, (0.0, 0.0, 0.0), self.x, len(self.sent), 0)


class Traffic:
    """Traffic of one robot that is sent to a goal; its plans, and who was fixed in each."""

    def __init__(self) -> None:
        self.fixed: list[bool] = []
        self.found = PlannedMoves([Move(0, GOAL[:2])])
        self.traffic, self.drive = ReservedTraffic(self), Drive()
        self.traffic.managed(Robot(id="r_0", position=(0.0, 0.0), radius_m=0.3), self.drive).send([Waypoint(GOAL)])

    def __call__(self, travellers):
        self.fixed.append(travellers[0].fixed)
        return PlannedMoves() if travellers[0].fixed else self.found

    def go_on(self, seconds, speed):
        until_s = self.drive.now + seconds
        while self.drive.now < until_s:
            self.drive.now, self.drive.x = self.drive.now + 0.5, self.drive.x + 0.5 * speed
            self.traffic.look(self.drive.now)

    @property
    def times_sent(self):
        return sum(1 for way in self.drive.sent if way and way[-1].position == GOAL)


@pytest.fixture
def traffic():
    made = Traffic()
    made.go_on(1.0, speed=0.0)
    assert made.times_sent == 1
    return made


def test_who_stands_though_it_may_drive_is_told_anew_and_again(traffic):
    traffic.go_on(NO_PROGRESS_S + 0.5, speed=0.0)
    assert (traffic.times_sent, traffic.drive.sent[-1][-1].position) == (1, GOAL)  # what it was told holds
    traffic.go_on(RETRY_S, speed=0.0)
    assert traffic.times_sent == 2
    traffic.go_on(NO_PROGRESS_S + RETRY_S + 1.0, speed=0.0)
    assert traffic.times_sent == 3


def test_who_moves_again_is_planned_again_from_where_it_is(traffic):
    traffic.go_on(NO_PROGRESS_S + 0.5, speed=0.0)
    traffic.go_on(1.0, speed=0.5)
    assert traffic.times_sent == 2


def test_who_drives_is_not_told_anew(traffic):
    traffic.go_on(2 * NO_PROGRESS_S, speed=0.5)
    assert traffic.times_sent == 1
    assert not any(traffic.fixed)


def test_who_drops_the_order_to_work_at_its_goal_is_told_anew(traffic):
    traffic.go_on(GOAL[0] / 0.5, speed=0.5)
    traffic.drive.x = GOAL[0]
    before = len(traffic.drive.sent)
    traffic.go_on(NO_PROGRESS_S + RETRY_S + 2.0, speed=0.0)
    assert [way[-1].position for way in traffic.drive.sent[before:] if way] == [
        GOAL,
        GOAL,
    ]  # to be at work there, and anew


def test_moves_of_an_incomplete_plan_give_way_to_a_complete_one_alone(traffic):
    """Those of another incomplete plan may lead back."""
    way_back = [Move(0, (-1.0, 0.0))]
    traffic.found = PlannedMoves([Move(0, (GOAL[0] - 0.5, 0.0))], complete=False)
    traffic.traffic.moved("r_0")  # a new plan is due
    traffic.go_on(1.0, speed=0.5)
    plans, planned_s, sought = traffic.traffic.plans, traffic.traffic._planned_s, len(traffic.fixed)
    assert plans == 2
    traffic.found = PlannedMoves(way_back, complete=False)
    traffic.go_on(4.0, speed=0.5)
    assert len(traffic.fixed) >= sought + 2  # and not taken
    assert (traffic.traffic.plans, traffic.traffic._planned_s) == (plans, planned_s)
    traffic.found = PlannedMoves([Move(0, (GOAL[0] - 1.0, 1.0)), Move(0, GOAL[:2])])
    traffic.go_on(2.0, speed=0.5)
    assert (traffic.traffic.plans, traffic.traffic._order.end(0)) == (plans + 1, GOAL[:2])
