"""One run of an allocator, judged; and the runs of one case with different seeds."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass
from functools import cache
from statistics import fmean, stdev
from typing import Any

from muster.allocation.allocator import make_parameters
from muster.allocation.registry import allocator_named
from muster.allocation.stop import Stop
from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, Route
from muster.mission.system.clock import ProcessorClock
from muster.model.problem import Problem
from muster.planning.loading import load
from muster.verification import Verdict, verify
from muster_studies.comparison.run import attempt


@dataclass(frozen=True, kw_only=True)
class Case:
    """An allocator with its settings on a mission.

    Without a limit it ends by itself, and does not depend on the seed.
    """

    mission: str
    allocator: str
    ignored: tuple[str, ...] = ()
    objective: str = "total+max"
    iterations: int | None = None
    time_limit: float | None = None
    processor_time: bool = False  # whether the limit, and the times found, are of it
    parameters: tuple[tuple[str, str], ...] = ()

    @property
    def random(self) -> bool:
        return self.iterations is not None or self.time_limit is not None


@dataclass(frozen=True)
class Outcome:
    """One run: the verdict on its plan, the allocator's processor time, and the time at which it found the plan.

    `history` is (seconds, objective) at each improvement.
    """

    case: Case
    seed: int
    verdict: Verdict
    iterations: int
    cpu_s: float
    found_s: float
    history: tuple[tuple[float, float], ...] = ()

    @property
    def value(self) -> float:
        value = self.verdict.value(self.case.objective)
        assert value is not None  # of an admissible plan every objective has a value
        return value

    @property
    def rank(self) -> tuple[float, float]:
        """Lower is better: more tasks first, then the objective."""
        return -self.verdict.weight_completed, self.value


@dataclass(frozen=True)
class Sample:
    """The runs of one case. Not empty."""

    outcomes: tuple[Outcome, ...]

    @property
    def best(self) -> Outcome:
        return min(self.outcomes, key=lambda outcome: outcome.rank)

    @property
    def worst(self) -> Outcome:
        return max(self.outcomes, key=lambda outcome: outcome.rank)

    @property
    def mean(self) -> float:
        return fmean(outcome.value for outcome in self.outcomes)

    @property
    def deviation(self) -> float | None:
        """Standard deviation of a sample; None of a single run."""
        return stdev(outcome.value for outcome in self.outcomes) if len(self.outcomes) > 1 else None

    @property
    def cpu_s(self) -> float:
        return fmean(outcome.cpu_s for outcome in self.outcomes)


@cache
def mission_named(name: str) -> Mission:
    """A shipped mission, read once."""
    return load(name)


def judged(mission: str, ignored: tuple[str, ...], routes: Mapping[str, Any]) -> Verdict:
    """The verdict on routes without stated figures."""
    stated = tuple(Route(robot, tuple(map(str, tasks))) for robot, tasks in routes.items())
    return verify(mission_named(mission), Plan(routes=stated), ignored, "total+max")


def accepted(
    mission: Mission, plan: Plan, whose: str, ignored: Collection[str] = (), objective: str | None = None
) -> Verdict:
    """The verdict on a valid plan; `whose` names the plan in the error.

    Raises
    ------
    MusterError
        if the judge rejects the plan.
    """
    return _valid(verify(mission, plan, ignored, objective), whose)


def _valid(verdict: Verdict, whose: str) -> Verdict:
    if not verdict.valid:
        raise MusterError(f"{whose}: the judge rejects the plan: {rejection(verdict)}")
    return verdict


def rejection(verdict: Verdict) -> str:
    """The first violation of a plan, as text."""
    found = verdict.violations[0]
    place = " ".join(part for part in (found.robot, found.task) if part)
    return f"{found.kind}: {place + ', ' if place else ''}{found.detail}"


def perform(case: Case, seed: int) -> Outcome:
    """Run a case.

    Raises
    ------
    MusterError
        if the judge rejects the plan, which no allocator may make happen.
    """
    mission, allocator = mission_named(case.mission), allocator_named(case.allocator)
    problem = Problem.compile(mission, case.objective, case.ignored).ready()
    clock = ProcessorClock() if case.processor_time else None
    stop = Stop(iterations=case.iterations, time_limit=case.time_limit, clock=clock)
    made = attempt(problem, allocator, stop, seed, make_parameters(allocator, dict(case.parameters)))
    verdict = _valid(made.verdict, f"internal error: {case.allocator} for {case.mission} with seed {seed}")
    return Outcome(case, seed, verdict, stop.iterations_done, made.cpu_s, stop.history[-1][0], tuple(stop.history))
