"""A plan carried out by a fleet behind a bridge: here a simulated world stands behind it, in virtual time."""

import threading
from dataclasses import replace

import numpy as np
import pytest

import muster
from muster.execution.fleet import Failure
from muster.execution.record import NoObserver
from muster.generation import narrow
from muster.mission.model import Event, Mission, Robot, Task
from muster.report.record import read_record
from muster.running.live import with_reported_starts
from muster.simulation import KinematicWorld


class WorldAsFleet:
    """A bridge to a world."""

    def __init__(self, mission, events=()):
        self.world, self.stopped, self._events = KinematicWorld(mission), 0, list(events)

    @property
    def ports(self):
        return self.world.ports

    @property
    def time_s(self):
        return self.world.time_s

    def advance(self, until_s):
        self.world.advance(max(until_s, self.time_s + self.world.dt_s))
        due = [event for event in self._events if event.at_s <= self.time_s]
        self._events = [event for event in self._events if event.at_s > self.time_s]
        for event in due:
            if event.robot_joins is not None:
                self.world.join(event.robot_joins)
            elif event.robot_fails is not None:
                self.world.fail(event.robot_fails)
        return due

    def stop(self):
        self.stopped += 1

    def close(self):
        pass


def mission(count=2):
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 3.0 * k), radius_m=0.2) for k in range(count))
    return Mission(robots=robots, tasks=tuple(Task(id=f"t_{k}", position=(8.0, 2.0 * k)) for k in range(4)))


def flown(there, fleet, **how):
    return muster.carry_out(there, muster.solve(there, iterations=50), fleet, **how)


def test_a_fleet_carries_a_plan_out():
    there = mission()
    fleet, heard = WorldAsFleet(there), []
    report = flown(there, fleet, on_event=heard.append)
    assert set(report.tasks_done) == {"t_0", "t_1", "t_2", "t_3"}
    assert heard[-1].kind == "mission_ended"
    assert fleet.stopped == 1


def test_ignored_rules_do_not_hold_on_the_way():
    small = tuple(Robot(id=f"r_{k}", position=(0.0, 3.0 * k), work_capacity=3.0) for k in range(2))
    there = replace(mission(), robots=small)
    plan = muster.solve(there, iterations=50, ignore="capacity")
    assert muster.carry_out(there, plan, WorldAsFleet(there)).tasks_done == ()
    assert len(muster.carry_out(there, plan, WorldAsFleet(there), ignore="capacity").tasks_done) == 4


def test_who_fails_is_planned_for_and_who_is_discovered_helps():
    there = mission()
    joins = Robot(id="new", position=(9.0, 9.0), radius_m=0.2)
    fleet = WorldAsFleet(there, [Event(at_s=2, robot_fails="r_0"), Event(at_s=3, robot_joins=joins)])
    report = flown(there, fleet)
    assert len(report.tasks_done) == 4
    assert {row.robot for row in report.tasks} <= {"r_1", "new"}
    assert report.reallocations >= 2


def test_why_a_robot_fails_is_told():
    there, heard = mission(), []
    fleet = WorldAsFleet(there, [Failure(at_s=2, robot_fails="r_0", reason="low battery")])
    flown(there, fleet, on_event=heard.append)
    (out,) = [event.data for event in heard if event.kind == "robot_fails"]
    assert out == {"robot": "r_0", "reason": "low battery"}


def test_halted_it_stops_the_robots():
    there, halt = mission(), threading.Event()
    fleet = WorldAsFleet(there)
    report = flown(there, fleet, halt=halt, on_event=lambda event: halt.set())
    assert fleet.stopped == 1
    assert len(report.tasks_done) < 4
    left = [f"t_{k}" for k in range(4) if f"t_{k}" not in report.tasks_done]
    assert report.remarks == (f"interrupted; not done: {', '.join(left)}",)


def test_an_error_stops_the_robots():
    there = mission()
    fleet = WorldAsFleet(there)

    def broken(event):
        raise RuntimeError("broken")

    with pytest.raises(RuntimeError):
        flown(there, fleet, on_event=broken)
    assert fleet.stopped == 1


