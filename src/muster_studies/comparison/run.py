"""One run of an allocator on a mission: made, judged, and told as a row of results."""

from __future__ import annotations

import time
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from muster.mission.system.clock import ProcessorClock
from muster.verification import Verdict, verify

if TYPE_CHECKING:
    from muster.allocation.allocator import Allocator
    from muster.allocation.stop import Stop
    from muster.mission.plan import Plan
    from muster.model.problem import Problem
    from muster_studies.comparison.settings import Settings

DONE, NOT_APPLICABLE, FAILED, INVALID = STATUSES = "done", "not-applicable", "failed", "invalid"


@dataclass(frozen=True, kw_only=True)
class Run:
    """A row of results. All figures of plans are the judge's.

    Parameters
    ----------
    mission, allocator, seed
        which run it is.
    status
        `done`; `not-applicable`: the allocator does not keep a rule of the mission; `failed`: it raised an error, was
        given up or lost its process; `invalid`: the judge rejects its plan.
    reason
        why it is not done.
    objective, value
        the objective's name, and its value in the mission's unit.
    weight_completed, weight_total, tasks_completed, tasks_total
        priorities and numbers of tasks done and of all tasks.
    total_cost, max_usage, makespan_s
        of the plan.
    elapsed_s, found_s
        seconds until the allocator had ended, and until it had found the plan, by the comparison's clock.
    cpu_s
        processor time of the whole run.
    iterations
        done.
    cut_short
        whether the time limit ended the allocator before it had come to all tasks, and some are left out.
    parameters, time_limit_s, iteration_limit, clock, digest
        what was asked for, and which mission it was: what must agree where a comparison goes on.
    """

    mission: str
    allocator: str
    seed: int
    status: str = DONE
    reason: str = ""
    objective: str = ""
    value: float | None = None
    weight_completed: float | None = None
    weight_total: float | None = None
    tasks_completed: int | None = None
    tasks_total: int | None = None
    total_cost: float | None = None
    max_usage: float | None = None
    makespan_s: float | None = None
    elapsed_s: float | None = None
    found_s: float | None = None
    cpu_s: float | None = None
    iterations: int | None = None
    cut_short: bool = False
    parameters: str = ""
    time_limit_s: float | None = None
    iteration_limit: int | None = None
    clock: str = ""
    digest: str = ""

    @property
    def is_done(self) -> bool:
        """Whether it has a plan that counts."""
        return self.status == DONE

    @property
    def rank(self) -> tuple[float, float]:
        """Lower is better: more weight completed first, then the objective; infinite without a plan."""
        if self.weight_completed is None or self.value is None or not self.is_done:
            return float("inf"), float("inf")
        return -self.weight_completed, self.value


@dataclass(frozen=True)
class Attempt:
    """What came of one call of an allocator: the plan, the judge's verdict, and the processor time it took."""

    plan: Plan
    verdict: Verdict
    cpu_s: float


def attempt(problem: Problem, allocator: Allocator, stop: Stop, seed: int, params: Any) -> Attempt:
    """Let an allocator plan, and have the plan judged; it may be invalid."""
    begin = time.process_time()
    plan = allocator.solve(problem, stop, seed=seed, params=params)
    cpu_s = time.process_time() - begin
    return Attempt(plan, verify(problem.mission, plan, problem.ignored, problem.objective), cpu_s)


def stop_of(settings: Settings, allocator: Allocator) -> Stop:
    """The stopping rule of a run."""
    from muster.allocation.stop import Stop

    clock = ProcessorClock() if settings.clock == "processor" else None
    return Stop(iterations=settings.iterations, time_limit=settings.time_limit, clock=clock)


def figures(made: Attempt, problem: Problem, stop: Stop) -> dict[str, Any]:
    """The figures of a row: those of the plan as the judge has them."""
    verdict = made.verdict
    if not verdict.valid:
        return {"status": INVALID, "reason": verdict.first_violations, "cpu_s": made.cpu_s}
    return {
        "value": verdict.value(problem.objective),
        "weight_completed": verdict.weight_completed,
        "weight_total": sum(task.priority for task in problem.mission.tasks),
        "tasks_completed": verdict.tasks_completed,
        "tasks_total": verdict.tasks_total,
        "total_cost": verdict.total_cost,
        "max_usage": verdict.max_usage,
        "makespan_s": verdict.makespan_s,
        "elapsed_s": made.plan.elapsed_s,
        "found_s": stop.history[-1][0] if stop.history else None,
        "cpu_s": made.cpu_s,
        "iterations": stop.iterations_done,
        "cut_short": made.plan.cut_short,
    }
