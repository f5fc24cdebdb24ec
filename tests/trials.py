"""Campaigns: the trials of many seeds in several processes, or that of one seed in full."""

import argparse
import signal
import sys
import time
import traceback
from collections import Counter
from contextlib import contextmanager
from dataclasses import dataclass, field
from multiprocessing import get_context
from multiprocessing.connection import wait


@dataclass
class Report:
    """What was wrong in the trial of a seed, and how often what was seen.

    `figures` are those that the campaign sums up; the `story` is told where a seed is tried alone. `notes` are told of
    every seed, and are no failures.
    """

    seed: int
    failures: list[str] = field(default_factory=list)
    counts: Counter = field(default_factory=Counter)
    figures: list = field(default_factory=list)
    story: list[str] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)

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


def run(parser, trial, sum_up=lambda figures: "", seeds_of=seeds_of, cpu_limit_s=None):
    """Try what is asked and tell what came of it; 1 if anything fails, else 0.

    `trial` makes the report of a seed, `sum_up` a line of the figures of all. A seed that takes more than `cpu_limit_s`
    of CPU time fails.
    """
    asked = parser.parse_args()
    if asked.seed is not None:
        report = trial(asked.seed)
        told = _told(report.counts, report.figures, sum_up)
        _print(*report.story, *report.notes, *told, *(report.failures or ["no failures"]))
        return 1 if report.failures else 0
    counts, figures, failing, seeds = Counter(), [], [], seeds_of(asked)
    for report in _reports(trial, seeds, asked.processes, cpu_limit_s):
        counts.update(report.counts)
        figures += report.figures
        if report.failures:
            failing.append(report.seed)
    _print(f"{len(seeds)} seeds from {asked.first}: {len(failing)} fail", *_told(counts, figures, sum_up))
    _print(*(f"  {parser.prog} --seed {seed}" for seed in sorted(failing)))
    return 1 if failing else 0


def _reports(trial, seeds, processes, cpu_limit_s):
    """The reports, as they come; failures are told at once, on standard error, above a line of progress."""
    begin, fail = time.monotonic(), 0
    for done, report in enumerate(tried(trial, seeds, processes, cpu_limit_s), 1):
        fail += bool(report.failures)
        _say(*(f"seed {report.seed}: {failure}" for failure in (*report.failures, *report.notes)))
        if done % 50 == 0 or done == len(seeds):
            _say(f"{done} of {len(seeds)} seeds, {fail} fail, {time.monotonic() - begin:.0f} s", end="\r")
        yield report
    sys.stderr.write("\n")


def tried(trial, seeds, processes, cpu_limit_s):
    """Yield the report of each seed, as processes make them. A seed with which its process ends is a failure."""
    context, left = get_context("spawn"), iter(seeds)
    workers = {}  # by the connection to each process: the process, and its seed

    def begin(connection, process):
        seed = next(left, None)
        connection.send(seed)
        if seed is None:
            process.join()
        else:
            workers[connection] = process, seed

    def start():
        ours, theirs = context.Pipe()
        process = context.Process(target=_work, args=(trial, theirs, cpu_limit_s), daemon=True)
        process.start()
        theirs.close()
        begin(ours, process)

    for _ in range(min(processes, len(seeds))):
        start()
    while workers:
        for connection in wait(list(workers)):
            process, seed = workers.pop(connection)
            try:
                report = connection.recv()
            except EOFError:
                process.join()
                limit = process.exitcode == -signal.SIGVTALRM
                why = f"more than {cpu_limit_s:g} s of CPU time" if limit else f"exit code {process.exitcode}"
                yield Report(seed, failures=[f"its process ended: {why}"])
                start()
                continue
            begin(connection, process)
            yield report


def _work(trial, connection, cpu_limit_s):
    """Try one seed after the other. The kernel ends the process at the limit, whatever code it executes."""
    while (seed := connection.recv()) is not None:
        signal.setitimer(signal.ITIMER_VIRTUAL, cpu_limit_s or 0.0)
        report = trial(seed)
        connection.send(Report(seed, report.failures, report.counts, report.figures, report.story, report.notes))


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
