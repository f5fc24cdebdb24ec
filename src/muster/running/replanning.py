"""How a mission is planned again while it is carried out, by the options with which it was planned."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_of
from muster.allocation.search import SEARCH
from muster.execution import Reallocation, Revision, Standing, travel_of
from muster.execution.replanning.insertion import Insertion
from muster.execution.replanning.reallocation import REPLANNING
from muster.execution.replanning.remaining_problem import RemainingMission
from muster.execution.replanning.travel import Travel
from muster.mission.model import Mission
from muster.planning.options import PlanningOptions
from muster.running.background import BackgroundSearch


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
        search = BackgroundSearch(reallocation_by(options, travel_of(mission), seed), repeatable=repeatable)
        standing = replace(standing, improver=search)
    return Insertion(travel), standing
