"""Runs spread over processes."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

from muster_studies.comparison.workers import in_processes, require_done
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
    for job, found in in_processes(_perform, jobs, workers):
        yield require_done(found, job)


def _perform(job: Job) -> Outcome:
    return perform(*job)
