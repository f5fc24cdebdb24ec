"""How a mission is planned again while it is carried out, by the options with which it was planned."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import replace

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_of
from muster.allocation.search.search import SEARCH
from muster.execution import Reallocation, Revision, Standing, travel_of
from muster.execution.replanning.insertion import Insertion
from muster.execution.replanning.reallocation import REPLANNING
from muster.execution.replanning.remaining_problem import RemainingMission, frozen
from muster.execution.replanning.travel import Travel
from muster.mission.model import Mission
from muster.planning.options import PlanningOptions


def reallocation_by(options: PlanningOptions | None, travel: Travel, seed: int) -> Reallocation:
    """What plans the rest again after a change.

    An allocator that leaves work under way where it is plans again with its parameters: `search`, `greedy`, and those
    of other packages that say so. For all others `search` does, with its defaults. The objective is the plan's, the
    rules that do not hold too, and `rewire` fills waiting each time.

    Raises
    ------
    ParameterError
        if the allocator has no such parameter.
    """
    if options is None:
        return Reallocation(travel=travel, seed=seed)
    allocator, parameters = allocator_of(options.allocator), dict(options.parameters)
    if not allocator.keeps_fixed:
        return Reallocation(travel=travel, seed=seed, fill_waiting=options.rewire)
    if allocator is SEARCH:
        parameters = {**REPLANNING, **parameters}
    return Reallocation(
        travel=travel,
        seed=seed,
        allocator=allocator,
        parameters=make_parameters(allocator, parameters),
        fill_waiting=options.rewire,
    )


def planning_of(
    mission: Mission,
    standing: Standing | None,
    options: PlanningOptions | None,
    travel: Travel,
    seed: int,
    *,
    repeatable: bool = True,
) -> tuple[Callable[[RemainingMission], Revision], Standing | None]:
    """What plans the rest again after a change, and how a standing fleet searches beside that.

    Without a standing fleet `reallocation_by` does all. With one orders are put into its routes at once, and that
    searches in the background.

    Parameters
    ----------
    standing
        as it was asked for; one that has an improver keeps it.
    repeatable
        see `BackgroundSearch`.
    """
    if standing is None:
        return reallocation_by(options, travel, seed), None
    if standing.improver is None and standing.searches:
        # A travel of its own: path finders are for one thread.
        replan = replace(reallocation_by(options, travel_of(mission), seed), for_a_gain=True)
        search = BackgroundSearch(replan, repeatable=repeatable)
        standing = replace(standing, improver=search)
    return Insertion(travel), standing


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
        self._search: Future[Routes] | None = None
        self._due_s = math.inf

    @property
    def due_s(self) -> float:
        """When routes are to be asked for; inf while none are searched for."""
        return self._due_s

    def begin(self, rest: RemainingMission) -> None:
        """Search for better routes from this moment on."""
        self._search = self._thread.submit(self._changed, frozen(rest))
        self._due_s = rest.now_s + self._search_s

    def _changed(self, rest: RemainingMission) -> Routes:
        """The routes that a search has changed."""
        routes = self._replan(rest).routes
        return {name: route for name, route in routes.items() if list(route) != list(rest.routes.get(name, ()))}

    def found(self, now: float) -> Routes | None:
        """The routes that were found, by robot, if it is time for them; of those robots alone that have others."""
        search = self._search
        if search is None or now < self._due_s or not (self._repeatable or search.done()):
            return None
        self._search, self._due_s = None, math.inf
        return search.result()

    def close(self) -> None:
        """End the thread, when its search is done."""
        self._thread.shutdown(wait=True, cancel_futures=True)
