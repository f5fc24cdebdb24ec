"""Runs the fast tests of one package in an environment with the wheel, the extras that they need, and no other extra.

`make test-alone PACKAGE=muster_files`. What the package or one of its tests imports beyond its extras fails here.
"""

import shutil
import subprocess
import sys

from tools.built_files import sources, wrong_in_wheel
from tools.suites.change import ROOT

EXTRAS = {
    "muster_files": ("sites", "sheets"),
    "muster_physics": ("physics", "map"),
    "muster_team": ("net", "map"),
    "muster_robots": ("mavlink", "ros2", "record", "map", "plot"),
    "muster_control": ("web", "client"),
    "muster_studies": ("studies", "compare"),
}
"""The extras that the tests of each package need. A test that needs more, of another package, is skipped without."""
_TOOLS = {"muster_files": "test-files", "muster_robots": "test-robots", "muster_control": "test-control"}
"""The dependency group of pyproject.toml with what the tests of a package need besides; `test` for the others."""

_PLACE = ROOT / "build" / "alone"
_PIP = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]


def main(package: str) -> int:
    """Build the wheel, make the environment anew, and run the tests there; returns the exit code of pytest."""
    python = environment(package, wheel())
    tests = [python, "-m", "pytest", f"tests/{package}", "--suite", "fast", "-q", "-n", "4", "--dist", "loadgroup"]
    return subprocess.run(tests, cwd=ROOT, check=False).returncode


def wheel() -> str:
    """Build the wheel of the working tree as the editable installation is built, so that little is compiled again.

    Raises
    ------
    SystemExit
        if it has not the sources of all packages, or files besides.
    """
    folder = _PLACE / "wheel"
    shutil.rmtree(folder, ignore_errors=True)
    as_installed = ["-C", "cmake.define.MUSTER_WERROR=ON", "-C", "cmake.define.MUSTER_UNITY=OFF"]
    _run(*_PIP, "wheel", "--no-deps", "--no-build-isolation", "--wheel-dir", str(folder), *as_installed, str(ROOT))
    (built,) = folder.glob("*.whl")
    if wrong := wrong_in_wheel(built, sources()):
        raise SystemExit(f"{built.name}: {'; '.join(wrong)}")
    return str(built)


def environment(package: str, built: str) -> str:
    """Make an environment with a wheel, the extras of a package and the tools of its tests; returns its Python."""
    folder = _PLACE / package
    _run(sys.executable, "-m", "venv", "--clear", "--without-pip", str(folder))
    python = str(folder / "bin" / "python")
    group = f"{ROOT / 'pyproject.toml'}:{_TOOLS.get(package, 'test')}"
    extras = ",".join(EXTRAS[package])
    _run(*_PIP, "--python", python, "install", "--group", group, f"muster-robotics[{extras}] @ file://{built}")
    return python


def _run(*command: str) -> None:
    subprocess.run(command, cwd=ROOT, check=True)


if __name__ == "__main__":
    if sys.argv[1:] not in [[package] for package in EXTRAS]:
        sys.exit(f"usage: make test-alone PACKAGE=NAME, where NAME is one of {', '.join(EXTRAS)}")
    sys.exit(main(sys.argv[1]))
