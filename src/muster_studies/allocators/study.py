"""The study: one table for each mission, and one that sums them up."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from statistics import fmean

from muster.allocation.registry import ALLOCATORS
from muster.library import mission_names, mission_path
from muster.mission.model import OBJECTIVES as ALL_OBJECTIVES
from muster_studies.descriptions import description
from muster_studies.effort import Effort
from muster_studies.repetition import Repetition, over_seeds
from muster_studies.runs import Case, Outcome, Sample, mission_named
from muster_studies.tables import Cell, Table

SECONDS, QUICK_SECONDS = 0.25, 0.05
SUMMARY = "summary"
OBJECTIVES = tuple(name for name in ALL_OBJECTIVES if name != "lateness")  # which asks for due times
_COLUMNS = ("allocator", *OBJECTIVES, "s")

# TSPLIB instances ship with numbers of salesmen as missions of their own.
_TIMED = ("collapsed-building", "warehouse")  # which only some of the allocators can plan
MISSIONS = tuple(n for n in mission_names() if str(mission_path(n)).endswith(".yaml") and n not in _TIMED)

Samples = Mapping[Case, Sample]


def _missions(effort: Effort) -> tuple[str, ...]:
    """The missions whose tables are to be made; all missions for the summary alone."""
    return tuple(name for name in effort.tables if name != SUMMARY) or MISSIONS


@dataclass(frozen=True)
class MissionTable:
    """The value of each objective that each allocator comes to on a mission."""

    number: str

    def jobs(self, effort: Effort) -> Iterable[Case]:
        return _cases(self.number, effort).values()

    def table(self, effort: Effort, found: Samples) -> Table:
        cases = _cases(self.number, effort)
        rows = []
        for allocator in ALLOCATORS.shipped:
            best = [found[cases[allocator, objective]].best for objective in OBJECTIVES]
            rows.append((allocator, *map(_cell, best), fmean(outcome.found_s for outcome in best)))
        loaded = mission_named(self.number)
        title = f"{len(loaded.tasks)} tasks, {len(loaded.robots)} robots; own objective {loaded.rules.objective}"
        return Table(self.number, title, _COLUMNS, tuple(rows))


@dataclass(frozen=True)
class Summary:
    """How far each allocator is from the best value found, over all missions whose tables are made."""

    number: str = SUMMARY

    def jobs(self, effort: Effort) -> Iterable[Case]:
        return [case for mission in _missions(effort) for case in _cases(mission, effort).values()]

    def table(self, effort: Effort, found: Samples) -> Table:
        return _summary(_missions(effort), effort, found)


def _limit(effort: Effort) -> str:
    if effort.iterations is not None:
        return f"{effort.iterations} iterations"
    return f"{QUICK_SECONDS if effort.quick else SECONDS:g} s of processor time"


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
            processor_time=True,
        )
        for allocator in map(ALLOCATORS.__getitem__, ALLOCATORS.shipped)
        for objective in OBJECTIVES
    }


def _cell(outcome: Outcome) -> Cell:
    verdict = outcome.verdict
    tasks, weight = verdict.tasks_completed, verdict.weight_completed
    if tasks == verdict.tasks_total:
        return outcome.value
    return f"{outcome.value:.2f} ({tasks})" if weight == tasks else f"{outcome.value:.2f} ({tasks}; {weight:g})"


def _summary(missions: tuple[str, ...], effort: Effort, samples: Samples) -> Table:
    """Mean excess over the best value that any allocator found, in per cent, where as many tasks are done as there."""
    rows: list[tuple[Cell, ...]] = []
    for allocator in ALLOCATORS.shipped:
        cells: list[Cell] = [allocator]
        seconds, fewer = [], 0
        for objective in OBJECTIVES:
            excesses = []
            for mission in missions:
                cases = _cases(mission, effort)
                found = samples[cases[allocator, objective]].best
                seconds.append(found.found_s)
                best = min(
                    (samples[cases[other, objective]].best for other in ALLOCATORS.shipped), key=lambda o: o.rank
                )
                if found.verdict.weight_completed < best.verdict.weight_completed:
                    fewer += 1
                elif best.value > 0:
                    excesses.append(100 * (found.value / best.value - 1))
            cells.append(fmean(excesses) if excesses else None)
        rows.append((*cells, fewer, fmean(seconds)))
    columns = ("allocator", *OBJECTIVES, "less done", "s")
    notes = (
        f"Per cent above the best value found, the mean over {len(missions)} missions. less done: of the "
        f"{len(missions) * len(OBJECTIVES)} plans, those that do less weight than the best; they do not count in the "
        "means.",
    )
    return Table(SUMMARY, "Mean excess over the best plan found [%]", columns, tuple(rows), notes)


def _remarks(effort: Effort, found: Samples) -> tuple[str, ...]:
    return (
        "Values of each objective by muster.verify, lower is better; (n): only n tasks are done, (n; w): n tasks of "
        "weight w, the sum of their priorities. More weight comes before a lower value. Of several seeds the best "
        "counts.",
        f"Anytime allocators have {_limit(effort)} for each plan. s: when the plan was found, the mean over the "
        "objectives.",
    )


ALLOCATORS_STUDY = Repetition(
    **description("allocators"),
    reproductions=(Summary(), *map(MissionTable, MISSIONS)),
    perform=over_seeds,
    seeds=lambda effort: effort.seeds or 1,
    always=(SUMMARY,),
    remarks=_remarks,
)
"""Every allocator against every other, on everything that ships."""
