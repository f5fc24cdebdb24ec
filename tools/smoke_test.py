"""Does an installed Muster plan, judge and carry out missions? For wheels, on the Python that has just installed one.

Needs nothing but the package's core install, and none of the repository's files.
"""

from __future__ import annotations

import json
import subprocess
import sys
import tempfile
from importlib.metadata import distribution
from importlib.resources import files
from importlib.util import find_spec
from pathlib import Path

MISSION = "31T-6R50"
PACKAGES = ("muster", *(f"muster_{name}" for name in ("files", "physics", "team", "robots", "control", "studies")))


def main() -> None:
    """Plan a shipped mission from Python and by the command; both plans must be complete and valid."""
    import muster
    from muster import core

    mission = muster.load(MISSION)
    plan = muster.solve(mission, time_limit=1.0, seed=1)
    verdict = muster.verify(mission, plan)
    assert verdict.valid, verdict.violations
    assert plan.tasks_completed == plan.tasks_total == len(mission.tasks)
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "plan.json"
        said = _muster("solve", MISSION, "--iterations", "200", "--seed", "1", "--format", "json", "-o", str(file))
        assert json.loads(said) == json.loads(file.read_text(encoding="utf-8"))
        assert json.loads(_muster("verify", MISSION, str(file), "--format", "json"))["valid"]
        report = json.loads(_muster("simulate", MISSION, "--plan", str(file), "--format", "json"))
    assert len(report["tasks_done"]) == len(mission.tasks), report
    _check_packages()
    print(f"{_muster('--version').strip()}: {plan.objective} {plan.objective_value:.2f}")
    print(f"core: {core.__file__}")


def _check_packages() -> None:
    """All packages are there, typed, with the module of each entry point; the extras are not needed for that."""
    for package in PACKAGES:
        assert (files(package) / "py.typed").is_file(), package
    modules = {entry.module for entry in distribution("muster-robotics").entry_points}
    assert {module.partition(".")[0] for module in modules} == set(PACKAGES)
    assert [module for module in modules if find_spec(module) is None] == []


def _muster(*arguments: str) -> str:
    """What the command prints; an error where it fails."""
    command = [sys.executable, "-m", "muster.cli", *arguments, *(["-q"] if "--version" not in arguments else [])]
    return subprocess.run(command, check=True, capture_output=True, encoding="utf-8").stdout


if __name__ == "__main__":
    main()
