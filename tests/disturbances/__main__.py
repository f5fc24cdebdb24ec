"""`python -m tests.disturbances [N] [--first SEED]`: N seeds (10,000) on all cores; what happened, and what was wrong."""

import argparse
import sys
from collections import Counter
from concurrent.futures import ProcessPoolExecutor

from tests.disturbances.trial import trial


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.disturbances")
    parser.add_argument("missions", nargs="?", type=int, default=10_000)
    parser.add_argument("--first", type=int, default=0)
    parser.add_argument("--processes", type=int)
    args = parser.parse_args()
    counts, wrong = Counter(), 0
    with ProcessPoolExecutor(args.processes) as pool:
        for report in pool.map(trial, range(args.first, args.first + args.missions), chunksize=20):
            counts += report.counts
            for failure in report.failures:
                wrong += 1
                print(f"seed {report.seed}: {failure}", file=sys.stderr)
    for what, number in sorted(counts.items()):
        print(f"{number:10,}  {what}")
    print(f"{wrong:10,}  failures")
    return 1 if wrong else 0


if __name__ == "__main__":
    sys.exit(main())
