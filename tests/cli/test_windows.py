"""On Windows: what needs POSIX is refused in one line, all else is there. What Windows lacks is taken away here."""

import subprocess
import sys

import pytest

pytest.importorskip("scipy")
pytest.importorskip("msgpack")
pytest.importorskip("cryptography")

pytestmark = pytest.mark.usefixtures("folder")

AS_ON_WINDOWS = """
import os, signal, sys
import click, numpy, yaml, rich.console, rich.table, rich.progress  # which look at the platform themselves
import asyncio, ctypes.util, multiprocessing.connection, pathlib, platform, scipy.sparse, subprocess, tempfile
import cryptography.hazmat.bindings._rust, msgpack, uuid, webbrowser

class Absent:
    def find_spec(self, name, path=None, target=None):
        if name.split(".")[0] in ("fcntl", "grp", "pty", "pwd", "resource", "termios"):
            raise ModuleNotFoundError(f"No module named {name!r}", name=name)

sys.meta_path.insert(0, Absent())
for name in ("fcntl", "grp", "pty", "pwd", "resource", "termios"):
    sys.modules.pop(name, None)
for module, names in {
    os: ("fork", "getuid", "geteuid", "killpg", "nice", "sched_getaffinity", "fchmod", "pread", "setsid"),
    signal: ("SIGHUP", "SIGKILL", "SIGUSR1", "pthread_sigmask"),
}.items():
    for name in names:
        delattr(module, name)
sys.platform = "win32"
from muster.cli.main import run
sys.exit(run(sys.argv[1:]))
"""


def on_windows(*arguments):
    command = [sys.executable, "-c", AS_ON_WINDOWS, *arguments]
    ended = subprocess.run(command, capture_output=True, encoding="utf-8", timeout=120)
    return ended.returncode, ended.stdout, ended.stderr


@pytest.mark.long(keep=1)
@pytest.mark.parametrize(
    ("arguments", "purpose"),
    [
        (["serve"], "mission control"),
        (["db", "info"], "mission control"),
        (["bench"], "muster bench"),
        (["auction", "yard.yaml"], "a team of processes, one a robot,"),
    ],
)
def test_what_needs_posix_says_so(arguments, purpose):
    code, out, err = on_windows(*arguments)
    assert (code, out) == (2, "")
    assert err == f"{purpose} does not work on win32; expected Linux, macOS, or WSL on Windows\n"


@pytest.mark.long
def test_plans_are_made_and_judged():
    code, _, err = on_windows("solve", "yard.yaml", "--iterations", "10", "-o", "plan.json", "-q")
    assert (code, err) == (0, "")
    code, _, err = on_windows("simulate", "yard.yaml", "--plan", "plan.json", "-q")
    assert (code, err) == (0, "")


@pytest.mark.long
def test_every_verb_can_be_imported():
    lines = "for verb in verbs():\n    assert muster.get_command(None, verb), verb\n"
    lines = f"from muster.cli.main import muster, verbs\n{lines}"
    script = AS_ON_WINDOWS.rsplit("from muster", 1)[0] + lines
    ended = subprocess.run([sys.executable, "-c", script], capture_output=True, encoding="utf-8")
    assert (ended.returncode, ended.stderr) == (0, "")
