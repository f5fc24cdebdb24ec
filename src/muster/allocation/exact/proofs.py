"""The lower bound of a plan's objective: a quick one, or one from an exact solver."""

from __future__ import annotations

from dataclasses import dataclass, replace

from muster import core
from muster.allocation.allocator import Outcome, Routes, finished_plan, routes_of
from muster.allocation.bounds.of_objective import Bound, best_bound, sound_bound
from muster.allocation.exact import require_ortools, solve_exactly
from muster.allocation.search.witness_plans import Judge
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.plan import Plan
from muster.model.problem import Problem

PROOFS = ("quick", "exact")
EXACT_TIME_LIMIT_S = 30.0
MOST_TASKS_EXACT = 40
MOST_PAIRS = 20_000_000
_SOLVER = "OR-Tools CP-SAT (Perron, Didier and Gay, CP 2023)"


@dataclass(frozen=True)
class Proof:
    """A plan with the bound that is proven of it, and why the bound holds, or why there is none."""

    plan: Plan
    why: str


def require_provable(problem: Problem, proof: str) -> None:
    """Check before a long search that the bound can be computed.

    Raises
    ------
    ParameterError
        for another proof than those in PROOFS, or too many tasks.
    MissingExtraError
        if `exact` is asked for and OR-Tools is not installed.
    """
    if proof not in PROOFS:
        raise ParameterError(f"bound: {proof}; expected {' or '.join(PROOFS)}")
    if proof == "exact":
        if len(problem.tasks) > MOST_TASKS_EXACT:
            raise ParameterError(f"bound: exact, of {len(problem.tasks)} tasks; expected at most {MOST_TASKS_EXACT}")
        require_ortools()


def is_small_enough(problem: Problem) -> bool:
    """Whether quick bounds are worked out for a problem: they need tables of all pairs of robot and task."""
    return len(problem.robots) * len(problem.tasks) <= MOST_PAIRS


def prove(
    problem: Problem,
    plan: Plan,
    proof: str,
    stop: Stop,
    time_limit: float | None = None,
    quick: Bound | None = None,
    *,
    judge: Judge,
) -> Proof:
    """Bound the objective of a plan; an exact solver may find a better plan on the way.

    Parameters
    ----------
    proof
        `quick`: arguments that hold for plans that do all tasks, and nothing for others; `exact`: OR-Tools, up to some
        15 tasks and 5 robots, for `time_limit` seconds (30 by default).
    stop
        of the run that made the plan.
    quick
        the quick bound, where it is known already.
    judge
        whether a plan is admissible, some rules ignored.

    Raises
    ------
    ParameterError, MissingExtraError
        as `require_provable`.
    MusterError
        if a bound is above the value of a plan: an internal error.
    """
    require_provable(problem, proof)
    return _quick(problem, plan, quick) if proof == "quick" else _exact(problem, plan, stop, time_limit, judge)


def _quick(problem: Problem, plan: Plan, known: Bound | None) -> Proof:
    value = plan.objective_value
    if not plan.complete or value is None:
        return Proof(plan, "quick bounds are of plans that do all tasks, and this one leaves some out")
    if not is_small_enough(problem):
        return Proof(
            plan, f"quick bounds are of at most {MOST_PAIRS:,} pairs of robot and task, and this mission has more"
        )
    bound = known or best_bound(problem)
    return Proof(replace(plan, lower_bound=sound_bound(bound.value, value, bound.why)), bound.why)


def _exact(problem: Problem, plan: Plan, stop: Stop, time_limit: float | None, judge: Judge) -> Proof:
    seconds = EXACT_TIME_LIMIT_S if time_limit is None else time_limit
    start = routes_of(problem, plan)
    result = solve_exactly(problem, seconds, start, plan.seed or 0, interrupted=lambda: stop.interrupted, judge=judge)
    weight, objective = problem.value(result.routes)
    found, known = (-weight, objective), (-(plan.weight_completed or 0.0), plan.objective_value or 0.0)
    if found < known or (found == known and _is_cheaper(problem, result.routes, plan)):
        stop.improved(weight, objective)
        outcome = Outcome(result.routes)
        plan = finished_plan(problem, stop, outcome, allocator=f"{plan.allocator}, exact", seed=plan.seed or 0)
    if result.optimal:
        why = f"{_SOLVER} and quick bounds leave no room for a better plan"
    elif result.lower_bound is not None:
        why = f"what {_SOLVER} and quick bounds had ruled out after {seconds:g} s"
    else:
        why = f"whether more tasks can be done is not known after {seconds:g} s of {_SOLVER}"
    cut_short = plan.cut_short and not result.optimal
    return Proof(replace(plan, lower_bound=result.lower_bound, cut_short=cut_short), why)


def _is_cheaper(problem: Problem, routes: Routes, plan: Plan) -> bool:
    """Whether routes have the lower total cost, which is what breaks ties of lateness."""
    cost = sum(core.Inspection(problem.core, routes).usages)
    return problem.objective == "lateness" and plan.total_cost is not None and cost < plan.total_cost
