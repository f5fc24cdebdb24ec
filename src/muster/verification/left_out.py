"""Checks the list `unassigned` of a plan: the tasks left out, and the reasons for each robot."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from muster.mission.model import Task
from muster.mission.plan import REASONS, Plan, Reason
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.rules import rules_that_hold
from muster.verification.verdict import Violation


def left_out_faults(case: Case, plan: Plan) -> Iterator[Violation]:
    """Find where routes and the list `unassigned` contradict each other, and reasons in the list that are not true.

    A plan from elsewhere may say nothing of what it leaves out. One that has such a list, or any figure, is read as
    a full answer: each task is either in a route or left out.
    """
    in_route = {task: route.robot for route in plan.routes for task in route.tasks}
    times_listed = Counter(item.task for item in plan.unassigned)
    known = {task.id: task for task in case.mission.tasks}
    for name, times in times_listed.items():
        if name not in known:
            yield Violation("unknown-task", None, name, "listed as unassigned, but no task of the mission")
        elif name in in_route:
            yield Violation("unassigned", in_route[name], name, "in a route, and listed as unassigned")
        elif times > 1:
            yield Violation("unassigned", None, name, f"listed as unassigned {times} times")
    if times_listed or _states_figures(plan):
        for name in known:
            if name not in in_route and name not in times_listed:
                yield Violation("unassigned", None, name, "in no route, and not listed as unassigned")
    routes = {route.robot.id: route for route in case.routes}
    for item in plan.unassigned:
        if item.task in known and item.task not in in_route:
            for reason in item.reasons:
                yield from _false_reason(case, routes, known[item.task], reason)


def _false_reason(case: Case, routes: dict[str, MeasuredRoute], task: Task, reason: Reason) -> Iterator[Violation]:
    """Check one reason. Where it names no robot it is about none, and nothing can be said against it."""
    if reason.reason not in REASONS:
        detail = f"the plan gives the reason {reason.reason}; expected {', '.join(REASONS)}"
        yield Violation("reason", reason.robot, task.id, detail)
    elif reason.robot and reason.robot not in routes:
        yield Violation("reason", reason.robot, task.id, "a reason of no robot of the mission")
    elif reason.robot:
        contradiction = _contradiction(case, routes[reason.robot], task, reason.reason)
        if contradiction is not None:
            yield Violation("reason", reason.robot, task.id, contradiction)


def _contradiction(case: Case, route: MeasuredRoute, task: Task, reason: str) -> str | None:
    """Why a reason is false; None if it is true, or too close to decide."""
    rules = rules_that_hold(case)
    if reason == "not-chosen":
        broken = next((rule.kind for rule in rules if rule.prevents(case, route, task)), None)
        return None if broken is None else f"the plan says not-chosen, but the rule {broken} keeps the robot from it"
    claims = [rule.prevents(case, route, task) for rule in rules if rule.kind == reason]
    if any(claim is not False for claim in claims):
        return None
    return f"the plan says {reason}, but that does not keep the robot from it"


def _states_figures(plan: Plan) -> bool:
    figures = (
        plan.objective_value,
        plan.total_cost,
        plan.max_usage,
        plan.makespan_s,
        plan.equality_index,
        plan.tasks_completed,
        plan.tasks_total,
        plan.weight_completed,
        plan.lower_bound,
        *(route.usage for route in plan.routes),
    )
    return any(figure is not None for figure in figures)
