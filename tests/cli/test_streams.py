"""What goes to standard output and what to standard error; progress and Ctrl-C."""

import json
import os
import pty
import select
import signal
import subprocess
from pathlib import Path

import pytest
from tests.cli.yard import MUSTER

from muster.mission.reading.plan_reader import read_plan

pytestmark = pytest.mark.usefixtures("folder")


@pytest.mark.long
@pytest.mark.parametrize(
    "arguments",
    [
        ["missions"],
        ["check", "yard.yaml"],
        ["check", "yard.yaml", "--ignore", "skills"],
        ["solve", "yard.yaml", "--iterations", "5"],
        ["solve", "yard.yaml", "--iterations", "5", "-v", "-o", "p.json", "--plot", "p.svg"],
        ["solve", "yard.yaml", "--time-limit", "0.05", "-q"],
        ["verify", "yard.yaml", "plan.json"],
        ["explain", "yard.yaml", "plan.json"],
        ["explain", "yard.yaml", "plan.json", "--task", "open"],
    ],
)
def test_json_on_standard_output_is_pure(arguments, plan):
    done = subprocess.run([MUSTER, *arguments, "--format", "json"], capture_output=True, encoding="utf-8", check=False)
    impossible = arguments == ["check", "yard.yaml"]  # nobody has a gripper
    assert done.returncode == (3 if impossible else 0)
    json.loads(done.stdout)
    assert done.stderr == "" or "-v" in arguments


def test_a_reader_that_stops_reading():
    """`muster missions | head -1`: no traceback."""
    read, write = os.pipe()
    os.close(read)
    done = subprocess.run([MUSTER, "missions"], stdout=write, stderr=subprocess.PIPE, encoding="utf-8", check=False)
    os.close(write)
    assert (done.returncode, done.stderr) == (141, "")


class OnTerminal:
    """The command with its standard error on a terminal."""

    def __init__(self, *arguments):
        self._terminal, side = pty.openpty()
        environment = os.environ | {"TERM": "xterm", "COLUMNS": "100"}
        command = [MUSTER, *map(str, arguments)]
        self.process = subprocess.Popen(command, stdout=subprocess.PIPE, stderr=side, env=environment)
        os.close(side)
        self.shown = b""

    def wait_for(self, word, most_s=60):
        """Read until the word is shown."""
        while word not in self.shown:
            assert self._read(most_s), f"{word!r} was not shown: {self.shown!r}"

    def _read(self, most_s):
        if not select.select([self._terminal], [], [], most_s)[0]:
            return False
        try:
            more = os.read(self._terminal, 65536)
        except OSError:  # Linux says so where the other side is closed
            more = b""
        self.shown += more
        return bool(more)

    def finish(self):
        """Exit code, standard output, and all that the terminal got."""
        while self._read(60):
            pass
        out = self.process.stdout.read()
        self.process.stdout.close()
        code = self.process.wait(60)
        os.close(self._terminal)
        return code, out.decode(), self.shown.decode()


@pytest.mark.long
def test_progress_is_not_shown_when_asked_for_quiet():
    code, _, shown = OnTerminal("solve", "eil51-5", "--time-limit", 1, "-q").finish()
    assert (code, shown) == (0, "")


@pytest.mark.long
def test_progress_is_not_shown_where_there_is_no_terminal():
    done = subprocess.run(
        [MUSTER, "solve", "eil51-5", "--iterations", "500"], capture_output=True, encoding="utf-8", check=False
    )
    assert (done.returncode, done.stderr) == (0, "")
    assert "planning" not in done.stdout


@pytest.mark.long
@pytest.mark.parametrize("form", ["table", "json"])
def test_progress_is_shown_on_a_terminal_and_ctrl_c_keeps_the_best_plan_so_far(form, muster):
    run_ = OnTerminal("solve", "eil51-5", "--time-limit", 600, "-o", "plan.json", "--format", form)
    run_.wait_for(b"planning")
    run_.wait_for(b"best")
    run_.process.send_signal(signal.SIGINT)
    code, out, shown = run_.finish()
    assert code == 130
    assert "interrupted: this is the best plan so far" in shown
    assert "Traceback" not in shown
    assert "planning" not in out
    assert (out == Path("plan.json").read_text(encoding="utf-8")) == (form == "json")
    assert muster("verify", "eil51-5", "plan.json")[0] == 0
    assert read_plan("plan.json").tasks_completed == 50
