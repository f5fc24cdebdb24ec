"""The one way from a planning request to a judged plan. Heavy parts are imported where they are used."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, Unpack

from muster.allocation.parameter_types import AllocatorParameters
from muster.mission.keywords import require_known
from muster.mission.model import Mission
from muster.mission.near_matches import did_you_mean
from muster.mission.plan import Plan
from muster.planning.judging import judged
from muster.planning.options import DEFAULT_ALLOCATOR
from muster.planning.request import Request

if TYPE_CHECKING:
    from muster.allocation.allocator import Allocator
    from muster.allocation.function_allocator import AllocatingFunction
    from muster.allocation.problem import Problem
    from muster.allocation.stop import Progress, Stop
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
        its `interrupt()`, from another thread or a signal, ends planning with the best plan so far.

    Raises
    ------
    ParameterError, NotSupportedError, MissingExtraError
        if the request cannot be met.
    MusterError
        if the judge rejects the plan: an internal error.
    """
    from muster.allocation.allocator import make_parameters
    from muster.allocation.proofs import require_provable
    from muster.allocation.registry import allocator_of
    from muster.allocation.stop import Stop, usual_time_limit

    allocator = allocator_of(request.allocator)
    params = make_parameters(allocator, dict(request.parameters))
    problem = _compiled(request)
    if request.bound is not None:
        require_provable(problem, request.bound)
    limit = usual_time_limit(allocator.anytime, request.time_limit, request.iterations)
    report = None if on_progress is None else _with_bound(request, problem, on_progress)
    stop = Stop(iterations=request.iterations, time_limit=limit, on_progress=report, whole=interrupt)
    plan = allocator.solve(problem, stop, seed=request.seed, params=params, start=request.start)
    plan, why = _improved(request, problem, plan, stop)
    verdict = judged(request.mission, plan, request.ignore, request.objective)
    return Solution(plan=plan, verdict=verdict, why=why, iterations=stop.iterations_done, interrupted=stop.interrupted)


def _compiled(request: Request) -> Problem:
    from muster.allocation.fixed import keeping
    from muster.allocation.problem import Problem

    problem = Problem.compile(request.mission, request.objective, request.ignore)
    return (problem if request.fixed is None else keeping(problem, request.fixed)).ready()


def _improved(request: Request, problem: Problem, plan: Plan, stop: Stop) -> tuple[Plan, str]:
    """The plan rewired and with its bound, as far as that is asked for, and why the bound holds or is missing."""
    from muster.allocation.proofs import prove
    from muster.allocation.rewiring import rewire

    if request.rewire and not stop.interrupted:
        plan = rewire(problem, plan).plan
    if request.bound is None:
        return plan, ""
    if stop.interrupted:
        return plan, "planning was stopped before a bound was proven"
    proof = prove(problem, plan, request.bound, stop, request.time_limit)
    return proof.plan, proof.why


def _with_bound(request: Request, problem: Problem, on_progress: OnProgress) -> OnProgress:
    """What adds the bound that was asked for to progress, and lets its share include the time of an exact proof."""
    from muster.allocation.bounds import lower_bound
    from muster.allocation.proofs import EXACT_TIME_LIMIT_S

    bound = math.inf if request.bound is None else lower_bound(problem)
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


def solve(
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
    )
    if callable(objective):
        from muster.planning.custom_objective import best_by

        return best_by(objective, request, candidates, on_progress)
    return answer(request, on_progress=on_progress).plan


def _require_no_misspelt_argument(parameters: Mapping[str, Any]) -> None:
    """Refuse what looks like an argument of `solve`; what the allocator does not have is refused by the allocator."""
    for name in parameters:
        if name not in AllocatorParameters.__annotations__ and did_you_mean(name, _ARGUMENTS):
            require_known([name], _ARGUMENTS)


_ARGUMENTS = tuple(name for name in inspect.signature(solve).parameters if name != "own")
