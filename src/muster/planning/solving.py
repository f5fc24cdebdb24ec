"""Answers planning requests with judged plans. Heavy modules are imported where they are used."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

from muster.mission.plan import Plan
from muster.planning.judging import admits, judged
from muster.planning.request import Request
from muster.traffic.names import may_reserve

if TYPE_CHECKING:
    from muster.allocation.allocator import Allocator, Outcome, Routes
    from muster.allocation.bounds.of_objective import Bound
    from muster.allocation.stop import Progress, Stop
    from muster.model.problem import Problem
    from muster.planning.budget import Budget
    from muster.planning.congestion import SharedPassages
    from muster.verification import Verdict

OnProgress = Callable[["Progress"], None]


@dataclass(frozen=True, kw_only=True)
class Solution:
    """The answer to a request.

    Parameters
    ----------
    plan, verdict
        the plan, and what the judge says of it: it is valid.
    why
        why the plan's bound holds, or why it has none; empty where no bound was asked for.
    iterations
        how many the allocator did.
    interrupted
        whether planning was interrupted, so that the plan is the best until then, neither rewired nor bounded.
    """

    plan: Plan
    verdict: Verdict
    why: str = ""
    iterations: int = 0
    interrupted: bool = False


def answer(request: Request, *, on_progress: OnProgress | None = None, interrupt: Stop | None = None) -> Solution:
    """Plan, rewire, bound and judge as a request asks.

    Parameters
    ----------
    on_progress
        called when the best plan improves, and every now and then between.
    interrupt
        its `interrupt()`, from another thread or a signal, ends planning with the best plan so far. The time limit
        counts from when it began.

    Raises
    ------
    ParameterError, NotSupportedError, MissingExtraError
        if the request cannot be met.
    MusterError
        if the judge rejects the plan: an internal error.
    """
    from muster.allocation.allocator import make_parameters
    from muster.allocation.exact.proofs import require_provable
    from muster.allocation.registry import allocator_of
    from muster.allocation.stop import Stop, usual_time_limit
    from muster.planning.budget import Budget, Pace

    whole = interrupt or Stop()
    allocator = allocator_of(request.allocator)
    params = make_parameters(allocator, dict(request.parameters))
    pace = Pace()
    problem = _compiled(request)
    if request.bound is not None:
        require_provable(problem, request.bound)
    limit = usual_time_limit(allocator.anytime, request.time_limit, request.iterations)
    proof_follows = request.bound == "exact" and request.time_limit is not None
    budget = Budget(limit, whole, len(problem.tasks), pace.slowness, proof_follows)
    quick = _quick_bound(request, problem, budget)
    report = None if on_progress is None else _with_bound(request, problem, on_progress, quick)
    shared = _shared_passages(request)
    stop = Stop(
        iterations=request.iterations,
        time_limit=budget.algorithm_s,
        on_progress=report,
        whole=whole,
        first_plan_s=budget.first_plan_s,
    )
    if shared is not None and allocator.anytime:
        plan = _spread(request, allocator, params, problem, shared, stop, report)
    else:
        plan = allocator.solve(problem, stop, seed=request.seed, params=params, start=request.start)
    plan, why = _improved(request, problem, plan, stop, quick, budget)
    if shared is not None and plan.time_without_traffic_s is None and not stop.interrupted:
        plan = shared.told(plan)
    verdict = judged(request.mission, plan, request.ignore, request.objective)
    return Solution(
        plan=plan,
        verdict=verdict,
        why=why,
        iterations=stop.iterations_done,
        interrupted=stop.interrupted,
    )


def _shared_passages(request: Request) -> SharedPassages | None:
    """The passages that robots share; what looks for them is imported where there can be any."""
    if not may_reserve(request.traffic, request.mission):
        return None
    from muster.planning.congestion import SharedPassages

    return SharedPassages.of(request.mission, request.traffic)


def _spread(
    request: Request,
    allocator: Allocator,
    params: Any,
    problem: Problem,
    shared: SharedPassages,
    stop: Stop,
    report: OnProgress | None,
) -> Plan:
    """The plan of an allocator whose routes spread over the passages that robots share."""
    from muster.allocation.allocator import first_routes
    from muster.planning.spreading import spread

    allocator.require_able(problem, request.seed)
    start = first_routes(problem, request.start)

    def allocate(expected: Problem, part: Stop, first: Routes | None) -> Outcome:
        return allocator.outcome(expected, part, request.seed, params, start if first is None else first)

    return spread(problem, shared, allocate, stop, allocator=allocator, seed=request.seed, on_progress=report)


def _compiled(request: Request) -> Problem:
    from muster.allocation.fixed import with_fixed_routes
    from muster.model.problem import Problem

    problem = Problem.compile(request.mission, request.objective, request.ignore)
    return (problem if request.fixed is None else with_fixed_routes(problem, request.fixed)).ready()


def _quick_bound(request: Request, problem: Problem, budget: Budget) -> Bound | None:
    """The quick bound, where one is asked for."""
    from muster.allocation.bounds.of_objective import best_bound
    from muster.allocation.exact.proofs import is_small_enough
    from muster.allocation.stop import Stop

    if request.bound is None or not is_small_enough(problem):
        return None
    return best_bound(problem, Stop(time_limit=budget.bound_s).due)


def _improved(
    request: Request, problem: Problem, plan: Plan, stop: Stop, quick: Bound | None, budget: Budget
) -> tuple[Plan, str]:
    """The plan rewired and with its bound, as far as that is asked for, and why the bound holds or is missing."""
    from muster.allocation.algorithms.rewiring import rewire
    from muster.allocation.exact.proofs import prove

    if request.rewire and not stop.interrupted:
        plan = rewire(problem, plan).plan
    if request.bound is None:
        return plan, ""
    if stop.interrupted:
        return plan, "planning was stopped before a bound was proven"
    proof = prove(problem, plan, request.bound, stop, budget.proof_s, quick, judge=admits)
    return proof.plan, proof.why


def _with_bound(request: Request, problem: Problem, on_progress: OnProgress, quick: Bound | None) -> OnProgress:
    """A function that adds the bound to progress, and the time of an exact proof to its share."""
    from muster.allocation.exact.proofs import EXACT_TIME_LIMIT_S

    bound = math.inf if quick is None else quick.value
    proof_s = (request.time_limit or EXACT_TIME_LIMIT_S) if request.bound == "exact" else 0.0
    all_weight = sum(task.priority for task in problem.tasks)

    def report(progress: Progress) -> None:
        share = progress.share
        if share:
            total_s = progress.elapsed_s / share + proof_s
            share = min(1.0, progress.elapsed_s / total_s) if total_s > 0 else None
        known = math.isfinite(bound) and math.isclose(progress.weight, all_weight)
        on_progress(replace(progress, share=share, bound=bound if known else None))

    return report
