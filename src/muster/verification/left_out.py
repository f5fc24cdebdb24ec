"""Checks the list `unassigned` of a plan: the tasks left out, and the reasons for each robot."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator

from muster.mission.model import Task
from muster.mission.plan import REASONS, Plan, Reason
from muster.verification.case import Case
from muster.verification.measure import MeasuredRoute
from muster.verification.places import Places
from muster.verification.rules import rules_that_hold
from muster.verification.verdict import Violation


def left_out_faults(case: Case, plan: Plan) -> tuple[list[Violation], int]:
    """Find what is wrong with the list `unassigned`, and how many reasons in it could not be decided."""
    reasons = _Reasons(case)
    found = [*_contradicted(case, plan), *reasons.false(plan)]
    return found, reasons.undecided


def _contradicted(case: Case, plan: Plan) -> Iterator[Violation]:
    """Find where routes and the list contradict each other.

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


class _Reasons:
    """The reasons of a plan, of which those that are false are sought."""

    def __init__(self, case: Case) -> None:
        self._case, self._places = case, Places(case)
        self._routes = {route.robot.id: route for route in case.routes}
        self.undecided = 0

    def false(self, plan: Plan) -> Iterator[Violation]:
        in_route = {task for route in plan.routes for task in route.tasks}
        known = {task.id: task for task in self._case.mission.tasks}
        for item in plan.unassigned:
            if item.task in known and item.task not in in_route:
                for reason in item.reasons:
                    yield from self._false(known[item.task], reason)

    def _false(self, task: Task, reason: Reason) -> Iterator[Violation]:
        """Check one reason. Where it names no robot it is about none, and nothing can be said against it."""
        routes = self._routes
        if reason.reason not in REASONS:
            detail = f"the plan gives the reason {reason.reason}; expected {', '.join(REASONS)}"
            yield Violation("reason", reason.robot, task.id, detail)
        elif reason.robot and reason.robot not in routes:
            yield Violation("reason", reason.robot, task.id, "a reason of no robot of the mission")
        elif reason.robot:
            contradiction = self._contradiction(routes[reason.robot], task, reason.reason)
            if contradiction is not None:
                yield Violation("reason", reason.robot, task.id, contradiction)

    def _contradiction(self, route: MeasuredRoute, task: Task, reason: str) -> str | None:
        """Why a reason is false; None if it is true, or cannot be decided."""
        claims = [(rule.kind, rule.prevents(self._case, route, task)) for rule in rules_that_hold(self._case)]
        broken = next((kind for kind, claim in claims if claim), None)
        if reason == "not-chosen":
            if broken is not None:
                return f"the plan says not-chosen, but the rule {broken} keeps the robot from it"
            is_free = self._can_do(route, task) if any(claim is None for _, claim in claims) else True
            return "the plan says not-chosen, but at no place are all rules kept" if is_free is False else None
        if all(claim is False for kind, claim in claims if kind == reason):
            return f"the plan says {reason}, but that does not keep the robot from it"
        if broken is None and self._can_do(route, task):
            return f"the plan says {reason}, but the robot could do it with the rest of the plan as it is"
        return None

    def _can_do(self, route: MeasuredRoute, task: Task) -> bool | None:
        found = self._places.can_do(route.robot, task)
        self.undecided += found is None
        return found


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
