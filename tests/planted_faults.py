"""Plant a fault in each of ten rooms, one after the other, and see `make quick` catch it.

`python -m tests.planted_faults [NAME...]`. A fault is one replaced text in one file, which is put back afterwards. The
exit code is 1 where a fault is not caught.
"""

import argparse
import re
import subprocess
import sys
import time
from dataclasses import dataclass
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]


@dataclass(frozen=True)
class Fault:
    """A text of a source that must stand there once, and what replaces it."""

    path: str
    was: str
    becomes: str


FAULTS = {
    "mission": Fault(
        "src/muster/mission/values/clock_times.py", "if moment < self._start:", "if moment > self._start:"
    ),
    "motion": Fault(
        "src/muster/motion/velocity.py",
        "return motion.slower(max(1.0, _excess",
        "return motion.slower(max(0.5, _excess",
    ),
    "traffic": Fault(
        "src/muster/traffic/reservations.py", "self._last.get(cell, -1) + 1", "self._last.get(cell, -1) - 1"
    ),
    "core (C++)": Fault(
        "src/muster/core/plans/team.cpp", "for (k = size_[robot] - 1 - k;", "for (k = size_[robot] - k;"
    ),
    "allocation": Fault("src/muster/allocation/fixed.py", "if k < least[i] or", "if k <= least[i] or"),
    "verification": Fault(
        "src/muster/verification/energy.py", "if stated > room + slack:", "if stated < room - slack:"
    ),
    "perception": Fault("src/muster/perception/kalman.py", "left @ p @ left.T + gain", "left @ p @ left.T - gain"),
    "execution": Fault(
        "src/muster/state/goods_ledger.py", "sums.get(name, 0.0) + amount", "sums.get(name, 0.0) - amount"
    ),
    "simulation": Fault("src/muster/simulation/energy.py", "self.used(), self.drain)", "self.used(), -self.drain)"),
    "exchange": Fault(
        "src/muster_files/altitudes.py", "first + k * options.altitude_step", "first - k * options.altitude_step"
    ),
    "report (JavaScript)": Fault(
        "src/muster/report/page/player.js", "if (now >= duration) set", "if (now > duration) set"
    ),
}


def caught(fault):
    """Plant a fault, run `make quick`, put the file back; returns whether tests failed, and the seconds it took."""
    path = ROOT / fault.path
    text = path.read_text(encoding="utf-8")
    if text.count(fault.was) != 1:
        raise ValueError(f"{fault.path} must have {fault.was!r} once, and has it {text.count(fault.was)} times")
    begin = time.monotonic()
    try:
        path.write_text(text.replace(fault.was, fault.becomes), encoding="utf-8")
        done = subprocess.run(
            ["make", "quick", "BASE=HEAD", "PYTEST_FLAGS=-x"],
            cwd=ROOT,
            check=False,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
    finally:
        path.write_text(text, encoding="utf-8")
    summary = next((line for line in reversed(done.stdout.splitlines()) if re.search(r"\d (failed|error)", line)), "")
    return bool(done.returncode and summary), time.monotonic() - begin, summary


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.planted_faults", description=__doc__.partition("\n")[0])
    parser.add_argument("names", nargs="*", help=f"of {', '.join(FAULTS)}; all by default")
    asked = parser.parse_args()
    missed = 0
    for name, fault in FAULTS.items():
        if not asked.names or name in asked.names:
            found, seconds, last = caught(fault)
            missed += not found
            sys.stdout.write(f"{'caught' if found else 'MISSED'}  {seconds:4.0f} s  {name}: {fault.path}: {last}\n")
            sys.stdout.flush()
    return int(missed > 0)


if __name__ == "__main__":
    sys.exit(main())
