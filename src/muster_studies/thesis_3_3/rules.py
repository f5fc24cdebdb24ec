"""Tables on rules: 3.11 and 3.12 on prerequisites, 3.16 on work capacity."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster.verification import Verdict
from muster_studies.comparison_marks import EQUAL, ERRATUM, equal, equal_rule
from muster_studies.effort import Effort
from muster_studies.misprints import corrected, errata, printed
from muster_studies.runs import Case, Sample, judged, mission_named, rejection
from muster_studies.tables import Cell, Notes, Table
from muster_studies.thesis_3_3.plans import PublishedPlan, published_plans
from muster_studies.thesis_3_3.published import as_run_notes, publication
from muster_studies.thesis_3_3.routes import own_case

KEPT, OTHER_ROBOTS, BROKEN, LEFT_OUT, REJECTED = "kept", "other robots", "broken", "left out", "rejected"
_PLANS = {"greedy": "3.8", "greedy+genetic": "3.9"}  # with prerequisites


@dataclass(frozen=True)
class Chains:
    """Table 3.11: a row for each step of each chain, and whether the published and the own plan hold to it."""

    number: str = "3.11"

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for chain in publication(self.number).content["chains"]:
            yield own_case(_plan_of(chain, _PLANS), _PLANS[chain["allocator"]], effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        published, notes = publication(self.number), Notes()
        rows = []
        for chain in published.content["chains"]:
            plan = _plan_of(chain, _PLANS)
            own = samples[own_case(plan, _PLANS[chain["allocator"]], effort)].best.verdict
            for count, step in enumerate(chain["steps"], 1):
                rows.append(_step_cells(plan, count, step, own, notes))
        legend = (
            f"{KEPT}: the robot does these tasks in this order, each after all its prerequisites; what is listed as "
            "satisfied then is.",
            f"{OTHER_ROBOTS}: all that, but by other robots or in another order. Only greedy has to come to the same.",
        )
        return Table.of_cells(self.number, published.title, rows, (*notes.lines(), *legend))


def _plan_of(record: Mapping[str, Any], numbers: Mapping[str, str]) -> PublishedPlan:
    return published_plans(numbers[record["allocator"]])[record["mission"]]


def _step_cells(
    plan: PublishedPlan, count: int, step: Mapping[str, Any], own: Verdict, notes: Notes
) -> dict[str, Cell]:
    right = corrected(step)
    robot, tasks, satisfied = right["robot"], _names(right["tasks"]), _names(right["satisfied"])
    there = step_kept(plan.mission, plan.as_corrected, robot, tasks, satisfied)
    if there == REJECTED:
        there += f" {notes.number(f'{plan.scenario}: the published plan; {rejection(plan.as_corrected)}.')}"
    return {
        "scenario": plan.scenario,
        "allocator": plan.allocator,
        "step": count,
        "robot": robot,
        "tasks": _names(printed(step)["tasks"]),
        "satisfied": satisfied,
        "thesis plan": there,
        "own plan": step_kept(plan.mission, own, robot, tasks, satisfied),
        "mark": _errata_mark(f"{plan.scenario}, {plan.allocator}", step, notes),
    }


def _names(ids: Sequence[Any]) -> tuple[str, ...]:
    return tuple(map(str, ids))


def _errata_mark(where: str, record: Mapping[str, Any], notes: Notes) -> str | None:
    return ", ".join(f"{ERRATUM} {notes.number(f'{where}: {text}.')}" for text in errata(record)) or None


def step_kept(mission: str, verdict: Verdict, robot: str, tasks: Sequence[str], satisfied: Sequence[str]) -> str:
    """Whether a plan, by the judge's schedule, holds to a step of a chain."""
    visits = {visit.task: visit for route in verdict.routes for visit in route.visits}
    if not visits:
        return REJECTED
    if not visits.keys() >= {*tasks, *satisfied}:
        return LEFT_OUT
    before = {task.id: task.prerequisites for task in mission_named(mission).tasks}
    after = max(visits[task].ends_s for task in tasks)
    early = any(visits[name].ends_s > visits[task].starts_s for task in tasks for name in before[task])
    unsatisfied = any(visits[name].ends_s > after for task in satisfied for name in before[task])
    if early or unsatisfied:
        return BROKEN
    route = next(figures.tasks for figures in verdict.routes if figures.robot == robot)
    return KEPT if tuple(task for task in route if task in tasks) == tuple(tasks) else OTHER_ROBOTS


