"""How near the search comes to the best plans known, in a second or so: medians over seeds, values from the judge."""

from __future__ import annotations

import statistics
from dataclasses import dataclass
from importlib.resources import files

import msgspec

from muster.allocation.registry import ALLOCATORS
from muster.allocation.stop import Stop
from muster.mission.model import Mission
from muster.model.problem import Problem
from muster.planning.loading import load
from muster.verification import Verdict
from muster_studies.benches.measurement import Measurement
from muster_studies.runs import accepted

_WITHIN = 1e-4  # of the best known value: 0.01 %


@dataclass(frozen=True)
class Case:
    """A mission, the objective value of the best known plan, and the time limit in seconds.

    `weight` is that of the tasks which the best known plan does; None: all can be done.
    """

    mission: str
    objective: str
    best: float
    seconds: float
    ignored: tuple[str, ...] = ()
    salesmen: int | None = None
    weight: float | None = None

    @property
    def name(self) -> str:
        salesmen = f", {self.salesmen} salesmen" if self.salesmen else ""
        ignored = f", without {' and '.join(self.ignored)}" if self.ignored else ""
        return f"{self.mission}{salesmen}, {self.objective}{ignored}, {self.seconds:g} s"

    def load(self) -> Mission:
        return load(self.mission, salesmen=self.salesmen) if self.salesmen else load(self.mission)


_FILE = files("muster_studies.benches") / "best_known.yaml"
CASES: tuple[Case, ...] = msgspec.yaml.decode(_FILE.read_bytes(), type=tuple[Case, ...])


@dataclass(frozen=True)
class Quality:
    """Objective values of one case, a seed each; inf for a plan that leaves out more than the best known one."""

    case: Case
    values: tuple[float, ...]

    @property
    def gaps(self) -> list[float]:
        """Per cent above the best value known."""
        return [100 * (value / self.case.best - 1) for value in self.values]

    @property
    def reached(self) -> int:
        """How many seeds came within 0.01 % of it."""
        return sum(value <= self.case.best * (1 + _WITHIN) for value in self.values)

    @property
    def median(self) -> float:
        return statistics.median(self.values)


def quality(case: Case, seeds: int, iterations: int | None = None) -> Quality:
    """Search with seeds 0, 1, ... for the case's time, or for so many iterations.

    Raises
    ------
    MusterError
        if the judge rejects a plan.
    """
    problem = Problem.compile(case.load(), case.objective, case.ignored).ready()
    return Quality(case, tuple(_value(problem, case, seed, iterations) for seed in range(seeds)))


def _value(problem: Problem, case: Case, seed: int, iterations: int | None) -> float:
    stop = Stop(time_limit=case.seconds) if iterations is None else Stop(iterations=iterations)
    plan = ALLOCATORS["search"].solve(problem, stop, seed=seed)
    verdict = accepted(problem.mission, plan, f"{case.name}, seed {seed}", problem.ignored, problem.objective)
    value = verdict.value(case.objective)
    return value if value is not None and _does_enough(case, verdict) else float("inf")


def _does_enough(case: Case, verdict: Verdict) -> bool:
    if case.weight is None:
        return verdict.tasks_completed == verdict.tasks_total
    return verdict.weight_completed >= case.weight


def search_quality(runs: int) -> list[Measurement]:
    """The search on missions whose best plans are known; a seed a run."""
    return [_above_best(quality(case, runs)) for case in CASES]


def _above_best(found: Quality) -> Measurement:
    note = (
        f"median {found.median:.4f}, best known {found.case.best:.4f}, reached by {found.reached} of {len(found.gaps)}"
    )
    return Measurement.over_runs(f"search, {found.case.name}", "% above best known", found.gaps, "<= 0.01", note)
