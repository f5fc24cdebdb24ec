"""Example packages, installed for the tests of a module, which says where its EXAMPLE is."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def installed(request, tmp_path_factory):
    """The folder in which the package is installed, without a network."""
    folder = tmp_path_factory.mktemp("site")
    pip = [sys.executable, "-m", "pip", "install", "--quiet", "--no-deps", "--no-build-isolation", "--no-index"]
    subprocess.run([*pip, "--target", str(folder), str(request.module.EXAMPLE)], check=True)
    return folder


@pytest.fixture(scope="module")
def run(installed):
    """Runs Python with the package; the process that ended."""

    def run(*arguments):
        command = [sys.executable, *map(str, arguments)]
        environment = {**os.environ, "PYTHONPATH": str(installed)}
        return subprocess.run(command, capture_output=True, text=True, check=False, env=environment, cwd=ROOT)

    return run


@pytest.fixture(scope="module")
def muster(run):
    return lambda *arguments: run("-m", "muster.cli", *arguments)
