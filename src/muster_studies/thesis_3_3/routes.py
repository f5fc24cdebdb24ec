"""Tables of routes: 3.5, 3.8, 3.13 and 3.17 of the greedy algorithm, 3.6, 3.9, 3.14 and 3.18 of the combined one."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from muster.verification import RouteFigures
from muster_studies.comparison_marks import EQUAL, ERRATUM, equal, equal_rule
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.runs import Case, Sample, rejection
from muster_studies.tables import Cell, Notes, Table, row
from muster_studies.thesis_3_3.budgets import budgets
from muster_studies.thesis_3_3.plans import PublishedPlan, published_plans
from muster_studies.thesis_3_3.published import as_run_notes, publication

_GREEDY_COLUMNS = ("scenario", "robot", "tasks, thesis", "tasks, own", "usage, thesis", "usage, own", "mark")
_RANDOM_COLUMNS = (
    "scenario",
    "robot",
    "tasks, thesis",
    "usage, thesis",
    "recomputed",
    "mark",
    "tasks, own",
    "usage, own",
)


_GREEDY_RULE = equal_rule("the own route has the same tasks in the same order, and its usage is")
_RANDOM_RULE = equal_rule("the usage recomputed of the published route is")


def own_case(plan: PublishedPlan, number: str, effort: Effort) -> Case:
    """The case whose best plan stands beside a published one."""
    published = publication(number).iterations or 0
    return plan.case(budgets(effort, plan.mission, plan.allocator, published)[-1])


@dataclass(frozen=True)
class Routes:
    """A table with a row for each robot of each scenario.

    The greedy algorithm has to come to the published routes. A random one does not: there the mark says whether the
    printed usage is that of the printed route, recomputed by the judge.
    """

    number: str

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for plan in published_plans(self.number).values():
            yield own_case(plan, self.number, effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        published, notes = publication(self.number), Notes()
        plans = published_plans(self.number).values()
        random = any(plan.allocator != "greedy" for plan in plans)
        columns = _RANDOM_COLUMNS if random else _GREEDY_COLUMNS
        rows, remarks = [], []
        for plan in plans:
            sample = samples[own_case(plan, self.number, effort)]
            for figures in sample.best.verdict.routes:
                cells = _greedy_cells(plan, figures, notes) if not random else _random_cells(plan, figures, notes)
                rows.append(row(columns, cells))
            remarks += [*_judgement(plan), _own_plan(plan, sample)]
        missions = as_run_notes(plan.mission for plan in plans)
        lines = (*notes.lines(), *remarks, *missions)
        rule = _RANDOM_RULE if random else _GREEDY_RULE
        return Table(self.number, published.title, columns, tuple(rows), lines, mark_rule=rule)


def _cells(plan: PublishedPlan, own: RouteFigures) -> dict[str, Cell]:
    there = printed(plan.routes[own.robot])
    return {
        "scenario": plan.scenario,
        "robot": own.robot,
        "tasks, thesis": tuple(map(str, there["tasks"])),
        "usage, thesis": there["usage"],
        "tasks, own": own.tasks,
        "usage, own": own.usage,
    }


def _greedy_cells(plan: PublishedPlan, own: RouteFigures, notes: Notes) -> dict[str, Cell]:
    there = corrected(plan.routes[own.robot])
    same = tuple(map(str, there["tasks"])) == own.tasks
    mark = (_usage_mark(there["usage"], own.usage) if same else "other tasks") + _errata_marks(plan, own.robot, notes)
    return {**_cells(plan, own), "mark": mark}


def _random_cells(plan: PublishedPlan, own: RouteFigures, notes: Notes) -> dict[str, Cell]:
    recomputed = next(route.usage for route in plan.as_corrected.routes if route.robot == own.robot)
    mark = _usage_mark(corrected(plan.routes[own.robot])["usage"], recomputed)
    return {**_cells(plan, own), "recomputed": recomputed, "mark": mark + _errata_marks(plan, own.robot, notes)}


def _usage_mark(published: float, usage: float) -> str:
    return EQUAL if equal(published, usage) else f"{usage - published:+.2f}"


def _errata_marks(plan: PublishedPlan, robot: str, notes: Notes) -> str:
    texts = [f"{plan.scenario}, {robot}: {text}." for text in errata(plan.routes[robot])]
    return "".join(f" {ERRATUM} {notes.number(text)}" for text in texts)


def _judgement(plan: PublishedPlan) -> Iterator[str]:
    """What is wrong with a published plan as printed, and whether that is more than a misprint."""
    if not plan.as_corrected.valid:
        yield f"{plan.scenario}: the judge rejects the published plan ({rejection(plan.as_corrected)})."
    elif not plan.as_printed.valid:
        why = rejection(plan.as_printed)
        yield f"{plan.scenario}: the judge rejects the published plan as printed ({why}), and accepts it corrected."


def _own_plan(plan: PublishedPlan, sample: Sample) -> str:
    """The figures of the own plan in the table, and of which run it is."""
    best = sample.best
    verdict = best.verdict
    seed = f", seed {best.seed} (best of {len(sample.outcomes)}), {best.iterations} iterations"
    return (
        f"{plan.scenario}, own {plan.allocator}{seed if best.case.random else ''}: "
        f"{verdict.tasks_completed} of {verdict.tasks_total} tasks, C {verdict.total_cost:.2f}, "
        f"F {verdict.value('total+max'):.2f}."
    )
