"""The clock of missions that real robots carry out is the wall clock: here a virtual one, beside a simulated world."""

from dataclasses import replace
from datetime import UTC, datetime

import pytest
from tests.running.test_live import WorldAsFleet

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission, Robot, Task
from muster.running.live import Live
from muster.running.wall_time import MissionStart, notes_on_start, planned_from, require_time_left

DAY_S = 86400.0
NOON = datetime(2027, 3, 1, 12, tzinfo=UTC)


class Wall:
    """The time of day; it goes on as the worlds of fleets do, and by what is added."""

    def __init__(self, after_noon_s=0.0):
        self.fleets, self.more_s = [], NOON.timestamp() + after_noon_s

    def now(self):
        return self.more_s + sum(fleet.time_s for fleet in self.fleets)

    def fleet(self, mission):
        self.fleets.append(WorldAsFleet(mission))
        return self.fleets[-1]


def mission(*tasks, starts_at="2027-03-01T12:00:00+00:00", **robot):
    robots = tuple(Robot(id=f"r_{k}", position=(0.0, 3.0 * k), radius_m=0.2, **robot) for k in range(2))
    return Mission(name="wall", robots=robots, tasks=tasks, starts_at=starts_at)


EARLY = Task(id="early", position=(6.0, 0.0), window_s=((0.0, 600.0),))
LATER = Task(id="later", position=(6.0, 3.0), window_s=((DAY_S, 2 * DAY_S),))
ANY = Task(id="any", position=(3.0, 3.0))
SOON = Task(id="soon", position=(9.0, 0.0), deadline_s=30.0)


def carried_out(there, wall, **how):
    fleet, heard = wall.fleet(there), []
    report = muster.carry_out(there, muster.solve(there, iterations=50), fleet, wall=wall, on_event=heard.append, **how)
    return report, heard, fleet


@pytest.mark.parametrize(
    ("tasks", "robot", "why"),
    [
        ([EARLY, ANY], {}, "the time for task early is over"),
        ([EARLY, SOON, ANY], {}, "the time for task early and 1 more task is over"),
        ([ANY], {"available_until_s": 3600.0}, "the shifts of all robots have ended"),
    ],
)
def test_a_mission_whose_time_is_over_is_refused_before_robots_are_told_anything(tasks, robot, why):
    there, wall = mission(*tasks, **robot), Wall(DAY_S)
    fleet = wall.fleet(there)
    expected = (
        rf"^mission wall: starts_at 2027-03-01T12:00:00\+00:00 was 24.0 hours ago, and {why}; expected .*--starts now"
    )
    with pytest.raises(ParameterError, match=expected):
        muster.carry_out(there, muster.solve(there, iterations=50), fleet, wall=wall)
    assert all(port.telemetry().order == 0 for port in fleet.ports.values())


def test_started_now_all_times_are_shifted():
    report, heard, _ = carried_out(mission(EARLY, ANY), Wall(DAY_S), starts="now")
    assert set(report.tasks_done) == {"early", "any"}
    (begins,) = (event for event in heard if event.kind == "mission_begins")
    assert begins.data["starts_at"] == "2027-03-02T12:00:00+00:00"
    assert heard[0].time_s == 0.0


def test_begun_late_the_tasks_are_done_whose_time_is_not_over():
    report, heard, _ = carried_out(mission(EARLY, LATER, ANY), Wall(DAY_S + 100.0))
    assert set(report.tasks_done) == {"later", "any"}
    ((task, reason),) = report.tasks_lost
    assert (task, reason) == ("early", "window: closed at 600 s")
    assert min(report.starts_s.values()) > DAY_S
    assert report.mission_time_s < 60.0  # of which all were under way
    assert "early" not in {event.data.get("task") for event in heard if event.kind == "sets_out"}


def test_robots_wait_for_a_start_that_is_to_come():
    wall = Wall(-300.0)
    report, heard, fleet = carried_out(mission(EARLY, ANY), wall)
    assert set(report.tasks_done) == {"early", "any"}
    first = next(event for event in heard if event.kind == "sets_out")
    assert 0.0 <= first.time_s < 1.0
    assert 300.0 < fleet.time_s < 330.0
    assert report.mission_time_s < 30.0


