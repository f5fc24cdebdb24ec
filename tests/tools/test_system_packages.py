"""What tools/test_packages.sh installs on a machine that has nothing."""

import shutil
import subprocess
from pathlib import Path

import pytest

SCRIPT = Path(__file__).parents[2] / "tools" / "test_packages.sh"
ALL = {"chromium", "libegl1", "python3-rosmaster", "python3-rospy", "python3-rosbag", "postgresql"}


@pytest.fixture
def bare(tmp_path):
    """A machine that has a shell and nothing else; `apt-get` writes down what it is told to install."""
    programs = tmp_path / "bin"
    programs.mkdir()

    def program(name, text):
        path = programs / name
        path.write_text(f"#!/bin/sh\n{text}\n", encoding="utf-8")
        path.chmod(0o755)

    program("apt-get", f'echo "$@" >> {tmp_path}/asked')
    program("python-without-libraries", "exit 1")

    def run(user):
        program("id", f"echo {user}")
        environment = {"PATH": str(programs), "PYTHON": "python-without-libraries", "POSTGRESQL": str(tmp_path)}
        done = subprocess.run(
            [shutil.which("sh"), SCRIPT], env=environment, capture_output=True, text=True, check=False
        )
        asked = tmp_path / "asked"
        return done, set(asked.read_text(encoding="utf-8").split()) if asked.exists() else set()

    return run


def test_root_gets_everything(bare):
    done, asked = bare(user=0)
    assert done.returncode == 0
    assert asked >= ALL | {"update", "install"}


def test_others_are_told_what_to_install(bare):
    done, asked = bare(user=1000)
    assert (done.returncode, asked) == (1, set())
    assert all(package in done.stderr for package in ALL)
    assert "sudo apt-get install" in done.stderr
