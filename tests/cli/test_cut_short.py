"""Plans that planning did not finish: every verb says so, and none that does something with one ends with 0."""

import json
from pathlib import Path

import pytest

import muster
from muster.allocation import stop as stopping
from muster.cli.main import run
from muster.mission.errors import CutShortError

CASES = Path(__file__).parents[1] / "data" / "cases" / "public"
LINE = "planning was cut short"


@pytest.fixture
def no_time(monkeypatch):
    """Options with which no first plan is finished."""
    monkeypatch.setattr(stopping, "PATIENCE", 0.0)
    monkeypatch.setattr(stopping, "_OVERTIME_S", 0.0)
    return ["-a", "greedy", "--time-limit", "0"]


@pytest.fixture
def cut(tmp_path):
    file = tmp_path / "cut.json"
    route = {"robot": "r_0", "tasks": ["1"]}
    file.write_text(json.dumps({"schema": "muster-plan/1", "mission": "6T-2R", "routes": [route], "cut_short": True}))
    return str(file)


def test_solve_writes_it_says_it_and_ends_with_3(no_time, tmp_path, capsys):
    file = tmp_path / "plan.json"
    assert run(["solve", "6T-2R", *no_time, "-o", str(file)]) == 3
    captured = capsys.readouterr()
    assert LINE in captured.out
    assert LINE in captured.err
    assert json.loads(file.read_text())["cut_short"] is True
    assert run(["solve", "6T-2R", *no_time, "--accept-partial"]) == 0
    assert run(["solve", "6T-2R", *no_time, "--accept-partial", "--require-complete"]) == 3


def test_simulate_does_not_begin_with_a_part(no_time, cut, capsys):
    for options in (no_time, ["--plan", cut]):
        assert run(["simulate", "6T-2R", *options]) == 3
        captured = capsys.readouterr()
        assert LINE in captured.err
        assert "nothing was started" in captured.err
        assert "carried out" not in captured.out
        assert run(["simulate", "6T-2R", *options, "--accept-partial"]) == 0
        assert "carried out" in capsys.readouterr().out
        assert run(["simulate", "6T-2R", *options, "--accept-partial", "--require-complete"]) == 3
        capsys.readouterr()


@pytest.mark.parametrize(
    ("verb", "code"),
    [
        (["verify", "6T-2R", "PLAN"], 0),
        (["explain", "6T-2R", "PLAN"], 0),
        (["export", "6T-2R", "PLAN", "--to", "csv"], 3),
        (["export", "6T-2R", "PLAN", "--to", "csv", "--accept-partial"], 0),
    ],
)
def test_every_verb_that_reads_one_says_it(verb, code, cut, capsys):
    assert run([cut if word == "PLAN" else word for word in verb]) == code
    assert capsys.readouterr().err.count(LINE) == 1


def test_python_says_and_refuses_it_too(cut, no_time):
    mission = muster.load("6T-2R")
    plan = muster.solve(mission, "greedy", time_limit=0.0)
    assert plan.cut_short
    assert "cut short" in repr(plan)
    with pytest.raises(CutShortError, match=f"{LINE}: 0 of 6 tasks are planned"):
        muster.simulate(mission, plan)
    assert muster.simulate(mission, plan, accept_partial=True).tasks_lost
    assert any(LINE in message for message in muster.export(mission, plan, "csv").messages)


def test_what_is_complete_was_not_cut(monkeypatch, no_time):
    plan = muster.solve(muster.load("6T-2R"), "search", time_limit=0.0)
    assert plan.complete
    assert not plan.cut_short


def test_a_first_plan_is_finished_on_a_busy_machine(capsys):
    """Its map is analysed within the limit, which leaves no time for the first of three tasks."""
    assert run(["simulate", str(CASES / "cut-short.yaml"), "-a", "greedy", "--time-limit", "0.05"]) == 0
    assert "tasks done        3 of 3" in capsys.readouterr().out