def test_before_the_start_events_are_taken_and_no_robot_moves():
    there, wall = mission(EARLY), Wall(-60.0)
    fleet = wall.fleet(there)
    live = Live(there, muster.solve(there, iterations=50), fleet, wall=wall)
    live.executor.report(Event(at_s=0.0, new_task=ANY))
    while fleet.time_s < 59.0:
        live.look()
        live.hear(live.time_s + 0.2)
    assert live.time_s == 0.0
    assert all(port.telemetry().order == 0 for port in fleet.ports.values())
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
        assert live.time_s < 100.0
    assert set(live.result().tasks_done) == {"early", "any"}


def test_without_starts_at_time_is_0_when_the_run_begins():
    report, heard, _ = carried_out(mission(SOON, starts_at=None), Wall(5 * DAY_S))
    assert report.tasks_done == ("soon",)
    assert heard[0].time_s == 0.0


def test_a_deadline_passes_in_a_pause():
    there, wall = mission(SOON, ANY), Wall()
    fleet = wall.fleet(there)
    live = Live(there, muster.solve(there, iterations=50), fleet, wall=wall)
    for _ in range(10):
        live.look()
        live.hear(live.time_s + 0.2)
    live.pause()
    while fleet.time_s < 40.0:
        live.hear(live.time_s + 0.2)
    live.resume()
    used = {name: row.usage_flown for name, row in live.executor.account.robots.items()}
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
        assert live.time_s < 100.0
    report = live.result()
    assert report.tasks_done == ("any",)
    assert dict(report.tasks_lost)["soon"].startswith("deadline: 30 s is over")
    assert all(event.kind != "robot_sent_again" for event in live.events)  # a pause is no lack of progress
    assert max(used.values()) < 3.0


def test_a_deadline_passes_while_somebody_else_lets_robots_stand():
    """As on ROS 1, where the fleet's own clock stands still in a pause."""
    there, wall = mission(SOON, ANY), Wall()
    fleet = wall.fleet(there)
    live = Live(there, muster.solve(there, iterations=50), fleet, wall=wall)
    live.look()
    fleet.paused = True
    for _ in range(40):
        live.look()
        wall.more_s += 1.0
    assert live.time_s == pytest.approx(40.0)
    assert live.executor.now_s < 1.0
    fleet.paused = False
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
        assert 40.0 <= live.time_s < 100.0
    assert live.result().tasks_done == ("any",)


@pytest.mark.parametrize(("jumps_s", "done"), [(3600.0, ("any",)), (-3600.0, ("any", "soon"))])
def test_the_clock_of_a_machine_that_slept_is_set_forward_and_no_clock_goes_back(jumps_s, done):
    there, wall = mission(SOON, ANY), Wall()
    fleet = wall.fleet(there)
    live = Live(there, muster.solve(there, iterations=50), fleet, wall=wall)
    live.look()
    live.hear(live.time_s + 0.2)
    wall.more_s += jumps_s
    before = live.time_s
    assert (before > 3600.0) == (jumps_s > 0)
    while not live.done:
        live.look()
        live.hear(live.time_s + 0.2)
        assert before <= live.time_s < 3700.0
        before = live.time_s
    assert tuple(sorted(live.result().tasks_done)) == done


def test_planning_for_a_late_start_uses_no_robot_before():
    there = mission(EARLY, ANY, available_until_s=500.0)
    assert {robot.available_from_s for robot in planned_from(there, 300.0).robots} == {300.0}
    assert {robot.available_from_s for robot in planned_from(there, 900.0).robots} == {500.0}
    assert planned_from(there, -5.0) is there


def test_what_is_said_of_a_start_that_is_not_now():
    there = mission(EARLY, LATER)
    assert list(notes_on_start(there, 0.0)) == []
    assert list(notes_on_start(there, -7200.0)) == [
        "the mission starts at 2027-03-01T12:00:00+00:00: robots wait for 2.0 hours"
    ]
    (line,) = notes_on_start(there, 700.0)
    assert line == "warning: starts_at 2027-03-01T12:00:00+00:00 was 11.7 minutes ago: the time for task early is over"
    require_time_left(there, 700.0)


def test_a_start_without_a_zone_is_local_time_and_stays_so():
    there = mission(ANY, starts_at="2027-03-01T12:00")
    start = MissionStart.of(there, "given", Wall())
    assert start.zero_s == datetime(2027, 3, 1, 12).timestamp()
    shifted = MissionStart.at(there, start.zero_s + 60.0)
    assert shifted.mission == replace(there, starts_at="2027-03-01T12:01:00")
    with pytest.raises(ParameterError, match="starts: later; expected given or now"):
        MissionStart.of(there, "later")
