"""Ctrl-C in the first moments of the command, while it is still importing itself, and in the last."""

import subprocess
import sys

import pytest

_COMMAND = """
import os, signal, sys
from importlib.metadata import entry_points

class Interrupting:
    # Sends Ctrl-C to this process when a module is about to be imported.
    def find_spec(self, name, path=None, target=None):
        if name == {module!r}:
            sys.meta_path.remove(self)
            {interrupt}

class Naming:
    def __set_name__(self, owner, name):
        os.kill(os.getpid(), signal.SIGINT)

class Dying:
    def __del__(self):
        os.kill(os.getpid(), signal.SIGINT)

signal.signal(signal.SIGINT, {handler})
sys.meta_path.insert(0, Interrupting())
sys.argv[1:] = ["missions"]
(muster,) = (entry for entry in entry_points(group="console_scripts") if entry.name == "muster")
muster.load()()
"""
_AT_ONCE = "os.kill(os.getpid(), signal.SIGINT)"


def _run(module, interrupt=_AT_ONCE, handler="signal.default_int_handler"):
    program = _COMMAND.format(module=module, interrupt=interrupt, handler=handler)
    return subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)


@pytest.mark.parametrize("module", ["muster.cli.main", "click", "muster.mission.errors", "muster.cli.verbs.missions"])
def test_ctrl_c_while_a_module_is_imported_ends_in_one_line(module):
    done = _run(module)
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "\ninterrupted\n")


@pytest.mark.parametrize("module", ["click", "muster.cli.verbs.missions"])
def test_ctrl_c_within_a_finaliser_ends_in_one_line(module):
    done = _run(module, interrupt="Dying()")
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "\ninterrupted\n")


def test_ctrl_c_while_a_class_is_made_ends_in_one_line():
    """Python 3.11 raises RuntimeError then, from the KeyboardInterrupt."""
    done = _run("muster.cli.verbs.missions", interrupt="type('Named', (), {'field': Naming()})")
    assert (done.returncode, done.stderr.strip()) == (130, "interrupted")


def test_ctrl_c_after_the_last_line_of_the_command_ends_in_one_line():
    done = _run("muster.cli.verbs.missions", interrupt=f"import atexit; atexit.register(lambda: {_AT_ONCE})")
    assert (done.returncode, done.stderr) == (130, "\ninterrupted\n")


def test_a_command_in_the_background_goes_on_ignoring_ctrl_c():
    done = _run("click", handler="signal.SIG_IGN")
    assert (done.returncode, done.stderr) == (0, "")


@pytest.mark.parametrize("module", ["muster", "muster.cli.__main__"])
def test_nothing_is_imported_before_it_is_wanted(module):
    """Ctrl-C is not yet handled while these two are imported."""
    program = f"import sys, {module}; print(*sorted(m for m in sys.modules if m.split('.')[0] in ('muster', 'click')))"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    assert set(done.stdout.split()) <= {"muster", "muster.cli", "muster.cli.__main__"}
