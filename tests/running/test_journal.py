"""Journals of runs with real robots: what they hold, what is refused, and runs that go on by them."""

import os
import threading
from collections import Counter
from dataclasses import replace

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.execution.final_state import final_states_of
from muster.mission.errors import InputError
from muster.report.record import read_record
from muster.running.bring_home import bring_home
from muster.running.journal import Journal, interrupted_run, left_behind
from muster.running.journal_file import Header, journal_place, read_journal


@pytest.fixture
def there():
    return mission()


@pytest.fixture
def plan(there):
    return muster.solve(there, "greedy")


@pytest.fixture
def path(tmp_path):
    return tmp_path / "a.journal"


def begun(path, there, plan, **more):
    return Journal.begun(path, there, Header.of(there, plan, "world", ["it"]), (), **more)


def resumed(path, there):
    return Journal.resumed(read_journal(path), there)


def interrupted(path, there, plan, fleet, done=2, **how):
    """Carry out until so many tasks are done; the robots are told to stay."""
    halt, ends = threading.Event(), []

    def on_event(event):
        ends.extend([event] * (event.kind == "ends"))
        if len(ends) >= done:
            halt.set()

    journal = begun(path, there, plan)
    report = muster.carry_out(there, plan, fleet, halt=halt, on_event=on_event, journal=journal, **how)
    journal.close()
    return report


def kinds(path):
    return Counter(entry["kind"] for entry in read_journal(path).entries)


def test_a_run_that_goes_on_does_what_is_left_from_where_robots_are(path, there, plan):
    fleet = WorldAsFleet(there)
    first = interrupted(path, there, plan, fleet)
    assert read_journal(path).progress == "2 tasks done"
    second = muster.carry_out(there, plan, fleet, journal=resumed(path, there))
    assert len(first.tasks_done) == 2
    assert set(second.tasks_done) == {"t_0", "t_1", "t_2", "t_3"}
    assert kinds(path)["ends"] == 4
    assert kinds(path)["resumed"] == 1


def test_an_order_is_on_disk_before_a_robot_has_it(path, there, plan):
    fleet, seen = WorldAsFleet(there), []
    for port in fleet.ports.values():
        send = port.send

        def sent(waypoints, port=port, send=send):
            last = read_journal(path).entries[-1]
            seen.append(last["kind"] == "order" and last["data"]["robot"] == port.robot)
            return send(waypoints)

        port.send = sent
    muster.carry_out(there, plan, fleet, journal=begun(path, there, plan))
    assert len(seen) >= 4
    assert all(seen)


def test_what_each_robot_was_to_do_is_known_after_a_kill(path, there, plan):
    """Before it is sent somewhere, and before it is told to stay or to do what robots do at the end."""
    fleet, told = WorldAsFleet(there), []
    stop = fleet.stop
    fleet.stop = lambda: (told.append(read_journal(path).wanted), stop())
    journal = begun(path, there, plan)
    halt = threading.Event()

    def on_event(event):
        if event.kind == "sets_out" and len(told) == 0:
            told.append(read_journal(path).wanted)

    muster.carry_out(there, plan, fleet, halt=halt, on_event=on_event, journal=journal)
    journal.on_last_order("return")
    journal.close()
    assert all(words.startswith("go to (") and " for t_" in words for words in told[0].values())
    assert told[-1] == {"r_0": "stay", "r_1": "stay"}
    found = read_journal(path)
    assert found.wanted == {"r_0": "return", "r_1": "return"}
    assert found.at_end == "return"
    assert found.state(there).ended_s is not None  # what is wanted is no event of the mission


@pytest.mark.parametrize("cut", [1, 9, 40])
def test_a_last_line_that_is_cut_short_is_left_out_and_written_over(cut, path, there, plan):
    fleet = WorldAsFleet(there)
    interrupted(path, there, plan, fleet)
    whole = read_journal(path)
    path.write_bytes(path.read_bytes()[:-cut])
    torn = read_journal(path)
    assert torn.entries == whole.entries[:-1]
    journal = Journal.resumed(torn, there)
    journal.on_order(9.0, "r_0", ())
    journal.close()
    assert read_journal(path).entries[:-1] == torn.entries


def test_zeros_that_a_power_cut_leaves_at_the_end_are_left_out(path, there, plan):
    interrupted(path, there, plan, WorldAsFleet(there))
    whole = read_journal(path)
    path.write_bytes(path.read_bytes() + bytes(100) + b"\n" + bytes(20))
    assert read_journal(path) == whole


def test_a_hole_that_a_power_cut_leaves_is_where_reading_ends(path, there, plan):
    interrupted(path, there, plan, WorldAsFleet(there))
    lines = path.read_bytes().split(b"\n")
    lines[-3] = lines[-3][:20] + bytes(len(lines[-3]) - 20)
    whole = read_journal(path).entries
    path.write_bytes(b"\n".join(lines))
    assert read_journal(path).entries == whole[:-2]


def test_a_damaged_line_before_the_last_is_refused(path, there, plan):
    interrupted(path, there, plan, WorldAsFleet(there))
    lines = path.read_bytes().split(b"\n")
    lines[3] = lines[3].replace(b"r_", b"q_")
    path.write_bytes(b"\n".join(lines))
    with pytest.raises(InputError, match=r"a\.journal:4: a damaged line; expected a journal as Muster writes it"):
        read_journal(path)


@pytest.mark.parametrize("text", [b"", b"robots: []\n", b"\x89MCAP0\r\n"])
def test_another_file_is_refused(text, path):
    path.write_bytes(text)
    with pytest.raises(InputError, match=r"a\.journal.*expected a journal as Muster writes it"):
        read_journal(path)


