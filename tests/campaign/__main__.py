"""Run the campaign: `python -m tests.campaign [MISSIONS] [--first SEED] [--processes N]`, or one seed in full."""

import argparse
import sys
import time
from collections import Counter
from multiprocessing import get_context

from tests.campaign.missions import case
from tests.campaign.trial import trial


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.campaign", description=__doc__)
    parser.add_argument("missions", type=int, nargs="?", default=10_000, help="how many seeds")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--seed", type=int, help="only this seed; its mission is printed")
    asked = parser.parse_args()
    return one(asked.seed) if asked.seed is not None else many(asked)


def one(seed):
    report = trial(seed)
    _print(case(seed).mission, *(report.failures or ["no failures"]))
    return 1 if report.failures else 0


def many(asked):
    begin, counts, failures, gaps = time.monotonic(), Counter(), [], []
    seeds = range(asked.first, asked.first + asked.missions)
    with get_context("spawn").Pool(asked.processes) as pool:
        for done, report in enumerate(pool.imap_unordered(trial, seeds, chunksize=10), 1):
            counts += report.counts
            gaps += report.gaps
            if report.failures:
                failures.append(report.seed)
                _say("\n".join(f"seed {report.seed}: {failure}" for failure in report.failures))
            if done % 50 == 0 or done == asked.missions:
                seconds = time.monotonic() - begin
                _say(f"{done} of {asked.missions} missions, {len(failures)} fail, {seconds:.0f} s", end="\r")
    sys.stderr.write("\n")
    _print(f"{asked.missions} missions from seed {asked.first}: {len(failures)} fail")
    _print(*(f"  {name}: {count}" for name, count in sorted(counts.items())))
    if gaps:
        _print(f"  small: mean gap of quick bounds: {100 * sum(gaps) / len(gaps):.1f} %")
    _print(*(f"  python -m tests.campaign --seed {seed}" for seed in sorted(failures)))
    return 1 if failures else 0


def _print(*lines):
    sys.stdout.writelines(f"{line}\n" for line in lines)


def _say(text, end="\n"):
    """On standard error: failures as they come, and a line of progress that is written over."""
    sys.stderr.write(f"{text:<70}{end}")
    sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(main())
