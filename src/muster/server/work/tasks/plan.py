"""Planning a mission, with progress."""

from __future__ import annotations

import math
import os
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from muster.allocation.allocator import make_parameters
from muster.allocation.bounds import lower_bound
from muster.allocation.problem import Problem
from muster.allocation.proofs import EXACT_TIME_LIMIT_S, Proof, prove, require_provable
from muster.allocation.registry import allocator_named
from muster.allocation.stop import Progress, Stop, usual_time_limit
from muster.mission.errors import MusterError, ParameterError
from muster.mission.plan import Plan
from muster.planning.planning import DEFAULT_ALLOCATOR
from muster.server.work.missions import mission_of, plan_of
from muster.verification import verify

_MOST_POINTS = 200  # of the history that progress shows
_AT_MOST_EVERY_S = 0.1

Report = Callable[[dict[str, Any]], None]


def run(arguments: Mapping[str, Any], report: Report, whole: Stop) -> dict[str, Any]:
    """`{"mission", ...}` -> `{"plan", "why"}`: the plan as its file holds it, and why its bound holds or is missing.

    Beside the mission what `muster solve` takes: `allocator`, `objective`, `time_limit` (s), `iterations`, `seed`,
    `ignore`, `bound` (quick, exact), `start` (a plan), `parameters` (of the allocator, by name).
    Every plan is judged before it is given. When `whole` is interrupted the search ends with its best plan, or with its
    first; a proof is then left out.
    """
    mission = mission_of(arguments["mission"])
    given = {name: value for name, value in arguments.items() if value is not None}
    chosen = allocator_named(given.get("allocator", DEFAULT_ALLOCATOR))
    parameters = given.get("parameters", {})
    _require_modest(parameters)
    params = make_parameters(chosen, parameters)
    start = plan_of(given["start"], "start") if "start" in given else None
    problem = Problem.compile(mission, given.get("objective"), given.get("ignore", ())).ready()
    bound, time_limit, iterations = given.get("bound"), given.get("time_limit"), given.get("iterations")
    if bound is not None:
        require_provable(problem, bound)
    limit = usual_time_limit(chosen.anytime, time_limit, iterations)
    watch = _Watch(problem, report, bound, (time_limit or EXACT_TIME_LIMIT_S) if bound == "exact" else 0.0)
    stop = Stop(iterations=iterations, time_limit=limit, on_progress=watch, whole=whole)
    watch.stop = stop
    plan = chosen.solve(problem, stop, seed=given.get("seed", 0), params=params, start=start)
    if bound is None or stop.interrupted:
        proof = Proof(plan, "" if bound is None else "planning was stopped before a bound was proven")
    else:
        proof = prove(problem, plan, bound, stop, time_limit)
    _require_valid(problem, proof.plan)
    return {"plan": proof.plan.as_dict(), "why": proof.why}


def _require_modest(parameters: Mapping[str, Any]) -> None:
    """Refuse what would take more than this machine has for one plan, or go on in other machines."""
    if parameters.get("ray", "none") != "none":
        raise ParameterError("ray: given; expected no cluster of a plan that a server makes")
    threads, most = parameters.get("threads", 1), os.cpu_count() or 1
    if isinstance(threads, int) and threads > most:
        raise ParameterError(f"threads: {threads}; expected at most {most}, the processors of this server")


def _require_valid(problem: Problem, plan: Plan) -> None:
    verdict = verify(problem.mission, plan, problem.ignored, problem.objective)
    if not verdict.valid:
        details = "; ".join(f"{v.kind} {v.detail}" for v in verdict.violations[:3])
        raise MusterError(f"internal error: the judge rejects the plan of {plan.allocator}: {details}")


class _Watch:
    """Reports progress, at most so often; a bound is worked out first, to be seen beside the objective."""

    stop: Stop

    def __init__(self, problem: Problem, report: Report, bound: str | None, proof_s: float) -> None:
        self._report = report
        self._whole = sum(task.priority for task in problem.tasks)
        value = math.inf if bound is None else lower_bound(problem)
        self._bound = value if math.isfinite(value) else None
        self._proof_s = proof_s
        self._reported = -math.inf

    def __call__(self, progress: Progress) -> None:
        if progress.elapsed_s < self._reported + _AT_MOST_EVERY_S:
            return
        self._reported = progress.elapsed_s
        complete = math.isclose(progress.weight, self._whole)
        self._report(
            {
                "elapsed_s": progress.elapsed_s,
                "share": self._share(progress),
                "weight": progress.weight,
                "objective": progress.objective if math.isfinite(progress.objective) else None,
                "bound": self._bound if complete else None,
                "history": thinned(self.stop.history),
            }
        )

    def _share(self, progress: Progress) -> float | None:
        """How much of all is done, the proof after the search included; None where nobody knows."""
        share = self.stop.share
        if not share:
            return None
        whole = progress.elapsed_s / share + self._proof_s
        return min(1.0, progress.elapsed_s / whole) if whole > 0 else None


def thinned(history: Sequence[tuple[float, float]]) -> list[tuple[float, float]]:
    """At most so many points of a history, the last among them."""
    step = -(-len(history) // _MOST_POINTS)
    return list(history[::-1][:: step or 1][::-1])
