"""What the tests of the verbs share."""

from pathlib import Path

import pytest
from tests.cli.yard import MISSION, ROBOTS, TABLE, TASKS

from muster.cli.main import run


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """The test runs in a folder of its own with a mission in it."""
    monkeypatch.chdir(tmp_path)
    for name, text in (("yard.yaml", MISSION), ("t.csv", TASKS), ("r.csv", ROBOTS), ("s.csv", TABLE)):
        Path(name).write_text(text, encoding="utf-8")
    return tmp_path


@pytest.fixture
def muster(capsys):
    """Runs the command; gives its exit code, standard output and standard error."""

    def call(*arguments):
        code = run([str(argument) for argument in arguments])
        return (code, *capsys.readouterr())

    return call


@pytest.fixture
def plan(folder, muster):
    """A plan of the yard: `lift` is left out."""
    assert muster("solve", "yard.yaml", "--iterations", 20, "-o", "plan.json")[0] == 0
    return Path("plan.json")
