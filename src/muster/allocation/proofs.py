"""What can be proven of a plan: a lower bound of its objective, at once or by an exact solver."""

from __future__ import annotations

from dataclasses import replace

from muster.allocation.allocator import Outcome, finished_plan, routes_of
from muster.allocation.bounds import lower_bound
from muster.allocation.problem import Problem
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan

PROOFS = ("quick", "exact")
EXACT_TIME_LIMIT_S = 30.0
MOST_TASKS_EXACT = 40


def with_bound(problem: Problem, plan: Plan, proof: str, stop: Stop, time_limit: float | None = None) -> Plan:
    """The plan with the bound that is proven of it; an exact solver may find a better plan on the way.

    Parameters
    ----------
    proof
        `quick`: arguments that hold for plans that do all tasks, and nothing for others; `exact`: OR-Tools, up to some
        15 tasks and 5 robots, for `time_limit` seconds (30 by default).
    stop
        of the run that made the plan.

    Raises
    ------
    ParameterError
        for another proof.
    MissingExtraError
        if `exact` is asked for and OR-Tools is not installed.
    """
    if proof not in PROOFS:
        raise ParameterError(f"bound: {proof}; expected {' or '.join(PROOFS)}")
    if proof == "quick":
        value = plan.objective_value
        bounded = plan.complete and value is not None
        return replace(plan, lower_bound=min(lower_bound(problem), value or 0.0)) if bounded else plan
    if len(problem.tasks) > MOST_TASKS_EXACT:
        raise ParameterError(f"bound: exact, of {len(problem.tasks)} tasks; expected at most {MOST_TASKS_EXACT}")
    from muster.allocation.exact import solve_exactly

    result = solve_exactly(problem, time_limit or EXACT_TIME_LIMIT_S, routes_of(problem, plan), plan.seed or 0)
    weight, objective = problem.value(result.routes)
    if (-weight, objective) < (-(plan.weight_completed or 0.0), plan.objective_value or 0.0):
        stop.improved(weight, objective)
        outcome = Outcome(result.routes)
        plan = finished_plan(problem, stop, outcome, allocator=f"{plan.allocator}, exact", seed=plan.seed or 0)
    return replace(plan, lower_bound=result.lower_bound)
