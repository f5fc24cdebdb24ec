"""The exit code of a command, where several endings hold and where an exception ends it."""

from itertools import permutations

import click
import pytest

from muster.cli import main
from muster.cli.exit_codes import Ending, exit_code, exit_code_if, note_ending
from muster.mission.errors import MusterError

IN_ORDER = (
    Ending.STILL_MOVING,
    Ending.INTERRUPTED,
    Ending.REFUSED,
    Ending.TASKS_LOST,
    Ending.CUT_SHORT,
    Ending.REJECTED,
    Ending.DONE,
)


@pytest.mark.parametrize(("first", "second"), list(permutations(range(len(IN_ORDER)), 2)))
def test_of_two_endings_the_graver_one_decides(first, second):
    codes = (4, 130, 2, 5, 3, 1, 0)
    assert exit_code(IN_ORDER[first], IN_ORDER[second]) == codes[min(first, second)]


def test_what_does_not_hold_does_not_count():
    assert exit_code() == 0
    assert exit_code_if((Ending.STILL_MOVING, []), (Ending.TASKS_LOST, 2), (Ending.INTERRUPTED, False)) == 5


@pytest.mark.parametrize(
    ("error", "code"),
    [
        (MusterError("no such file; expected one"), 2),
        (KeyboardInterrupt(), 130),
        (click.UsageError("no such option"), 2),
        (RuntimeError("a fault"), 70),
    ],
)
@pytest.mark.parametrize("armed", [False, True])
def test_an_armed_robot_decides_whatever_exception_ends_the_command(monkeypatch, capfd, error, code, armed):
    @click.command()
    def command():
        if armed:
            note_ending(Ending.STILL_MOVING)
        raise error

    monkeypatch.setattr(main, "verbs", lambda: {"fails": None})
    monkeypatch.setattr(main._Verbs, "get_command", lambda *_: command)
    assert main.run(["fails"]) == (4 if armed else code)
    assert "Traceback" not in capfd.readouterr().err


MISSION = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], work_capacity: 50}]
tasks: [{id: near, position: [1, 0]}, {id: far, position: [900, 0]}]
"""


@pytest.mark.parametrize(
    ("words", "ending"),
    [
        (["solve", "m.yaml", "--iterations", "9"], Ending.DONE),
        (["solve", "m.yaml", "--iterations", "9", "--require-complete"], Ending.LEFT_OUT),
        (["simulate", "m.yaml", "--iterations", "9", "--require-complete"], Ending.LEFT_OUT),
        (["verify", "m.yaml", "wrong.json"], Ending.REJECTED),
        (["solve", "none.yaml"], Ending.REFUSED),
        (["solve", "m.yaml", "--objective", "best"], Ending.REFUSED),
    ],
)
def test_verbs_end_as_the_table_says(tmp_path, monkeypatch, capsys, words, ending):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "m.yaml").write_text(MISSION)
    (tmp_path / "wrong.json").write_text(
        '{"schema": "muster-plan/1", "routes": [{"robot": "r_0", "tasks": ["near", "far"]}]}'
    )
    assert main.run(words) == ending.code
    assert words[0] in ending.verbs or ending.verbs == "all"
    said = capsys.readouterr()
    assert ending.words.removeprefix("; ") in said.out + said.err
