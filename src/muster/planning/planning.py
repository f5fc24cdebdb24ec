"""Plans a mission and judges plans. Heavy parts are imported where they are used."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.value_types import shown

if TYPE_CHECKING:
    from muster.allocation.stop import Progress
    from muster.verification import Verdict


DEFAULT_ALLOCATOR = "search"


def solve(
    mission: Mission,
    allocator: str = DEFAULT_ALLOCATOR,
    time_limit: float | None = None,
    seed: int = 0,
    on_progress: Callable[[Progress], None] | None = None,
    *,
    iterations: int | None = None,
    objective: str | None = None,
    ignore: str | Collection[str] = (),
    start: Plan | None = None,
    fixed: Plan | None = None,
    bound: str | None = None,
    **parameters: Any,
) -> Plan:
    """Plan a mission.

    Parameters
    ----------
    allocator
        one of `muster solve --list-allocators`.
    time_limit, iterations
        when an anytime allocator stops; 5 s if neither is given. With `iterations` alone the same seed gives the same
        plan.
    objective
        instead of the mission's own.
    ignore
        rules that do not hold: prerequisite, suitability, skill, lock, capacity.
    start
        a plan to go on from.
    fixed
        a plan whose routes the routes begin with, for planning anew under way; `search` and `greedy` alone.
    bound
        `quick` or `exact`: prove how good the plan is, as its `lower_bound`.
    parameters
        of the allocator, such as `population_size`.

    Raises
    ------
    ParameterError, NotSupportedError
    """
    from muster.allocation.allocator import make_parameters
    from muster.allocation.fixed import keeping
    from muster.allocation.problem import Problem
    from muster.allocation.proofs import prove, require_provable
    from muster.allocation.registry import allocator_named
    from muster.allocation.stop import Stop, usual_time_limit

    require_mission(mission)
    chosen = allocator_named(allocator)
    params = make_parameters(chosen, parameters)
    problem = Problem.compile(mission, objective, ignore)
    problem = (problem if fixed is None else keeping(problem, fixed)).ready()
    if bound is not None:
        require_provable(problem, bound)
    limit = usual_time_limit(chosen.anytime, time_limit, iterations)
    stop = Stop(iterations=iterations, time_limit=limit, on_progress=on_progress)
    plan = chosen.solve(problem, stop, seed=seed, params=params, start=start)
    return plan if bound is None else prove(problem, plan, bound, stop, time_limit).plan


def verify(mission: Mission, plan: Plan, ignore: str | Collection[str] = (), objective: str | None = None) -> Verdict:
    """Judge a plan from scratch, by code that no allocator uses.

    Parameters
    ----------
    ignore
        rules that do not hold, as for `solve`. What the plan says of itself in `ignored` has no effect.
    objective
        the one that the plan was to minimise; the mission's by default.

    Raises
    ------
    ParameterError, NotSupportedError
    """
    from muster.verification import verify as judge

    require_mission(mission)
    return judge(mission, plan, ignore, objective)


def require_mission(mission: object) -> None:
    if not isinstance(mission, Mission):
        raise ParameterError(
            f"mission: {shown(mission)}; expected a Mission: muster.load makes one from a file or name"
        )


def plot(mission: Mission, plan: Plan, *, ax: Any = None) -> Any:
    """Draw a plan's routes; returns the matplotlib Axes (`ax`, if given). Needs the extra `plot`."""
    from muster.report import plot_routes

    return plot_routes(mission, plan, verify(mission, plan, plan.ignored, plan.objective), ax=ax)
