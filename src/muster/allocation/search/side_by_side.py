"""Plans that are annealed side by side: the colder it is, the fewer go on.

Which robot gets which part of the tasks is settled while it is hot, and a longer run does not settle it better than a
short one does: so several settle it, and the best of them is worked out. Threads that would be idle then work out
children of those that go on.
"""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from types import TracebackType
from typing import Generic, Protocol, Self, TypeVar

from muster.allocation.allocator import Routes

_EXCHANGES = 20  # of the best plan in a whole run, once it is the only one that goes on

Cross = Callable[[Routes, Routes], Routes]
"""Makes a child of two plans."""


class Annealing(Protocol):
    """What anneals a plan (`core.Search`, `core.ScheduleSearch`)."""

    @property
    def best(self) -> Routes: ...
    @property
    def best_weight_left_out(self) -> float: ...
    @property
    def best_objective(self) -> float: ...
    @property
    def best_tie(self) -> float: ...
    def anneal(self, steps: int, hot: float, cold: float) -> None: ...
    def go_on_from(self, routes: Routes) -> None: ...


def rank_of(search: Annealing) -> tuple[float, float, float]:
    """What a better plan has less of."""
    return search.best_weight_left_out, search.best_objective, search.best_tie


_S = TypeVar("_S", bound=Annealing)


class SideBySide(Generic[_S]):
    """Searches of one run. A context: it ends the threads.

    Parameters
    ----------
    search
        makes the k-th search.
    plans
        that go on at first; then half of them, and so on, each number for an equal share of the run.
    busy
        as many searches work at least.
    threads
        that work.
    cross
        makes a child of two plans.
    """

    def __init__(self, search: Callable[[int], _S], *, plans: int, busy: int, threads: int, cross: Cross) -> None:
        self._searches = [search(k) for k in range(max(plans, busy))]
        self._busy = busy
        self._cross = cross
        stages = plans.bit_length()
        self._halvings = [(k / stages, plans >> k) for k in range(1, stages)]
        self._exchanges = [k / _EXCHANGES for k in range(1, _EXCHANGES) if k / _EXCHANGES > 1 - 1 / stages]
        self._pool = ThreadPoolExecutor(threads)

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self._pool.shutdown()

    @property
    def best(self) -> _S:
        return min(self._searches, key=rank_of)

    def anneal(self, steps: int, temperature: float) -> None:
        """So many steps, shared out among the searches."""
        each = max(1, steps // len(self._searches))
        for done in [self._pool.submit(search.anneal, each, temperature, temperature) for search in self._searches]:
            done.result()

    def go_on(self, share: float) -> None:
        """Let fewer plans go on, or all searches work on the best, if it is time to at this share of the run."""
        if self._halvings and share >= self._halvings[0][0]:
            self._halve(self._halvings.pop(0)[1])
        elif not self._halvings and self._exchanges and share >= self._exchanges[0]:
            self._exchanges.pop(0)
            best = self.best
            for search in self._searches:
                if search is not best:
                    search.go_on_from(best.best)

    def _halve(self, plans: int) -> None:
        ranked = sorted(self._searches, key=rank_of)
        self._searches = ranked[: max(plans, self._busy)]
        parents = [search.best for search in ranked[: max(2, plans)]]
        for k, search in enumerate(self._searches[plans:]):
            first = k % plans
            search.go_on_from(self._cross(parents[first], parents[(first + 1) % len(parents)]))
