"""An objective of one's own: the best of several plans by a function of the judge's figures.

No allocator searches by such a function. Plans are made for the objectives that allocators know, with different seeds;
each is judged, and the function ranks them. That takes longer than planning once, and finds no plan that none of the
known objectives leads to.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.plan import Plan
from muster.mission.rules import OBJECTIVES
from muster.mission.value_types import shown
from muster.planning.request import Request
from muster.planning.solving import OnProgress, Solution, answer

if TYPE_CHECKING:
    from muster.verification import Verdict

Figure = Callable[["Verdict"], float]
"""A number for a judged plan; the lower, the better."""


def best_by(figure: Figure, request: Request, candidates: int, on_progress: OnProgress | None = None) -> Plan:
    """The plan with the lowest figure, of those that complete the greatest weight of tasks.

    Parameters
    ----------
    figure
        is called with the verdict on each candidate.
    request
        its objective does not count; its time or iterations are shared by the candidates.
    candidates
        how many plans are made: for each objective in turn, with another seed each time.

    Returns
    -------
    The plan with the figures of the mission's own objective; its history is left out.

    Raises
    ------
    ParameterError
        if a figure is no finite number, or a bound is asked for.
    """
    if request.bound is not None:
        raise ParameterError(f"bound: {request.bound}; expected none beside an objective of your own")
    if not isinstance(candidates, int) or candidates < 1:
        raise ParameterError(f"candidates: {shown(candidates)}; expected a whole number of at least 1")
    solutions = [answer(_candidate(request, k, candidates), on_progress=on_progress) for k in range(candidates)]
    best = min(solutions, key=lambda solution: (-solution.verdict.weight_completed, _value(figure, solution)))
    name = request.mission.rules.objective
    elapsed_s = sum(solution.plan.elapsed_s or 0.0 for solution in solutions)
    value = best.verdict.value(name)
    return replace(best.plan, objective=name, objective_value=value, elapsed_s=elapsed_s, history=())


def _candidate(request: Request, k: int, candidates: int) -> Request:
    from muster.allocation.stop import DEFAULT_TIME_LIMIT_S

    time_limit, iterations = request.time_limit, request.iterations
    if time_limit is None and iterations is None:
        time_limit = DEFAULT_TIME_LIMIT_S
    return replace(
        request,
        objective=OBJECTIVES[k % len(OBJECTIVES)],
        seed=request.seed + k,
        time_limit=None if time_limit is None else time_limit / candidates,
        iterations=None if iterations is None else max(1, iterations // candidates),
    )


def _value(figure: Figure, solution: Solution) -> float:
    value = figure(solution.verdict)
    if isinstance(value, bool) or not isinstance(value, int | float) or not math.isfinite(value):
        raise ParameterError(f"objective: returned {shown(value)}; expected a finite number")
    return value
