"""The type stub of the core is the one that its build makes."""

import subprocess
import sys
from pathlib import Path

import muster.core

ROOT = Path(__file__).parents[2]


def test_the_stub_is_generated(tmp_path):
    made = tmp_path / "_core.pyi"
    command = [sys.executable, "-m", "nanobind.stubgen", "-q", "-m", "muster.core._core", "-o", str(made)]
    subprocess.run(command, check=True)
    kept = ROOT / "src" / "muster" / "core" / "_core.pyi"
    assert made.read_text() == kept.read_text(), "run `make stub`"


def test_the_surface_is_that_of_the_module():
    from muster.core import _core

    def names(module):
        return {name for name in vars(module) if not name.startswith("_")}

    assert names(muster.core) == names(_core) != set()
