"""Time to start of `import muster` and of `muster --help`: part of `muster bench`."""

from __future__ import annotations

import subprocess
import sys
import time

from muster_studies.benches.measurement import Measurement


def start_up(runs: int) -> list[Measurement]:
    """Whole processes: `import muster` and `muster --help`, with what Python itself takes."""
    commands = (
        ("from muster import *", [sys.executable, "-c", "from muster import *"], "< 0.3"),
        ("muster --help", [sys.executable, "-m", "muster.cli", "--help"], "< 0.4"),
        ("python alone", [sys.executable, "-c", "pass"], ""),
    )
    return [
        Measurement.over_runs(name, "s", [_seconds(command) for _ in range(runs)], aim)
        for name, command, aim in commands
    ]


def _seconds(command: list[str]) -> float:
    begin = time.perf_counter()
    subprocess.run(command, stdout=subprocess.DEVNULL, check=True)
    return time.perf_counter() - begin
