"""The scripts of the examples run, and say what they are for."""

import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

EXAMPLES = Path(__file__).parents[2] / "examples"
SAID = {
    "plan_and_judge.py": ("lift is left out: skill", "valid: True"),
    "robot_fails.py": ("fails after 5 s",),
    "from_the_shell.sh": ("written: ",),
}


def run(name, folder):
    bin_folder = Path(sys.executable).parent
    environment = os.environ | {"PATH": f"{bin_folder}{os.pathsep}{os.environ['PATH']}", "TMPDIR": str(folder)}
    program = [sys.executable] if name.endswith(".py") else ["sh"]
    command = [*program, str(EXAMPLES / name)]
    return subprocess.run(
        command, cwd=folder, env=environment, capture_output=True, encoding="utf-8", check=True
    ).stdout


@pytest.mark.long
@pytest.mark.parametrize("name", SAID)
def test_a_script_says_what_it_is_for(name, tmp_path):
    said = run(name, tmp_path)
    for words in SAID[name]:
        assert words in said


@pytest.mark.long
def test_the_comparison_has_every_allocator_that_ends_by_itself(tmp_path):
    said = run("compare_allocators.py", tmp_path)
    for name in ("genetic", "search", "market"):
        assert re.search(rf"^ *{name}  31 of 31 tasks, \d+\.\d\d$", said, re.MULTILINE), said


def test_every_script_is_in_the_readme():
    told = (EXAMPLES / "README.md").read_text(encoding="utf-8")
    assert all(script.name in told for script in EXAMPLES.iterdir() if script.suffix in (".py", ".sh"))
