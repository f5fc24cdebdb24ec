"""Reasons: why a plan leaves out a task, and what giving a task to another robot would do."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from muster import core
from muster.allocation.bounds.feasibility import least_usage
from muster.allocation.reasons.timed_places import TimedPlaces, in_plan
from muster.mission.auction_book import Award, Book
from muster.mission.plan import Reason, Unassigned
from muster.model.problem import Problem
from muster.model.rules import InPlan

_MOST_EFFORT = 1e6  # of the reasons that come with a plan, as `TimedPlaces.effort` measures it: seconds


def unassigned(
    problem: Problem,
    routes: Sequence[Sequence[int]],
    hurried: Callable[[], bool] = lambda: False,
    most_effort: float = math.inf,
) -> tuple[Unassigned, ...]:
    """The tasks that a plan leaves out, in mission order, each with a reason for every robot.

    From when `hurried` says so tasks come without reasons, and so do those that would take more than what is left of
    `most_effort`.
    """
    done = {j for route in routes for j in route}
    order = {task.id: k for k, task in enumerate(problem.mission.tasks)}
    missing = (j for j in range(len(problem.tasks)) if j not in done)
    left_out = sorted(missing, key=lambda j: order[problem.tasks[j].id])
    plan = in_plan(problem, routes) if left_out and not hurried() else None
    found, left = list[Unassigned](), most_effort
    for j in left_out:
        effort = plan.effort(j) if isinstance(plan, TimedPlaces) else 0.0
        reasons = _reasons(problem, plan, j, hurried) if effort <= left else ()
        left -= effort if effort <= left else 0.0
        found.append(Unassigned(problem.tasks[j].id, reasons))
    return tuple(found)


def _reasons(problem: Problem, plan: InPlan | None, j: int, hurried: Callable[[], bool]) -> tuple[Reason, ...]:
    """Why no robot does a task; nothing where there is no time to ask all of them."""
    reasons: list[Reason] = []
    for robot in problem.mission.robots:
        if plan is None or hurried():
            return ()
        reasons.append(_reason(problem, plan, problem.robot_index[robot.id], j))
    return tuple(reasons)


def unassigned_of_plan(
    problem: Problem, routes: Sequence[Sequence[int]], hurried: Callable[[], bool]
) -> tuple[Unassigned, ...]:
    """`unassigned` for a plan, which says nothing of fixed beginnings: its reasons are true without these.

    A task that fits only before tasks that are fixed is not chosen.
    """
    found = unassigned(problem, routes, hurried, _MOST_EFFORT)
    if not problem.fixed or not found:
        return found
    free = unassigned(replace(problem, fixed=(), known=problem.measured), routes, hurried, _MOST_EFFORT)
    return tuple(
        Unassigned(item.task, tuple(map(_without_beginnings, item.reasons, other.reasons)))
        for item, other in zip(found, free, strict=True)
    )


def _without_beginnings(reason: Reason, free: Reason) -> Reason:
    """The reason, unless there is none once no task is fixed."""
    if free.reason != "not-chosen" or reason.reason == free.reason:
        return reason
    return Reason(reason.robot, "not-chosen", "fits only before tasks that stay where they are")


def _reason(problem: Problem, plan: InPlan, i: int, j: int) -> Reason:
    """Why robot i does not do task j, which the plan leaves out."""
    for rule in problem.rules:
        detail = rule.left_out(plan, i, j)
        if detail is not None:
            return Reason(problem.robots[i].id, rule.word, detail)
    fitting = _fitting(plan, i, j)
    if fitting is None:
        return Reason(
            problem.robots[i].id, "not-chosen", "fits at none of the places that were tried, which were not all"
        )
    at, usage = fitting
    detail = f"fits as number {at + 1}, for {usage:.2f} {problem.usage_unit} in all"
    return Reason(problem.robots[i].id, "not-chosen", detail)


def _fitting(plan: InPlan, i: int, j: int) -> tuple[int, float] | None:
    """Where a task fits into the route of a robot that no rule keeps from it, and the usage of the route with it.

    None where no place was found, and not all were looked at.
    """
    if isinstance(plan, TimedPlaces):
        found = plan.outcome(i, j)
        return None if found.place is None else (found.place.at, found.usage)
    insertion = plan.insertion(i, j)
    assert insertion is not None  # or a rule would have said why
    return insertion.at, insertion.usage


def without_bid(problem: Problem, book: Book, award: Award) -> tuple[Reason, ...]:
    """Why robots could not bid for a task in the round in which it was won, in mission order.

    Only robots that may not do the task at all, where not all bids are named, or a robot need not bid if it can.
    """
    j = problem.task_index[award.task]
    bidders = {robot for robot, _ in award.bids}
    all_named = book.central and award.bidders == len(award.bids)
    reasons = []
    for robot in problem.mission.robots:
        i = problem.robot_index[robot.id]
        refusal = problem.refusal(i, j)
        if refusal is not None:
            reasons.append(Reason(robot.id, *refusal))
        elif all_named and robot.id not in bidders and math.isinf(least_usage(problem, i)[j]):
            reasons.append(Reason(robot.id, "unreachable", problem.no_way_to(i, j)))
        elif all_named and robot.id not in bidders:
            word = problem.model.word_of("capacity")
            why = (word, "too little was left of it") if word else ("not-chosen", "it made no bid")
            reasons.append(Reason(robot.id, *why))
    return tuple(reasons)


@dataclass(frozen=True)
class Alternative:
    """The effect of giving a task to a robot: its number in the route and the objective; or the reason against it.

    The objective is None where another route of the plan has a leg without a path.
    """

    robot: str
    number: int | None
    objective: float | None
    reason: Reason | None


def alternatives(problem: Problem, routes: Sequence[Sequence[int]], j: int) -> tuple[Alternative, ...]:
    """For every robot, in mission order, what giving it task j instead would do, the rest of the plan as it is."""
    moved = problem.with_partner(j)
    plan = in_plan(problem, [[k for k in route if k not in moved] for route in routes])
    return tuple(_alternative(problem, plan, problem.robot_index[robot.id], j) for robot in problem.mission.robots)


def _alternative(problem: Problem, plan: InPlan, i: int, j: int) -> Alternative:
    why = _reason(problem, plan, i, j)
    if why.reason != "not-chosen":
        return Alternative(why.robot, None, None, why)
    fitting = _fitting(plan, i, j)
    if fitting is None:
        return Alternative(why.robot, None, None, why)
    at, _ = fitting
    objective = core.Inspection(problem.core, plan.with_task(i, j, at)).objective
    finite = objective if objective is not None and math.isfinite(objective) else None
    return Alternative(why.robot, at + 1, finite, None)
