"""The local journal of a runner of real robots: what the server has not taken is told again, and obeyed once."""

import json
import threading

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.motion.port import Waypoint
from muster.running.journal_file import JournalFile
from muster.running.run_request import OPEN_FLEET, RunRequest
from muster.state.recovery import recovered_from
from muster_control.runs.runner.local_journal import LocalJournal
from muster_control.runs.runner.log_recorder import LogRecorder
from muster_control.runs.runner.real_run import RealRun, RecoveryRun


class Stoppable(WorldAsFleet):
    def stop(self):
        for port in self.ports.values():
            port.cancel()


THERE = mission()
PLAN = muster.solve(THERE, "greedy")


class Sent:
    """An outbox that keeps what is sent."""

    full = False

    def __init__(self):
        self.entries, self.others = [], []

    def entry(self, message):
        self.entries.append(message)

    def stretch(self, *_): ...

    def send(self, message):
        self.others.append(message)


@pytest.fixture
def begin(tmp_path):
    """The first message to a runner, of a server that has taken some entries."""

    def made(log=(), **more):
        usual = {"run": 3, "at": "2027", "world": "mavlink", "journal": str(tmp_path / "a.journal")}
        return {**usual, "log": list(log), "seq": len(log), "paused": False, "cancelled": False, **more}

    return made


def local(begin, sent=None):
    return LocalJournal(sent or Sent(), begin, THERE, PLAN)


def entry(seq, kind="robots_free", data=None):
    return {"type": "entry", "seq": seq, "time_s": float(seq), "kind": kind, "data": {} if data is None else data}


def command(seq, verb, action):
    return entry(seq, "command", {"action": action, "verb": verb, "data": {}, "who": "ada", "outcome": "done"})


TICK = {"type": "tick", "bodies": None}


def write(begin, *messages):
    journal, sent = local(begin), Sent()
    for message in messages:
        journal.send(message) if message["type"] == "tick" else journal.entry(message)
    journal.close()
    return sent


def test_what_the_server_lacks_is_told_again(begin):
    write(begin(), entry(1), TICK, entry(2), entry(3), TICK)
    sent = Sent()
    again = local(begin(log=[entry(1)]), sent)
    again.send_again()
    assert [message["seq"] for message in sent.entries] == [2, 3]
    assert sent.others == [TICK]
    assert again.begin["seq"] == 3
    again.entry(entry(4))
    again.close()
    assert [one["seq"] for one in local(begin()).begin["log"]] == [1, 2, 3, 4]


def test_users_actions_are_obeyed_once_and_count(begin):
    write(begin(), entry(1), TICK, command(2, "pause", 7), TICK, command(3, "cancel", 8), TICK)
    again = local(begin(log=[entry(1)]))
    assert again.obeyed == {7, 8}
    assert (again.begin["paused"], again.begin["cancelled"]) == (True, True)


def test_an_action_whose_consequences_are_not_there_was_none(begin):
    write(begin(), entry(1), TICK, entry(2), command(3, "event", 7), entry(4))
    again = local(begin(log=[entry(1)]))
    assert again.begin["seq"] == 2
    assert again.obeyed == set()


@pytest.mark.parametrize("other", [{"run": 4}, {"at": "2028"}])
def test_the_file_of_another_run_is_made_anew(begin, other):
    write(begin(), entry(1), TICK)
    assert local(begin(**other)).begin["seq"] == 0


def test_all_is_on_disk_before_an_order(begin, tmp_path):
    journal = local(begin())
    journal.entry(entry(1))
    journal.before_order(1.0, "r_0", [Waypoint((1.0, 2.0, 0.0), label="t")])
    last = (tmp_path / "a.journal").read_bytes().splitlines()[-1]
    assert json.loads(last[9:])["data"] == {"robot": "r_0", "to": [1.0, 2.0, 0.0], "for": ["t"]}
    journal.close()


def test_no_robot_stops_for_a_disk_that_is_full(begin, monkeypatch, tmp_path):
    journal, sent = local(begin()), Sent()
    journal._out = sent

    def full(*_):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(JournalFile, "append", full)
    journal.entry(entry(1))
    journal.before_order(1.0, "r_0", ())
    assert sent.entries == [entry(1)]
    assert not (tmp_path / "a.journal").exists()


