"""Search beside a mission that is being carried out: a thread improves routes while the executor's clock goes on."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor

from muster.execution import Revision
from muster.execution.replanning.remaining_problem import RemainingMission, frozen

Routes = Mapping[str, Sequence[str]]
SEARCH_S = 1.0
"""Seconds of the mission's clock that a search is given."""


class BackgroundSearch:
    """See `execution.standing.Improver`; the core searches without the interpreter's lock.

    Parameters
    ----------
    replan
        plans the rest again, by a search that ends after a number of steps; used by one thread alone.
    search_s
        seconds of the mission's clock after which routes are asked for.
    repeatable
        whether they are waited for then, so that the same happens at the same time in each run: in a simulated world.
        Else they are taken at the first look after they are there.
    """

    def __init__(
        self, replan: Callable[[RemainingMission], Revision], *, search_s: float = SEARCH_S, repeatable: bool = True
    ) -> None:
        self._replan, self._search_s, self._repeatable = replan, search_s, repeatable
        self._thread = ThreadPoolExecutor(1, "search")
        self._search: Future[Revision] | None = None
        self._due_s = math.inf

    @property
    def due_s(self) -> float:
        """When routes are to be asked for; inf while none are searched for."""
        return self._due_s

    def begin(self, rest: RemainingMission) -> None:
        """Search for better routes from this moment on."""
        self._search = self._thread.submit(self._replan, frozen(rest))
        self._due_s = rest.now_s + self._search_s

    def found(self, now: float) -> Routes | None:
        """The routes that were found, by robot, if it is time for them."""
        search = self._search
        if search is None or now < self._due_s or not (self._repeatable or search.done()):
            return None
        self._search, self._due_s = None, math.inf
        return search.result().routes

    def close(self) -> None:
        """End the thread, when its search is done."""
        self._thread.shutdown(wait=True, cancel_futures=True)
