"""mypy --strict and pyright accept what is right and refuse what is wrong, line by line."""

import json
import re
import subprocess
import sys
from pathlib import Path

import pytest

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
FILES = ("right.py", "wrong.py")
pytestmark = pytest.mark.xdist_group("types")  # each checker runs once


def mypy():
    """The lines with errors, by file."""
    command = [sys.executable, "-m", "mypy", "--strict", "--no-error-summary", *(str(HERE / name) for name in FILES)]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert said.returncode in (0, 1), said.stderr
    found = {name: set() for name in FILES}
    for path, line in re.findall(r"^(\S+?):(\d+): error:", said.stdout, re.MULTILINE):
        found[Path(path).name].add(int(line))
    return found


def pyright():
    """The lines with errors, by file; basedpyright is pyright with its node, all from wheels."""
    command = [sys.executable, "-m", "basedpyright", "--outputjson", "--pythonpath", sys.executable, "-p", str(HERE)]
    said = subprocess.run(command, cwd=ROOT, capture_output=True, text=True, check=False)
    assert said.returncode in (0, 1), said.stderr or said.stdout
    found = {name: set() for name in FILES}
    for item in json.loads(said.stdout)["generalDiagnostics"]:
        name = Path(item["file"]).name
        if item["severity"] == "error" and name in found:
            found[name].add(item["range"]["start"]["line"] + 1)
    return found


@pytest.fixture(scope="module", params=[pytest.param(mypy, marks=pytest.mark.long), pyright], ids=["mypy", "pyright"])
def errors(request):
    return request.param()


def marked(name):
    lines = (HERE / name).read_text(encoding="utf-8").splitlines()
    return {number for number, line in enumerate(lines, 1) if line.endswith("# error")}


def test_every_wrong_line_is_refused_and_no_other(errors):
    assert len(marked("wrong.py")) == 21
    assert errors["wrong.py"] == marked("wrong.py")


def test_what_is_right_is_accepted(errors):
    assert errors["right.py"] == set()
