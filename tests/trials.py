"""Campaigns: the trials of many seeds in several processes, or that of one seed in full."""

import argparse
import sys
import time
import traceback
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import get_context


@dataclass
class Report:
    """What was wrong in the trial of a seed, and how often what was seen.

    `figures` are those that the campaign sums up; the `story` is told where a seed is tried alone.
    """

    seed: int
    failures: list[str] = field(default_factory=list)
    counts: Counter = field(default_factory=Counter)
    figures: list = field(default_factory=list)
    story: list[str] = field(default_factory=list)

    def check(self, holds, what):
        self.counts["checks"] += 1
        if not holds:
            self.failures.append(what)

    @contextmanager
    def trying(self):
        """An error is a failure like any other."""
        try:
            yield
        except Exception as error:
            self.failures.append(f"{type(error).__name__}: {error}")
            self.story.append(traceback.format_exc())


def parser_of(module, description):
    """What can be asked of a campaign."""
    parser = argparse.ArgumentParser(prog=f"python -m {module}", description=description)
    parser.add_argument("seeds", type=int, nargs="?", default=10_000, help="how many")
    parser.add_argument("--first", type=int, default=0, help="the first seed")
    parser.add_argument("--processes", type=int, default=2)
    parser.add_argument("--seed", type=int, help="only this seed; its story is told")
    return parser


def seeds_of(asked):
    return range(asked.first, asked.first + asked.seeds)


def run(parser, trial, sum_up=lambda figures: "", seeds_of=seeds_of):
    """Try what is asked and tell what came of it; 1 if anything fails, else 0.

    `trial` makes the report of a seed, `sum_up` a line of the figures of all.
    """
    asked = parser.parse_args()
    if asked.seed is not None:
        report = trial(asked.seed)
        _print(*report.story, *_told(report.counts, report.figures, sum_up), *(report.failures or ["no failures"]))
        return 1 if report.failures else 0
    counts, figures, failing, seeds = Counter(), [], [], seeds_of(asked)
    for report in _reports(trial, seeds, asked.processes):
        counts.update(report.counts)
        figures += report.figures
        if report.failures:
            failing.append(report.seed)
    _print(f"{len(seeds)} seeds from {asked.first}: {len(failing)} fail", *_told(counts, figures, sum_up))
    _print(*(f"  {parser.prog} --seed {seed}" for seed in sorted(failing)))
    return 1 if failing else 0


def _reports(trial, seeds, processes):
    """The reports, as they come; failures are told at once, on standard error, above a line of progress."""
    begin, fail = time.monotonic(), 0
    with get_context("spawn").Pool(processes) as pool:
        for done, report in enumerate(pool.imap_unordered(trial, seeds, chunksize=10), 1):
            fail += bool(report.failures)
            _say(*(f"seed {report.seed}: {failure}" for failure in report.failures))
            if done % 50 == 0 or done == len(seeds):
                _say(f"{done} of {len(seeds)} seeds, {fail} fail, {time.monotonic() - begin:.0f} s", end="\r")
            yield report
    sys.stderr.write("\n")


def _told(counts, figures, sum_up):
    yield from (f"  {name}: {count}" for name, count in sorted(counts.items()))
    if figures:
        yield f"  {sum_up(figures)}"


def _print(*lines):
    sys.stdout.writelines(f"{line}\n" for line in lines)


def _say(*texts, end="\n"):
    """On standard error, over the line of progress."""
    sys.stderr.writelines(f"{text:<70}{end}" for text in texts)
    sys.stderr.flush()
