"""What a run may have of this machine's memory."""

import json
import subprocess
import sys

import pytest

HUNGRY = """
import sys
from muster_control.runs.runner import main as runner
runner.mission_of = lambda _: bytearray(3 * 2**29)
runner.alone = lambda *_: __import__("contextlib").nullcontext()
sys.exit(runner.main(["1024"]))
"""


def hungry(world):
    """What a runner says whose mission takes 1.5 GB."""
    begin = {"run": 1, "world": world, "log": [], "mission": {}, "lock": ""}
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "stderr": subprocess.DEVNULL}
    with subprocess.Popen([sys.executable, "-c", HUNGRY], text=True, **pipes) as runner:
        runner.stdin.write(json.dumps(begin) + "\n")
        runner.stdin.flush()
        return [json.loads(line) for line in runner.stdout]


def test_a_simulated_run_may_have_so_much_and_says_what_it_would_need():
    reason = "it needs more than 1024 MB of memory; expected more (--memory)"
    assert hungry("kinematic") == [{"type": "failed", "reason": reason}]


@pytest.mark.long
def test_what_commands_real_robots_is_not_ended_for_that():
    assert hungry("mavlink") == []  # it has its mission, which is none
