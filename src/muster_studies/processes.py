"""Runs spread over processes."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor, as_completed
from multiprocessing.synchronize import Event

from muster.mission.interrupts import ctrl_c_held_back
from muster_studies.runs import Case, Outcome, Sample, perform

Job = tuple[Case, int]
"""A case and a seed."""


def run_cases(
    cases: Iterable[Case], seeds: int, workers: int, on_done: Callable[[int, int], None] | None = None
) -> Mapping[Case, Sample]:
    """Run each case with seeds 0 to seeds - 1, a case without randomness once.

    The longest go first, so that no process is left alone with a long one at the end. What comes out does not depend
    on `workers`.
    """
    seeds_of = {case: range(seeds if case.random else 1) for case in cases}
    jobs = [(case, seed) for case, own_seeds in seeds_of.items() for seed in own_seeds]
    jobs.sort(key=lambda job: -(job[0].iterations or 0))
    outcomes: dict[Job, Outcome] = {}
    for outcome in _in_this_process(jobs) if min(workers, len(jobs)) <= 1 else _in_processes(jobs, workers):
        outcomes[outcome.case, outcome.seed] = outcome
        if on_done is not None:
            on_done(len(outcomes), len(jobs))
    return {case: Sample(tuple(outcomes[case, seed] for seed in own_seeds)) for case, own_seeds in seeds_of.items()}


def _in_this_process(jobs: Sequence[Job]) -> Iterator[Outcome]:
    for case, seed in jobs:
        yield perform(case, seed)


def _in_processes(jobs: Sequence[Job], workers: int) -> Iterator[Outcome]:
    # Not forked: the caller may have threads (a progress bar has one), and a fork keeps what locks they hold.
    context = multiprocessing.get_context("spawn")
    leave = context.Event()
    pool = ProcessPoolExecutor(
        min(workers, len(jobs)), mp_context=context, initializer=_begin_process, initargs=(leave,)
    )
    try:
        with ctrl_c_held_back():
            futures = [pool.submit(_perform, case, seed) for case, seed in jobs]
        for future in as_completed(futures):
            yield future.result()
    finally:
        leave.set()
        pool.shutdown(cancel_futures=True)


_leave: Event | None = None


def _begin_process(leave: Event) -> None:
    """Prepare a process: it ignores Ctrl-C, ends on its parent's event, and ends with its parent."""
    global _leave  # an initializer has no other way to hand something to the jobs
    _leave = leave
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    if parent is not None:
        parent.join()
        os._exit(1)


def _perform(case: Case, seed: int) -> Outcome:
    assert _leave is not None
    return perform(case, seed, _leave.is_set)
