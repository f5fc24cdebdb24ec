"""Workers that improve parts of a team: threads of this process, or another implementation of `Workers`."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.stop import Stop
from muster.model.problem import Floats, Problem

Improve = Callable[[Problem, Stop, int, Routes], Routes]
"""Makes better routes of a part of the problem, from a seed and the routes it has."""


@dataclass(frozen=True)
class Limits:
    """What each part may take; seconds, so that they hold whatever clock the worker has."""

    time_s: float | None
    iterations: int | None


@dataclass(frozen=True)
class Offer:
    """Routes of a part, their usages, and whether they do more than it did."""

    routes: Routes
    usages: Floats
    does_more: bool


@dataclass(frozen=True)
class Job:
    """A part whose routes are to be improved, with all that this takes: it can be sent to another machine."""

    part: Problem
    seed: int
    routes: Routes
    limits: Limits
    improve: Improve

    def done(self, whole: Stop) -> Offer:
        """The best routes found within the job's limits, or when the whole ends."""
        until = whole.part(time_limit=self.limits.time_s, iterations=self.limits.iterations)
        return self.offer(self.improve(self.part, until, self.seed, self.routes))

    def offer(self, better: Routes) -> Offer:
        """What these routes of the part come to."""
        more = self.part.value(better)[0] > self.part.value(self.routes)[0]
        return Offer(better, np.array(core.Inspection(self.part.core, better).usages), more)


class Workers(Protocol):
    """Does jobs side by side."""

    @property
    def count(self) -> int:
        """How many jobs are done at the same time."""
        ...

    def map(self, jobs: Sequence[Job], stop: Stop) -> Iterator[Offer | None]:
        """What each job offers, in the order of the jobs; None for one whose worker was lost.

        When `stop` is due, jobs end with the best they have, those that have not begun with None.
        """
        ...


@dataclass(frozen=True)
class Threads:
    """Threads of this process; the core lets them run at the same time."""

    count: int

    def map(self, jobs: Sequence[Job], stop: Stop) -> Iterator[Offer | None]:
        with ThreadPoolExecutor(self.count) as pool:
            yield from pool.map(lambda job: None if stop.due() else job.done(stop), jobs)
