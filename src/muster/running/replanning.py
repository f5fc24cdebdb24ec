"""How a mission is planned again while it is carried out, by the options with which it was planned."""

from __future__ import annotations

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_of
from muster.allocation.search import SEARCH
from muster.execution import Reallocation
from muster.execution.reallocation import REPLANNING_HOT
from muster.execution.travel import Travel
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
        parameters = {"hot": REPLANNING_HOT} | parameters
    return Reallocation(
        travel=travel,
        seed=seed,
        allocator=allocator,
        parameters=make_parameters(allocator, parameters),
        fill_waiting=options.rewire,
    )
