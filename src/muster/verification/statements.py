"""What a plan says of itself against what is: its figures, and the tasks that are left out (DESIGN section 5)."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator

from muster.mission.auction_book import Book
from muster.mission.model import OBJECTIVES, Mission
from muster.mission.plan import Plan
from muster.verification.verdict import Verdict, Violation

RELATIVE_TOLERANCE = 1e-6
ABSOLUTE_TOLERANCE = 1e-9


def false_statements(mission: Mission, plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    """Find everything that the plan states and that is not so. A plan that states only routes states nothing false.

    `tolerance` is that of travel, relative.
    """
    yield from _left_out(mission, plan)
    yield from _figures(plan, verdict, tolerance)
    yield from _usages(plan, verdict, max(RELATIVE_TOLERANCE, tolerance))
    if plan.book is not None:
        yield from _book(mission, plan, plan.book)


def _book(mission: Mission, plan: Plan, book: Book) -> Iterator[Violation]:
    """Find where the account of an auction contradicts the routes, or itself."""
    robot_of = {task: route.robot for route in plan.routes for task in route.tasks}
    times = Counter(award.task for award in book.awards)
    known = {robot.id for robot in mission.robots}
    for award in book.awards:
        bids = dict(award.bids)
        wrong = (
            (award.task not in robot_of, "won, but in no route"),
            (robot_of.get(award.task, award.robot) != award.robot, f"won by {award.robot}, but done by another"),
            (times[award.task] > 1, f"won {times[award.task]} times"),
            (not 1 <= award.round <= book.rounds, f"won in round {award.round} of {book.rounds}"),
            (not known >= bids.keys(), "a bid of no robot of the mission"),
            (award.bidders < len(bids), f"{len(bids)} bids of {award.bidders} robots"),
            (not _agrees(bids.get(award.robot), award.price), f"won for {award.price}, which was not the bid"),
        )
        for found, detail in wrong:
            if found:
                yield Violation("book", award.robot, award.task, detail)


def _figures(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    objective = plan.objective or verdict.objective_name
    if objective != verdict.objective_name:
        detail = f"the plan's is {objective}, and {verdict.objective_name} was to be minimised"
        yield Violation("objective", None, None, detail)
    value = verdict.value(objective) if objective in OBJECTIVES else None
    relative = max(RELATIVE_TOLERANCE, tolerance)
    figures = (
        (f"objective {objective}", plan.objective_value, value),
        ("usage_unit", plan.usage_unit, verdict.usage_unit),
        ("total_cost", plan.total_cost, verdict.total_cost),
        ("max_usage", plan.max_usage, verdict.max_usage),
        ("makespan_s", plan.makespan_s, verdict.makespan_s),
        ("tasks_completed", plan.tasks_completed, verdict.tasks_completed),
        ("tasks_total", plan.tasks_total, verdict.tasks_total),
        ("weight_completed", plan.weight_completed, verdict.weight_completed),
    )
    for name, stated, found in figures:
        if not _agrees(stated, found, relative):
            yield Violation("figure", None, None, f"{name}: the plan says {stated}, it is {found}")
    index = verdict.equality_index
    # With travel that is off by up to t the index is off by up to 2 t, however small it is.
    if not _agrees(plan.equality_index, index, absolute=max(ABSOLUTE_TOLERANCE, 2 * tolerance)):
        yield Violation("figure", None, None, f"equality_index: the plan says {plan.equality_index}, it is {index}")
    bound = plan.lower_bound
    if bound is not None and value is not None and not bound <= value and not _agrees(bound, value, relative):
        yield Violation("figure", None, None, f"lower_bound: the plan says {bound}, above its objective {value}")


def _usages(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    stated: dict[str, float | None] = {}
    for route in plan.routes:
        stated.setdefault(route.robot, route.usage)  # of two routes of one robot the first was judged
    for figures in verdict.routes:
        usage = stated.get(figures.robot)
        if not _agrees(usage, figures.usage, tolerance):
            yield Violation("figure", figures.robot, None, f"usage: the plan says {usage}, it is {figures.usage}")


def _agrees(
    stated: float | str | None,
    found: float | str | None,
    relative: float = RELATIVE_TOLERANCE,
    absolute: float = ABSOLUTE_TOLERANCE,
) -> bool:
    """Return whether a figure, if stated, is right: numbers to the tolerances, counts and words exactly."""
    if stated is None:
        return True
    if isinstance(stated, float | int) and isinstance(found, float):
        return math.isclose(stated, found, rel_tol=relative, abs_tol=absolute)
    return stated == found


def _left_out(mission: Mission, plan: Plan) -> Iterator[Violation]:
    """Find where routes and the list `unassigned` contradict each other.

    A plan from elsewhere may say nothing of what it leaves out. One that has such a list, or any figure, is read as
    a full answer: each task is either in a route or left out.
    """
    in_route = {task: route.robot for route in plan.routes for task in route.tasks}
    times_listed = Counter(item.task for item in plan.unassigned)
    known = {task.id for task in mission.tasks}
    for name, times in times_listed.items():
        if name not in known:
            yield Violation("unknown-task", None, name, "listed as unassigned, but no task of the mission")
        elif name in in_route:
            yield Violation("unassigned", in_route[name], name, "in a route, and listed as unassigned")
        elif times > 1:
            yield Violation("unassigned", None, name, f"listed as unassigned {times} times")
    if times_listed or _states_figures(plan):
        for task in mission.tasks:
            if task.id not in in_route and task.id not in times_listed:
                yield Violation("unassigned", None, task.id, "in no route, and not listed as unassigned")


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
