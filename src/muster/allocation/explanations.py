"""Why this robot and not that one; why a task is left out."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

from muster import core
from muster.allocation.feasibility import least_usage
from muster.allocation.problem import Problem
from muster.mission.auction_book import Award, Book
from muster.mission.plan import Reason, Unassigned


def unassigned(
    problem: Problem, routes: Sequence[Sequence[int]], hurried: Callable[[], bool] = lambda: False
) -> tuple[Unassigned, ...]:
    """The tasks that a plan leaves out, in mission order, each with a reason for every robot.

    From when `hurried` says so tasks come without reasons.
    """
    inspection = core.Inspection(problem.core, [list(route) for route in routes])
    done = {j for route in routes for j in route}
    order = {task.id: k for k, task in enumerate(problem.mission.tasks)}
    left_out = sorted((j for j in range(len(problem.tasks)) if j not in done), key=lambda j: order[problem.tasks[j].id])
    robots = [problem.robot_index[robot.id] for robot in problem.mission.robots]

    def reasons(j: int) -> tuple[Reason, ...]:
        return () if hurried() else tuple(_reason(problem, inspection, done, i, j) for i in robots)

    return tuple(Unassigned(problem.tasks[j].id, reasons(j)) for j in left_out)


def unassigned_of_plan(
    problem: Problem, routes: Sequence[Sequence[int]], hurried: Callable[[], bool]
) -> tuple[Unassigned, ...]:
    """`unassigned` for a plan, which says nothing of fixed beginnings: its reasons are true without these.

    A task that fits only before tasks that are fixed is not chosen.
    """
    found = unassigned(problem, routes, hurried)
    if not problem.fixed or not found:
        return found
    free = unassigned(replace(problem, fixed=(), known=problem.measured), routes, hurried)
    return tuple(
        Unassigned(item.task, tuple(map(_without_beginnings, item.reasons, other.reasons)))
        for item, other in zip(found, free, strict=True)
    )


def _without_beginnings(reason: Reason, free: Reason) -> Reason:
    """The reason, unless there is none once no task is fixed."""
    if free.reason != "not-chosen" or reason.reason == free.reason:
        return reason
    return Reason(reason.robot, "not-chosen", "fits only before tasks that stay where they are")


def _reason(problem: Problem, inspection: core.Inspection, done: set[int], i: int, j: int) -> Reason:
    """Why robot i does not do task j, which the plan leaves out."""
    robot = problem.robots[i].id
    refusal = None if problem.may(i, j) else problem.refusal(i, j)
    if refusal is not None:
        return Reason(robot, *refusal)
    missing = [problem.tasks[k].id for k in problem.prerequisites[j] if k not in done]
    if missing:
        return Reason(robot, "prerequisite", f"left out before it: {', '.join(missing)}")
    unit = problem.usage_unit
    insertion = inspection.cheapest_insertion(i, j)
    if insertion is None:
        return Reason(robot, "prerequisite", "at every place in its route the prerequisites would wait in a circle")
    if math.isinf(insertion.usage):
        lost = math.isinf(inspection.usages[i])
        return Reason(robot, "unreachable", "there is no way along its route" if lost else problem.why_no_way(i, j))
    capacity = problem.capacity[i]
    if insertion.usage > capacity:
        return Reason(robot, "capacity", f"at least {insertion.usage:.2f} {unit} with it, of {capacity:.2f} {unit}")
    return Reason(robot, "not-chosen", f"fits as number {insertion.at + 1}, for {insertion.usage:.2f} {unit} in all")


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
            reasons.append(Reason(robot.id, "unreachable", problem.why_no_way(i, j)))
        elif all_named and robot.id not in bidders:
            reasons.append(Reason(robot.id, "capacity", "too little was left of it"))
    return tuple(reasons)


@dataclass(frozen=True)
class Alternative:
    """What giving a task to a robot would do: number in the route and objective then; or why it cannot be.

    Where another route of the plan lacks a way there is no objective.
    """

    robot: str
    number: int | None
    objective: float | None
    reason: Reason | None


def alternatives(problem: Problem, routes: Sequence[Sequence[int]], j: int) -> tuple[Alternative, ...]:
    """For every robot, in mission order, what giving it task j instead would do, the rest of the plan as it is."""
    rest = [[k for k in route if k != j] for route in routes]
    inspection = core.Inspection(problem.core, rest)
    done = {k for route in rest for k in route}
    return tuple(
        _alternative(problem, inspection, rest, done, problem.robot_index[robot.id], j)
        for robot in problem.mission.robots
    )


def _alternative(
    problem: Problem, inspection: core.Inspection, rest: list[list[int]], done: set[int], i: int, j: int
) -> Alternative:
    why = _reason(problem, inspection, done, i, j)
    insertion = inspection.cheapest_insertion(i, j) if why.reason == "not-chosen" else None
    if insertion is None:
        return Alternative(why.robot, None, None, why)
    routes = [list(route) for route in rest]
    routes[i].insert(insertion.at, j)
    objective = core.Inspection(problem.core, routes).objective
    finite = objective if objective is not None and math.isfinite(objective) else None
    return Alternative(why.robot, insertion.at + 1, finite, None)