def run_until(run, enough):
    while not enough() and not run.done:
        run.go_on()


def begun(begin, fleet, *, made=RealRun, **more):
    """A run of the runner, with its journal."""
    sent = Sent()
    journal = local(begin, sent)
    journal.send_again()
    state = recovered_from(THERE, PLAN, journal.begin["log"])
    recorder = LogRecorder(THERE, journal, state, seq=journal.begin["seq"])
    request = RunRequest(world=OPEN_FLEET)
    known = state if journal.begin["seq"] else None
    how = {"request": request, "state": known, "before_order": journal.before_order, **more}
    run = made(THERE, PLAN, fleet, recorder, **how)
    return run, journal, sent


def test_a_run_whose_server_has_lost_all_of_it_does_nothing_twice(begin):
    fleet = WorldAsFleet(THERE)
    run, journal, sent = begun(begin(), fleet)
    run_until(run, lambda: sum(one["kind"] == "ends" for one in sent.entries) >= 2)
    journal.close()
    again, journal, told = begun(begin(), fleet)
    run_until(again, lambda: False)
    ends = [one["data"]["task"] for one in told.entries if one["kind"] == "ends"]
    assert sorted(ends) == ["t_0", "t_1", "t_2", "t_3"]
    assert [one["seq"] for one in told.entries] == list(range(1, len(told.entries) + 1))
    journal.close()


@pytest.mark.parametrize("cancelled", [False, True])
def test_robots_are_brought_home_by_a_run_of_its_own(begin, cancelled):
    fleet = Stoppable(THERE)
    run, journal, _ = begun(begin(), fleet)
    run_until(run, lambda: all(port.telemetry().position[0] > 3.0 for port in fleet.ports.values()))
    run.stop()
    journal.close()
    home, journal, sent = begun(begin(run=9), fleet, made=RecoveryRun)
    with pytest.raises(muster.MusterError, match="robots are brought home; expected cancel"):
        home.pause()
    if cancelled:
        home.break_off("not done when the run was cancelled")
    run_until(home, lambda: False)
    home.close()
    journal.close()
    report, states = sent.entries[-1], sent.entries[-2]
    assert (states["kind"], report["kind"]) == ("final_states", "report")
    assert {one["robot"]: one["moving"] for one in states["data"]["robots"]} == {"r_0": False, "r_1": False}
    assert report["data"]["tasks_done"] == []
    there = [fleet.ports[robot.id].telemetry().position[0] < 0.5 for robot in THERE.robots]
    assert there == [not cancelled, not cancelled]


@pytest.mark.parametrize("cancelled", [False, True])
def test_a_run_goes_on_until_robots_have_done_what_they_do_at_the_end_and_that_can_be_cancelled(begin, cancelled):
    """Drones fly home for minutes: the run hears its users meanwhile."""
    halt, down = threading.Event(), threading.Event()

    def land():
        while not (down.is_set() or halt.is_set()):
            down.wait(0.01)

    run, journal, sent = begun(begin(), WorldAsFleet(THERE), at_end=land, halt=halt)
    run_until(run, lambda: run.executor.done)
    run.go_on()
    assert not run.done
    with pytest.raises(muster.MusterError, match="do what they do at the end; expected cancel"):
        run.pause()
    if cancelled:
        run.break_off("not done when the run was cancelled")
    down.set()
    run_until(run, lambda: False)
    run.close()
    journal.close()
    assert run.done
    report, states = sent.entries[-1], sent.entries[-2]
    assert (states["kind"], report["kind"]) == ("final_states", "report")
    assert sorted(report["data"]["tasks_done"]) == ["t_0", "t_1", "t_2", "t_3"]


def test_an_error_of_the_end_ends_the_run(begin):
    run, journal, _ = begun(begin(), WorldAsFleet(THERE), at_end=lambda: {}["no such drone"])
    with pytest.raises(KeyError, match="no such drone"):
        run_until(run, lambda: False)
    run.close()
    journal.close()