def test_the_journal_of_another_mission_or_fleet_is_refused(path, there, plan):
    begun(path, there, plan).close()
    found = read_journal(path)
    found.require_of(there, "world", ["it"])
    other = replace(there, tasks=there.tasks[1:])
    with pytest.raises(
        InputError, match=r'a\.journal: tasks: those of mission "mission", begun .*; expected the tasks of'
    ):
        found.require_of(other, "world", ["it"])
    with pytest.raises(InputError, match=r"a\.journal: fleet: world \(it\); expected world \(UDP port 1\)"):
        found.require_of(there, "world", ["UDP port 1"])


def test_what_has_ended_is_not_resumed(path, there, plan):
    fleet, journal = WorldAsFleet(there), begun(path, there, plan)
    muster.carry_out(there, plan, fleet, journal=journal)
    assert interrupted_run(path) is not None  # robots may not have got their last orders yet
    journal.end(final_states_of(fleet, there))
    journal.close()
    assert interrupted_run(path) is None
    with pytest.raises(
        InputError, match=r"run: that of mission .*, has ended; expected one that did not end \(--recover"
    ):
        read_journal(path).require_under_way()


def test_who_is_left_away_from_its_start_is_told(path, there, plan):
    fleet = WorldAsFleet(there)
    interrupted(path, there, plan, fleet)
    states = final_states_of(fleet, there)
    told = left_behind(interrupted_run(path), there, states)
    assert all(" m from its start" in line for line in told)
    assert {line.split(":")[0] for line in told} <= {"r_0", "r_1"}
    assert told != []
    assert left_behind(interrupted_run(path), replace(there, name="other"), states) == []


def test_robots_come_home_and_the_run_goes_on_from_there(path, there, plan):
    fleet = WorldAsFleet(there)
    interrupted(path, there, plan, fleet)
    assert bring_home(there, fleet, threading.Event(), journal=resumed(path, there)) == {}
    for robot in there.robots:
        assert fleet.ports[robot.id].telemetry().position[:2] == pytest.approx(robot.position, abs=0.5)
    report = muster.carry_out(there, plan, fleet, journal=resumed(path, there))
    assert len(report.tasks_done) == 4
    assert kinds(path)["ends"] == 4


def test_python_brings_robots_home_by_the_request(there, plan):
    fleet, halt = WorldAsFleet(there), threading.Event()
    muster.carry_out(there, plan, fleet, halt=halt, on_event=lambda event: event.kind == "ends" and halt.set())
    report = muster.carry_out(there, plan, fleet, recover=True)
    assert report.tasks_done == ()
    assert {why for _, why in report.tasks_lost} == {"not to be done: robots were brought home"}
    for robot in there.robots:
        assert fleet.ports[robot.id].telemetry().position[:2] == pytest.approx(robot.position, abs=0.5)


def test_who_has_no_way_home_is_named(there):
    fleet = WorldAsFleet(there)
    fleet.ports["r_1"].send = lambda waypoints: 99  # never accepts an order
    fleet.world.advance(0.1)
    moved = replace(there, robots=tuple(replace(r, position=(4.0, r.position[1])) for r in there.robots))
    lost = bring_home(moved, fleet, threading.Event())
    assert list(lost) == ["r_1"]


def test_no_robot_stops_for_a_disk_that_is_full(path, there, plan, monkeypatch):
    said, journal = [], begun(path, there, plan, say=(lines := []).append)

    def full(descriptor):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    report = muster.carry_out(there, plan, WorldAsFleet(there), journal=journal)
    assert len(report.tasks_done) == 4
    assert said == []
    assert lines == [
        f"warning: {path}: No space left on device; the journal is removed: the run goes on, and cannot be resumed"
    ]
    assert not path.exists()


def test_the_record_of_a_run_that_goes_on_has_what_happened_before(path, there, plan, tmp_path):
    fleet = WorldAsFleet(there)
    interrupted(path, there, plan, fleet)
    muster.carry_out(there, plan, fleet, journal=resumed(path, there), record=tmp_path / "r.mcap")
    happened = Counter(event.kind for event in read_record(tmp_path / "r.mcap").events)
    assert happened["ends"] == 4
    assert happened["resumed"] == 1


def test_a_task_that_may_be_begun_once_is_not_begun_again(path, there):
    there = replace(
        there, tasks=tuple(replace(t, across_partition="at-most-once", actuation_cost=5.0) for t in there.tasks)
    )
    plan, fleet, halt = muster.solve(there, "greedy"), WorldAsFleet(there), threading.Event()
    journal = begun(path, there, plan)
    on_event = lambda event: event.kind == "starts" and halt.set()  # noqa: E731
    muster.carry_out(there, plan, fleet, halt=halt, on_event=on_event, journal=journal)
    journal.close()
    (once,) = {entry["data"]["task"] for entry in read_journal(path).entries if entry["kind"] == "starts"}
    report = muster.carry_out(there, plan, fleet, journal=resumed(path, there))
    assert once in dict(report.tasks_lost)
    assert len(report.tasks_done) == 3


def test_the_place_of_a_journal_is_that_of_its_claims(monkeypatch, tmp_path):
    monkeypatch.setenv("XDG_DATA_HOME", str(tmp_path))
    one = journal_place("mavlink", ["UDP port 1", "UDP port 2"])
    assert one == journal_place("mavlink", ["UDP port 2", "UDP port 1"])
    assert one.parent == tmp_path / "muster" / "journals"
    assert one != journal_place("mavlink", ["UDP port 1"])
