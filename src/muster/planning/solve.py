"""The function `solve` of the package."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Collection, Mapping
from typing import TYPE_CHECKING, Any, Unpack

from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.texts.near_matches import did_you_mean
from muster.mission.values.keywords import require_known
from muster.planning.custom_objective import best_by
from muster.planning.options import DEFAULT_ALLOCATOR
from muster.planning.request import Request
from muster.planning.solving import OnProgress, answer
from muster.traffic.names import DEFAULT

if TYPE_CHECKING:
    from muster.allocation.algorithms.function_allocator import AllocatingFunction
    from muster.allocation.allocator import Allocator
    from muster.allocation.parameter_types import AllocatorParameters
    from muster.verification import Verdict


def solve(  # noqa: PLR0913  options of planning beside any parameter of the allocator
    mission: Mission,
    allocator: str | Allocator | AllocatingFunction = DEFAULT_ALLOCATOR,
    time_limit: float | None = None,
    seed: int = 0,
    on_progress: OnProgress | None = None,
    *,
    iterations: int | None = None,
    objective: str | Callable[[Verdict], float] | None = None,
    candidates: int = 10,
    ignore: str | Collection[str] = (),
    start: Plan | None = None,
    fixed: Plan | None = None,
    bound: str | None = None,
    rewire: bool = False,
    traffic: str = DEFAULT,
    parameters: Mapping[str, Any] | None = None,
    **own: Unpack[AllocatorParameters],
) -> Plan:
    """Plan a mission; the plan is judged by code that no allocator uses.

    Parameters
    ----------
    allocator
        one of `muster solve --list-allocators`, an allocator, or a function that makes routes.
    time_limit, iterations
        when an anytime allocator stops; 5 s if neither is given. With `iterations` alone the same seed gives the same
        plan.
    objective
        instead of the mission's own; or a function of the judge's `Verdict`, the lower the better, by which several
        plans are ranked. That is slower: no allocator searches by it (see docs/extending.md).
    candidates
        how many plans such a function ranks; they share the time or the iterations.
    ignore
        rules that do not hold: prerequisite, suitability, skill, lock, capacity.
    start
        a plan to go on from.
    fixed
        a plan whose routes stay as the beginnings of the new ones, for planning under way; `search` and `greedy` alone.
    bound
        `quick` or `exact`: prove how good the plan is, as its `lower_bound`.
    rewire
        fill waiting time with later tasks of the same robot: the mission ends sooner, for some usage.
    traffic
        `reserve`: routes spread over the passages for one that robots share, and the plan says how long it takes with
        its traffic; `free`: neither; `auto`: as `reserve` where the mission gives lanes or its map has such passages.
    parameters
        of the allocator by name, for those of functions and of other packages.
    own
        parameters of an allocator that ships, such as `population_size`.

    Raises
    ------
    ParameterError, NotSupportedError
    """
    given = {**(parameters or {}), **own}
    _require_no_misspelt_argument(given)
    request = Request(
        mission=mission,
        allocator=allocator,
        parameters=given,
        objective=None if callable(objective) else objective,
        time_limit=time_limit,
        iterations=iterations,
        seed=seed,
        ignore=tuple(ignore) if not isinstance(ignore, str) else (ignore,),
        start=start,
        fixed=fixed,
        bound=bound,
        rewire=rewire,
        traffic=traffic,
    )
    if callable(objective):
        return best_by(objective, request, candidates, on_progress)
    return answer(request, on_progress=on_progress).plan


def _require_no_misspelt_argument(parameters: Mapping[str, Any]) -> None:
    """Refuse a misspelt argument of `solve`; the allocator refuses parameters that it does not have."""
    from muster.allocation.parameter_types import AllocatorParameters

    for name in parameters:
        if name not in AllocatorParameters.__annotations__ and did_you_mean(name, _ARGUMENTS):
            require_known([name], _ARGUMENTS)


_ARGUMENTS = tuple(name for name in inspect.signature(solve).parameters if name != "own")
