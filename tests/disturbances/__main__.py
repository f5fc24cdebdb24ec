"""`python -m tests.disturbances [MISSIONS] [--first SEED] [--processes N]`, or one seed with all that happened.

Even seeds are missions of points, odd ones of robots with bodies in the kinematic world (`--kind points|bodies`).
"""

import argparse
import sys
from collections import Counter
from multiprocessing import get_context

from tests.disturbances.trial import trial


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.disturbances", description=__doc__)
    parser.add_argument("missions", type=int, nargs="?", default=10_000, help="how many seeds")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--kind", choices=("points", "bodies"), help="only missions of this kind")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--seed", type=int, help="only this seed; all that happened is printed")
    asked = parser.parse_args()
    return one(asked.seed) if asked.seed is not None else many(asked)


def one(seed):
    report = trial(seed)
    _print(*report.happened, *(report.failures or ["no failures"]))
    return 1 if report.failures else 0


def many(asked):
    counts, failures = Counter(), []
    seeds = _seeds(asked)
    with get_context("spawn").Pool(asked.processes) as pool:
        for report in pool.imap_unordered(trial, seeds, chunksize=20):
            counts += report.counts
            if report.failures:
                failures.append(report.seed)
                _print(*(f"seed {report.seed}: {failure}" for failure in report.failures))
    for kind in ("robot_sent_again", "robot_stuck"):
        counts[kind] += 0  # said, also where it never happened
    _print(f"{asked.missions} missions from seed {asked.first}: {len(failures)} fail")
    _print(*(f"  {name}: {count}" for name, count in sorted(counts.items())))
    _print(*(f"  python -m tests.disturbances --seed {seed}" for seed in sorted(failures)))
    return 1 if failures else 0


def _seeds(asked):
    if asked.kind is None:
        return range(asked.first, asked.first + asked.missions)
    odd = int(asked.kind == "bodies")
    first = asked.first + (asked.first + odd) % 2
    return range(first, first + 2 * asked.missions, 2)


def _print(*lines):
    sys.stdout.writelines(f"{line}\n" for line in lines)


if __name__ == "__main__":
    sys.exit(main())