def test_a_record_has_where_robots_said_that_they_were(tmp_path):
    there = mission()
    joins = Robot(id="new", position=(9.0, 9.0), radius_m=0.2)
    fleet = WorldAsFleet(there, [Event(at_s=3, robot_joins=joins)])
    report = flown(there, fleet, record=tmp_path / "record.mcap")
    recording = read_record(tmp_path / "record.mcap")
    assert recording.complete
    assert recording.report["tasks_done"] == list(report.tasks_done)
    assert [robot.id for robot in recording.robots] == ["r_0", "r_1", "new"]
    last = [fleet.ports[name].telemetry().position for name in recording.tracks.robots]
    assert recording.tracks.positions[-1] == pytest.approx(np.array(last), abs=0.05)
    assert np.isnan(recording.tracks.positions[0, 2]).all()  # not there yet


def test_how_near_robots_came_is_not_claimed():
    report = flown(mission(), WorldAsFleet(mission()))
    assert (report.contacts, report.min_distance_m) == (None, None)


class Full(NoObserver):
    """Keeps what it is told until the disk is full."""

    def __init__(self, room):
        self.room = room

    def on_step(self, now, *states):
        self.room -= 1
        if self.room < 0:
            raise OSError(28, "No space left on device", "record.mcap")

    def on_report(self, report):
        raise AssertionError("nothing more is told")


def test_no_robot_stops_for_a_full_disk():
    there = mission()
    full, whole = Full(room=5), []
    fleet = WorldAsFleet(there)
    report = flown(there, fleet, observers=[full], on_event=whole.append)
    assert len(report.tasks_done) == 4
    assert full.room == -1
    assert report.remarks == ("no more is kept: [Errno 28] No space left on device: 'record.mcap'",)


def test_robots_start_where_they_stand():
    there = mission()
    fleet = WorldAsFleet(replace(there, robots=tuple(replace(r, position=(1.0, r.position[1])) for r in there.robots)))
    fleet.advance(0.1)
    assert [robot.position for robot in with_reported_starts(there, fleet).robots] == [(1.0, 0.0), (1.0, 3.0)]


def test_who_is_halted_before_it_begins_sends_nobody():
    there, halt = mission(), threading.Event()
    halt.set()
    fleet = WorldAsFleet(there)
    report = flown(there, fleet, halt=halt)
    assert [port.telemetry().order for port in fleet.ports.values()] == [0, 0]
    assert (report.tasks_done, fleet.stopped) == ((), 1)


def test_no_robot_stops_for_a_viewer_that_breaks():
    class Broken(NoObserver):
        def on_step(self, now, *states):
            raise RuntimeError("channel closed")

        def on_report(self, report):
            raise AssertionError("nothing more is told")

    report = flown(mission(), WorldAsFleet(mission()), observers=[Broken()])
    assert len(report.tasks_done) == 4
    assert report.remarks == ("no more is kept: channel closed",)


def test_the_clock_of_a_mission_begins_with_it(tmp_path):
    there = mission()
    fleet, heard = WorldAsFleet(there, [Event(at_s=8, robot_fails="r_0")]), []
    fleet.world.advance(5.0)  # robots were waited for
    report = flown(there, fleet, on_event=heard.append, record=tmp_path / "record.mcap")
    (failed,) = [event.time_s for event in heard if event.kind == "robot_fails"]
    assert failed == pytest.approx(3.0, abs=0.2)
    begun_s = heard[0].time_s  # a moment after 0, on a slow machine
    assert heard[-1].time_s - begun_s == pytest.approx(report.mission_time_s)
    recording = read_record(tmp_path / "record.mcap")
    assert recording.tracks.times_s[0] == pytest.approx(0.0, abs=0.2)
    assert recording.duration_s - begun_s == pytest.approx(report.mission_time_s)


@pytest.mark.long
def test_a_fleet_passes_a_door_in_the_order_of_one_plan():
    """The robots' own avoidance is the local layer: nobody touches, and all get through."""
    there = narrow.one_way_door("differential-drive", 0, 8)
    fleet = WorldAsFleet(there)
    report = flown(there, fleet)
    assert len(report.tasks_done) == len(there.tasks)
    assert fleet.world.contacts == ()
    assert report.waiting_by_cause_s["traffic"] > 0


def test_a_robot_that_joins_a_fleet_is_in_its_traffic():
    there = mission()
    late = Robot(id="r_late", position=(0.0, 8.0), radius_m=0.2)
    fleet = WorldAsFleet(there, [Event(at_s=1.0, robot_joins=late)])
    report = flown(there, fleet, traffic="reserve")
    assert len(report.tasks_done) == 4
    assert fleet.world.contacts == ()
