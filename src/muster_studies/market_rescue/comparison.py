"""The richer shipped mission, market-rescue-20: the market beside other allocators, and beside the best known plan."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster_studies.effort import Effort
from muster_studies.runs import Case, Sample, judged, mission_named
from muster_studies.tables import Cell, Table, row

MISSION = "market-rescue-20"

BEST_KNOWN = {
    "handBot1": (15, 20, 12),
    "handBot2": (18, 6, 16, 10),
    "eyeBot1": (14, 1, 11, 17),
    "eyeBot2": (5, 8, 3, 19, 13),
    "rangeBot": (2, 4, 7, 9),
}
"""The survivors of each robot in the best plan that is known; whether a better one exists is not."""

_MARKET_ITERATIONS = (100, 1000, 5000)
_PER_MARKET_ITERATION = 20
"""Iterations of the genetic allocators that take about as long as one of the market."""
_SAME_S = 1e-6


def best_known_s() -> float:
    """The greatest usage in the best known plan, by the judge."""
    return judged(
        MISSION, (), {robot: [f"survivor{k}" for k in tasks] for robot, tasks in BEST_KNOWN.items()}
    ).max_usage


@dataclass(frozen=True)
class Comparison:
    """A row for the best known plan, then one for each allocator and number of iterations."""

    number: str = MISSION
    columns: tuple[str, ...] = (
        "allocator",
        "iterations",
        "done",
        "best",
        "mean",
        "worst",
        "best +%",
        "mean +%",
        "s",
        "reached",
    )

    def jobs(self, effort: Effort) -> Iterator[Case]:
        budgets = _budgets(effort)
        yield _case("greedy", None)
        yield _case("auction", None)
        for iterations in budgets:
            yield _case("market", iterations)
        for allocator in ("greedy+genetic", "genetic"):
            for iterations in budgets:
                yield _case(allocator, iterations * _factor(effort))

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        known = best_known_s()
        tasks = len(mission_named(MISSION).tasks)
        rows = [
            row(self.columns, {"allocator": "best known", "done": tasks, "best": known}),
            *(row(self.columns, _cells(samples[case], known)) for case in self.jobs(effort)),
        ]
        title = "5 robots, 20 survivors: seconds of the robot that takes longest"
        return Table(self.number, title, self.columns, tuple(rows), _notes(effort))


def _budgets(effort: Effort) -> tuple[int, ...]:
    if effort.iterations is not None:
        return (effort.iterations,)
    return _MARKET_ITERATIONS[:1] if effort.quick else _MARKET_ITERATIONS


def _factor(effort: Effort) -> int:
    """How many iterations the genetic allocators have for one of the market."""
    return 1 if effort.iterations is not None else _PER_MARKET_ITERATION


def _notes(effort: Effort) -> tuple[str, ...]:
    equal = "iterations" if _factor(effort) == 1 else "processor time"
    return (
        "The mission is not the paper's: it is made here after the paper's scenario, with skills that overlap.",
        f"The genetic allocators have about the {equal} of the market. The auction's bid is max, with insertion.",
        "best +%, mean +%: above the best plan that is known. reached n/m: n of m runs come to it.",
    )


def _case(allocator: str, iterations: int | None) -> Case:
    return Case(mission=MISSION, allocator=allocator, objective="max", iterations=iterations)


def _cells(sample: Sample, known: float) -> dict[str, Cell]:
    best, worst = sample.best, sample.worst
    cells: dict[str, Cell] = {
        "allocator": best.case.allocator,
        "iterations": best.case.iterations,
        "done": worst.verdict.tasks_completed,
        "best": best.value,
        "best +%": _gap(best.value, known),
        "s": sample.cpu_s,
        "reached": _reached(sample, known),
    }
    if best.case.random:
        cells |= {"mean": sample.mean, "worst": worst.value, "mean +%": _gap(sample.mean, known)}
    return cells


def _gap(value: float, known: float) -> float:
    return 100 * (value / known - 1)


def _reached(sample: Sample, known: float) -> str:
    runs = sum(outcome.value <= known + _SAME_S for outcome in sample.outcomes)
    return f"{runs}/{len(sample.outcomes)}"
