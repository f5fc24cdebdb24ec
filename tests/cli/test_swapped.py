"""A plan given as the mission, or a mission as the plan: one line that says so."""

import shutil

import pytest

from muster import load, solve
from muster.cli.main import run
from muster.library import mission_path


@pytest.fixture
def files(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    shutil.copy(mission_path("6T-2R"), "m.yaml")
    solve(load("m.yaml"), "greedy").save("p.json")


@pytest.mark.parametrize(
    "arguments",
    [
        ["verify", "p.json", "m.yaml"],
        ["explain", "p.json", "m.yaml"],
        ["export", "p.json", "m.yaml", "--to", "csv"],
        ["simulate", "p.json", "--plan", "m.yaml"],
        ["simulate", "m.yaml", "--plan", "m.yaml"],
        ["verify", "m.yaml", "m.yaml"],
        ["solve", "p.json"],
        ["check", "p.json"],
    ],
)
def test_one_line_says_which_comes_first(arguments, files, capsys):
    assert run(arguments) == 2
    (line,) = capsys.readouterr().err.splitlines()
    assert line.endswith("the MISSION comes first, then the PLAN")


def test_a_file_that_is_not_there_is_named_with_the_nearest(files, capsys):
    assert run(["solve", "m.yml"]) == 2
    assert "did you mean 'm.yaml'?" in capsys.readouterr().err
    assert run(["verify", "m.yaml", "p.jsn"]) == 2
    assert "did you mean 'p.json'?" in capsys.readouterr().err
    assert run(["solve", "m.yaml", "-a", "cbba"]) == 2
    assert "did you mean 'consensus-bundle'?" in capsys.readouterr().err
