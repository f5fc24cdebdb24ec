"""What the verbs that command real robots share: a simulated world stands behind the fleet, in virtual time."""

import signal
import socket
import threading
from types import SimpleNamespace

import pytest
from tests.running.test_live import WorldAsFleet, mission

import muster
from muster.cli.exits import INTERRUPTED, STILL_MOVING, TASKS_LOST
from muster.cli.main import run
from muster.execution.final_state import FinalState, final_states_of
from muster.execution.reports.report import ObjectiveReport, Report
from muster.mission.system.interrupts import TO_END, ctrl_c_halts
from muster.planning.options import PlanningOptions
from muster.running.journal_file import journal_place
from muster.running.live import wait_for_robots
from muster.running.observed_run import ObservedRun
from muster.running.run_request import OPEN_FLEET
from muster_robots.cli import real_robots as real
from muster_robots.cli.going_on import GoingOn
from muster_robots.cli.real_robots import carried_out, reported
from muster_robots.cli.run_options import RealRunOptions

ASKED = {
    **dict.fromkeys(("plan", "record", "html", "plot", "gantt", "foxglove")),
    "request": ObservedRun(world=OPEN_FLEET),
    "planning": PlanningOptions(time_limit=0.1),
    "require_complete": False,
    "form": "table",
    "quiet": True,
    "verbose": False,
}


def carry_out(options, **how):
    there = mission()
    halt = how.pop("halt", threading.Event())
    begins, fleet = GoingOn(there, journal_place("world", ["it"]), "world", ["it"], False, False), WorldAsFleet(there)
    plan = muster.solve(there, iterations=50)
    report = carried_out(there, plan, fleet, begins, options, halt, lambda: final_states_of(fleet, there), **how)
    return there, report, halt


def test_robots_are_told_how_to_end_before_anything_is_drawn(tmp_path):
    page, seen = tmp_path / "page.html", []
    carry_out(RealRunOptions(**{**ASKED, "html": page}), at_end=lambda: seen.append(page.exists()))
    assert seen == [False]
    assert page.exists()


def test_the_report_counts_more_than_what_is_drawn_of_it(tmp_path, monkeypatch, capsys):
    def full(*_):
        raise OSError(28, "No space left on device", "page.html")

    monkeypatch.setattr("muster.cli.record_output.draw_record", full)
    options = RealRunOptions(**{**ASKED, "html": tmp_path / "page.html"})
    there, report, halt = carry_out(options)
    assert reported(there, report, options, halt, "", ()) == 0
    out, err = capsys.readouterr()
    assert "tasks done        4 of 4" in out
    assert err == "warning: [Errno 28] No space left on device: 'page.html'\n"


@pytest.mark.parametrize("number", TO_END)
def test_a_signal_to_end_halts_once_and_is_as_before_afterwards(number):
    before = signal.getsignal(number)
    with ctrl_c_halts(TO_END) as halt:
        signal.raise_signal(number)
        assert halt.is_set()
        with pytest.raises(KeyboardInterrupt):
            signal.raise_signal(number)
    assert signal.getsignal(number) is before


def test_who_was_interrupted_hears_what_robots_do(capsys):
    halt = threading.Event()
    halt.set()
    options = RealRunOptions(**ASKED)
    there, report, _ = carry_out(options, halt=halt)
    assert reported(there, report, options, halt, "robots hover", ()) == 130
    assert capsys.readouterr().err == "interrupted at 0.0 s of the mission; robots hover\n"


def test_robots_that_do_not_say_where_they_are_are_named():
    class Silent:
        def robots_not_ready(self):
            return {"r_0": "nothing on /r_0/odom", "r_1": "nothing on /r_1/odom"}

    with pytest.raises(muster.MusterError, match=r"robot r_0: nothing on /r_0/odom within 0.1 s \(and 1 more\)"):
        wait_for_robots(Silent(), threading.Event(), 0.1)


def test_a_plan_that_breaks_a_rule_moves_no_robot(tmp_path):
    there = mission()
    text = '{"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["t_0", "t_9"]}]}'
    (tmp_path / "plan.json").write_text(text)
    with pytest.raises(muster.PlanError, match=r"plan.json.*t_9.*expected an admissible plan of mission mission"):
        real.read_given_plan(RealRunOptions(**{**ASKED, "plan": tmp_path / "plan.json"}), there)


def test_a_port_that_is_taken_is_told_before_robots_move():
    with socket.create_server(("127.0.0.1", 0)) as taken:
        port = taken.getsockname()[1]
        with pytest.raises(muster.MusterError, match=rf"--foxglove: 127.0.0.1:{port}: Address already in use"):
            real.require_outputs(RealRunOptions(**{**ASKED, "foxglove": port}), ())


@pytest.mark.parametrize("name", ["9 bad/", "a-b", "a//b", "é"])
def test_a_namespace_that_is_none_is_told(name, capsys):
    assert run(["ros2", "6T-2R", "--namespace", name]) == 2
    assert f'namespace: "{name}"; expected names such as' in capsys.readouterr().err


@pytest.mark.parametrize(
    ("moving", "halted", "code"),
    [(False, False, TASKS_LOST), (True, False, STILL_MOVING), (True, True, STILL_MOVING), (False, True, INTERRUPTED)],
)
def test_the_exit_code_and_the_last_lines(capsys, moving, halted, code):
    report = Report(
        mission_time_s=1.0,
        tasks_done=(),
        tasks_lost=(("t", "why"),),
        contacts=None,
        min_distance_m=None,
        waiting_s=0.0,
        reallocations=0,
        robots=(),
        starts_s={},
        ends_s={},
        objective=ObjectiveReport("max", None, 0.0),
        tasks=(),
    )
    wishes = SimpleNamespace(form="json", verbose=False, require_complete=True, quiet=True)
    halt = threading.Event()
    if halted:
        halt.set()
    states = [FinalState("r_0", "stands", (1.0, 2.0, 0.0), moving=False), FinalState("r_1", "drives", None, moving)]
    assert reported(mission(), report, wishes, halt, "they stand", states) == code
    lines = capsys.readouterr().err.splitlines()
    assert lines[-2:] == ["r_0: stands; at (1.00, 2.00, 0.00)", "r_1: drives; position unknown"]
    assert ("still flying, driving or armed: r_1; land or stop them" in "\n".join(lines)) == moving
    assert ("1 task lost: t" in lines) == (not halted)
