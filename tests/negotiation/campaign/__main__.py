"""Run the campaign: `python -m tests.negotiation.campaign [RUNS] [--first SEED] [--processes N]`, or one seed."""

import argparse
import sys
import time
from collections import Counter
from multiprocessing import get_context

from tests.negotiation.campaign.trial import trial

from muster.studies.negotiation import replay
from muster.studies.negotiation.observer import PROMISED_NEVER


def main():
    parser = argparse.ArgumentParser(prog="python -m tests.negotiation.campaign", description=__doc__)
    parser.add_argument("runs", type=int, nargs="?", default=10_000, help="how many seeds")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--seed", type=int, help="only this seed; what happens in it is printed")
    asked = parser.parse_args()
    return one(asked.seed) if asked.seed is not None else many(asked)


def one(seed):
    report = replay(seed)
    _print(*report.lines())
    return 1 if report.failures else 0


def many(asked):
    begin, counts, failing, took = time.monotonic(), Counter(), [], []
    seeds = range(asked.first, asked.first + asked.runs)
    with get_context("spawn").Pool(asked.processes) as pool:
        for done, (seed, failures, time_taken, seen) in enumerate(pool.imap_unordered(trial, seeds, chunksize=10), 1):
            counts += seen
            took.append(time_taken)
            if failures:
                failing.append(seed)
                _say("\n".join(f"seed {seed}: {failure}" for failure in failures))
            if done % 50 == 0 or done == asked.runs:
                _say(f"{done} of {asked.runs} runs, {len(failing)} fail, {time.monotonic() - begin:.0f} s", end="\r")
    sys.stderr.write("\n")
    _print(f"{asked.runs} runs from seed {asked.first}: {len(failing)} fail")
    _print(*(f"  {name}: {count}" for name, count in sorted(counts.items())))
    _print(*(f"  {kind}: {counts[kind]}" for kind in PROMISED_NEVER if kind not in counts))
    seconds, shares = (sorted(values) for values in zip(*took, strict=True))
    middle, most = seconds[len(seconds) // 2], seconds[int(0.99 * (len(seconds) - 1))]
    _print(
        f"  agreed after quiet: {middle:.2f} s (median), {most:.2f} s (99 %), {seconds[-1]:.2f} s (all), virtual time"
    )
    _print(f"  which is at most {shares[-1]:.0%} of what the docs allow")
    _print(*(f"  python -m tests.negotiation.campaign --seed {seed}" for seed in sorted(failing)))
    return 1 if failing else 0


def _print(*lines):
    sys.stdout.writelines(f"{line}\n" for line in lines)


def _say(text, end="\n"):
    """On standard error: failures as they come, and a line of progress that is written over."""
    sys.stderr.write(f"{text:<70}{end}")
    sys.stderr.flush()


if __name__ == "__main__":
    sys.exit(main())
