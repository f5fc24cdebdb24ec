"""`make flakes`: run the fast tests in random order beside two busy loops, five times, and name every test that fails.

`python -m tools.suites.flakes [ROUNDS] [--seed SEED] [PATH...]`. The seed of round k is SEED + k.
"""

import argparse
import subprocess
import sys
from collections import Counter
from collections.abc import Iterator
from contextlib import contextmanager

from tools.suites.change import ROOT

_BUSY = 2
_TESTS = [sys.executable, "-m", "pytest", "-q", "-n", "2", "--dist", "loadgroup", "--suite", "fast"]


def main() -> int:
    parser = argparse.ArgumentParser(prog="python -m tools.suites.flakes", description=__doc__.partition("\n")[0])
    parser.add_argument("rounds", type=int, nargs="?", default=5)
    parser.add_argument("paths", nargs="*")
    parser.add_argument("--seed", type=int, default=1)
    asked = parser.parse_args()
    failures: Counter[str] = Counter()
    with busy_loops():
        for number in range(asked.rounds):
            failures.update(_failing(asked.seed + number, asked.paths))
    print(f"{asked.rounds} rounds: {len(failures)} tests failed at least once")
    for test, times in failures.most_common():
        print(f"  {times} of {asked.rounds}: {test}")
    return int(bool(failures))


@contextmanager
def busy_loops() -> Iterator[None]:
    """Keep as many processors busy as there are loops."""
    loops = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(_BUSY)]
    try:
        yield
    finally:
        for loop in loops:
            loop.kill()
            loop.wait()


def _failing(seed: int, paths: list[str]) -> list[str]:
    """Run the tests in the order of a seed; return the ids of those that failed, with the seed where none is named."""
    print(f"seed {seed}", flush=True)
    done = subprocess.run(
        [*_TESTS, "--shuffle", str(seed), *paths], cwd=ROOT, check=False, stdout=subprocess.PIPE, text=True
    )
    print(done.stdout[-3000:], flush=True)
    lines = [line for line in done.stdout.splitlines() if line.startswith(("FAILED ", "ERROR "))]
    failed = [line.split(" - ")[0].partition(" ")[2] for line in lines]
    return failed or ([f"the run of seed {seed}, which ended with {done.returncode}"] if done.returncode else [])


if __name__ == "__main__":
    sys.exit(main())
