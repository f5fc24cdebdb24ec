"""`muster path --lifelong`: figures, the output file of the league, and what is refused."""

import json
import signal

import pytest
from tests.traffic.league import random_league, write_league

ROWS = ["........", "..##.##.", "........", "..##.##.", "........"]


@pytest.fixture
def instance(tmp_path):
    return str(write_league(tmp_path, random_league(ROWS, 8, 0)))


def test_figures(muster, instance):
    code, out, err = muster("path", instance, "--lifelong", "--steps", "80", "--expansions", "2000")
    assert (code, err) == (0, "")
    assert "a.json: 8 robots, 80 steps, seed 0; judged, no conflict" in out
    figures = json.loads(
        muster("path", instance, "--lifelong", "--steps", "80", "--expansions", "2000", "--format", "json")[1]
    )
    assert f"{figures['tasks_finished']}" in out
    assert figures["tasks_finished"] > 10
    assert figures["tasks_revealed"] == figures["tasks_finished"] + 12


def test_the_output_of_the_league(muster, instance, tmp_path):
    file = tmp_path / "out.json"
    assert muster("path", instance, "--lifelong", "--steps", "50", "--seed", "3", "-o", str(file))[0] == 0
    found = json.loads(file.read_text())
    assert (found["actionModel"], found["AllValid"], found["teamSize"], found["errors"]) == ("MAPF_T", "Yes", 8, [])
    assert [len(path.split(",")) for path in found["actualPaths"]] == [50] * 8
    assert found["actualPaths"] == found["plannerPaths"]
    assert len(found["plannerTimes"]) == 50
    sizes = {number: len(cells) // 2 for number, _, cells in found["tasks"]}
    assert found["numTaskFinished"] == sum(sizes[task] == visited for _, _, task, visited in found["events"])
    assert all(entry.count(":") == 1 for text in found["actualSchedule"] for entry in text.split(","))
    assert found["start"][0][2] == "E"


def test_ctrl_c_ends_a_run_with_what_it_has(muster, instance, tmp_path, monkeypatch):
    from muster.traffic.lifelong import league_run

    run = league_run.run_league

    def interrupted(*args, progress, **settings):
        def show(step, finished):
            if step == 9:
                signal.raise_signal(signal.SIGINT)
            return progress(step, finished)

        return run(*args, progress=show, **settings)

    monkeypatch.setattr(league_run, "run_league", interrupted)
    file = tmp_path / "out.json"
    code, out, err = muster("path", instance, "--lifelong", "--steps", "500", "-o", str(file))
    assert (code, err) == (130, "\ninterrupted\n")
    assert "8 robots, 9 steps" in out
    assert len(json.loads(file.read_text())["plannerTimes"]) == 9


@pytest.mark.parametrize(
    ("options", "message"),
    [
        (["--lifelong", "--joint"], "--joint: True; expected no --lifelong beside it"),
        (["--lifelong", "--agents", "3"], "--agents: 3; expected no --lifelong beside it"),
        (["--steps", "3"], "--steps: 3; expected --lifelong beside it"),
    ],
)
def test_options_that_do_not_fit(muster, instance, options, message):
    code, out, err = muster("path", instance, *options)
    assert (code, out) == (2, "")
    assert err.count("\n") == 1
    assert message in err


def test_wrong_input_is_one_line(muster, instance, tmp_path):
    (tmp_path / "a.agents").write_text("8\n0\n")
    code, out, err = muster("path", instance, "--lifelong")
    assert (code, out) == (2, "")
    assert "a.agents:1: number of robots: 8; expected at most 1" in err
    assert muster("path", str(tmp_path / "none.json"), "--lifelong")[0] == 2