@dataclass(frozen=True)
class Violations:
    """Table 3.12: prerequisites broken by plans made without them."""

    number: str = "3.12"

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for record in publication(self.number).content["violations"]:
            yield own_case(published_plans(record["table"])[record["mission"]], record["table"], effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        published, notes = publication(self.number), Notes()
        rows = []
        for record in published.content["violations"]:
            plan = published_plans(record["table"])[record["mission"]]
            own = samples[own_case(plan, record["table"], effort)].best.verdict
            rows.append(_violation_cells(plan, record, own, notes))
        legend = (
            "before: a prerequisite of the task. judged: with prerequisites in force.",
            "Only greedy has to come to the same plan, and so to the same violation.",
        )
        rule = f"{EQUAL}: the own plan breaks the same prerequisite as the published one."
        lines = (*notes.lines(), *legend)
        return Table.of_cells(self.number, published.content["title"], rows, lines, mark_rule=rule)


def _violation_cells(plan: PublishedPlan, record: Mapping[str, Any], own: Verdict, notes: Notes) -> dict[str, Cell]:
    right = corrected(record)
    robot, task, prerequisite = right["robot"], str(right["task"]), str(right["before_prerequisite"])
    here = _comes_before(own, robot, task, prerequisite)
    marks = [EQUAL if here else "not so"] if plan.allocator == "greedy" else []
    erratum = _errata_mark(f"{plan.scenario}, {plan.allocator}", record, notes)
    return {
        "scenario": plan.scenario,
        "allocator": plan.allocator,
        "robot": printed(record)["robot"],
        "task": task,
        "before": prerequisite,
        "thesis plan": _yes(_comes_before(plan.as_corrected, robot, task, prerequisite)),
        "own plan": _yes(here),
        "thesis judged": _with_prerequisites(plan, plan.as_corrected),
        "own judged": _with_prerequisites(plan, own),
        "mark": ", ".join([*marks, *([erratum] if erratum else [])]) or None,
    }


def _yes(so: bool) -> str:
    return "yes" if so else "no"


def _comes_before(verdict: Verdict, robot: str, task: str, other: str) -> bool:
    route = next(figures.tasks for figures in verdict.routes if figures.robot == robot)
    return task in route and other in route and route.index(task) < route.index(other)


def _with_prerequisites(plan: PublishedPlan, verdict: Verdict) -> str:
    ignored = tuple(rule for rule in plan.ignored if rule != "prerequisites")
    valid = judged(plan.mission, ignored, {figures.robot: figures.tasks for figures in verdict.routes}).valid
    return "accepted" if valid else REJECTED


@dataclass(frozen=True)
class Capacities:
    """Table 3.16: what the robots may use; the own numbers are those that the judge holds a plan to."""

    number: str = "3.16"
    plans: str = "3.17"

    def jobs(self, effort: Effort) -> Iterator[Case]:
        for plan in published_plans(self.plans).values():
            yield own_case(plan, self.plans, effort)

    def table(self, effort: Effort, samples: Mapping[Case, Sample]) -> Table:
        published, plans = publication(self.number), published_plans(self.plans).values()
        missions = published.content["missions"]
        own = {plan.scenario: _capacities(samples[own_case(plan, self.plans, effort)]) for plan in plans}
        columns = ("robot", *(f"{name}, {values}" for name in missions for values in ("thesis", "own")), "mark")
        rows = []
        for robot in next(iter(own.values())):
            pairs = [(float(missions[name][robot]), own[name][robot]) for name in missions]
            same = all(here is not None and equal(there, here) for there, here in pairs)
            rows.append((robot, *(value for pair in pairs for value in pair), EQUAL if same else "differs"))
        notes = as_run_notes(plan.mission for plan in plans)
        rule = equal_rule("the work capacities that the judge holds a plan to are")
        return Table(self.number, published.content["title"], columns, tuple(rows), notes, mark_rule=rule)


def _capacities(sample: Sample) -> dict[str, float | None]:
    return {route.robot: route.capacity for route in sample.best.verdict.routes}
