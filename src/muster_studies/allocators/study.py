"""The study: one table for each mission, and one that sums them up."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from statistics import fmean

from muster.allocation.registry import ALLOCATORS
from muster.library import mission_names, mission_path
from muster.mission.model import OBJECTIVES
from muster_studies.effort import Effort
from muster_studies.processes import run_cases
from muster_studies.runs import Case, Outcome, Sample, mission_named
from muster_studies.tables import Cell, Report, Table

SECONDS, QUICK_SECONDS = 0.25, 0.05
SUMMARY = "summary"
_COLUMNS = ("allocator", *OBJECTIVES, "s")

# TSPLIB instances ship with numbers of salesmen as missions of their own.
MISSIONS = tuple(name for name in mission_names() if str(mission_path(name)).endswith(".yaml"))

Samples = Mapping[Case, Sample]


class Allocators:
    """Every allocator against every other, on everything that ships."""

    name = "allocators"
    summary = "all allocators on all shipped missions and objectives"
    tables = (SUMMARY, *MISSIONS)

    def run(self, effort: Effort, workers: int = 1, on_done: Callable[[int, int], None] | None = None) -> Report:
        """Run all, or those on the missions that `effort` names as tables; `summary` sums up what is run.

        Raises
        ------
        ParameterError
            if there is no such table.
        """
        missions = tuple(name for name in effort.wanted(self.tables) if name != SUMMARY) or MISSIONS
        seeds = effort.seeds or 1
        cases = [case for name in missions for case in _cases(name, effort).values()]
        samples = run_cases(cases, seeds, workers, on_done)
        outcomes = [outcome for sample in samples.values() for outcome in sample.outcomes]
        tables = [_summary(missions, effort, samples), *(_table(name, effort, samples) for name in missions)]
        return Report(
            study=self.name,
            document="all shipped missions",
            seeds=seeds,
            runs=len(outcomes),
            cpu_s=sum(outcome.cpu_s for outcome in outcomes),
            legend=(
                "Values of each objective by muster.verify, lower is better; (n): only n tasks are done, and more "
                "tasks come before a lower value. Of several seeds the best counts.",
                f"Anytime allocators have {_limit(effort)} for each plan. s: when the plan was found, the mean over "
                "the objectives.",
            ),
            tables=tuple(tables),
        )


def _limit(effort: Effort) -> str:
    if effort.iterations is not None:
        return f"{effort.iterations} iterations"
    return f"{QUICK_SECONDS if effort.quick else SECONDS:g} s"


def _cases(mission: str, effort: Effort) -> dict[tuple[str, str], Case]:
    """The cases of one mission by allocator and objective."""
    seconds = QUICK_SECONDS if effort.quick else SECONDS
    return {
        (allocator.name, objective): Case(
            mission=mission,
            allocator=allocator.name,
            objective=objective,
            iterations=effort.iterations if allocator.anytime else None,
            time_limit=seconds if allocator.anytime and effort.iterations is None else None,
        )
        for allocator in ALLOCATORS.values()
        for objective in OBJECTIVES
    }


def _table(mission: str, effort: Effort, samples: Samples) -> Table:
    cases = _cases(mission, effort)
    rows = []
    for allocator in ALLOCATORS:
        best = [samples[cases[allocator, objective]].best for objective in OBJECTIVES]
        rows.append((allocator, *map(_cell, best), fmean(outcome.found_s for outcome in best)))
    loaded = mission_named(mission)
    title = f"{len(loaded.tasks)} tasks, {len(loaded.robots)} robots; own objective {loaded.rules.objective}"
    return Table(mission, title, _COLUMNS, tuple(rows))


def _cell(outcome: Outcome) -> Cell:
    verdict = outcome.verdict
    if verdict.tasks_completed == verdict.tasks_total:
        return outcome.value
    return f"{outcome.value:.2f} ({verdict.tasks_completed})"


def _summary(missions: tuple[str, ...], effort: Effort, samples: Samples) -> Table:
    """Mean excess over the best value that any allocator found, in per cent, where as many tasks are done as there."""
    rows: list[tuple[Cell, ...]] = []
    for allocator in ALLOCATORS:
        cells: list[Cell] = [allocator]
        seconds, fewer = [], 0
        for objective in OBJECTIVES:
            excesses = []
            for mission in missions:
                cases = _cases(mission, effort)
                found = samples[cases[allocator, objective]].best
                seconds.append(found.found_s)
                best = min((samples[cases[other, objective]].best for other in ALLOCATORS), key=lambda o: o.rank)
                if found.verdict.weight_completed < best.verdict.weight_completed:
                    fewer += 1
                elif best.value > 0:
                    excesses.append(100 * (found.value / best.value - 1))
            cells.append(fmean(excesses) if excesses else None)
        rows.append((*cells, fewer, fmean(seconds)))
    columns = ("allocator", *OBJECTIVES, "fewer tasks", "s")
    notes = (
        f"Per cent above the best value found, the mean over {len(missions)} missions. fewer tasks: of the "
        f"{len(missions) * len(OBJECTIVES)} plans, those that do less than the best; they do not count in the means.",
    )
    return Table(SUMMARY, "Mean excess over the best plan found [%]", columns, tuple(rows), notes)
