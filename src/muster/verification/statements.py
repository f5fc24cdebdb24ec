"""Checks the figures, the objective and the history that a plan states (docs/design.md, Files)."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise

from muster.mission.model import OBJECTIVES
from muster.mission.plan import STOP_TIMES, Plan, RouteStop
from muster.verification.agreement import ABSOLUTE_TOLERANCE, RELATIVE_TOLERANCE, agrees
from muster.verification.verdict import Stop, Verdict, Violation


def false_statements(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    """Find every false statement. A plan that states only routes states nothing false.

    `tolerance` is that of travel, relative.
    """
    relative = max(RELATIVE_TOLERANCE, tolerance)
    if plan.objective not in (None, verdict.objective_name):
        detail = f"the plan's is {plan.objective}, and {verdict.objective_name} was to be minimised"
        yield Violation("objective", None, None, detail)
    yield from _figures(plan, verdict, relative, tolerance)
    yield from _usages(plan, verdict, relative)
    yield from _stops(plan, verdict, relative)
    yield from _history(plan, verdict, relative)
    if plan.elapsed_s is not None and plan.elapsed_s < 0:
        yield Violation("figure", None, None, f"elapsed_s: the plan says {plan.elapsed_s}; expected at least 0")


def _figures(plan: Plan, verdict: Verdict, relative: float, tolerance: float) -> Iterator[Violation]:
    objective = plan.objective or verdict.objective_name
    value = verdict.value(objective) if objective in OBJECTIVES else None
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
        if not agrees(stated, found, relative):
            yield Violation("figure", None, None, f"{name}: the plan says {stated}, it is {found}")
    index = verdict.equality_index
    # With travel that is off by up to t the index is off by up to 2 t, however small it is.
    if not agrees(plan.equality_index, index, absolute=max(ABSOLUTE_TOLERANCE, 2 * tolerance)):
        yield Violation("figure", None, None, f"equality_index: the plan says {plan.equality_index}, it is {index}")
    bound = plan.lower_bound
    if bound is not None and value is not None and not bound <= value and not agrees(bound, value, relative):
        yield Violation("figure", None, None, f"lower_bound: the plan says {bound}, above its objective {value}")


def _usages(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    stated: dict[str, float | None] = {}
    for route in plan.routes:
        stated.setdefault(route.robot, route.usage)  # of two routes of one robot the first was judged
    for figures in verdict.routes:
        usage = stated.get(figures.robot)
        if not agrees(usage, figures.usage, tolerance):
            yield Violation("figure", figures.robot, None, f"usage: the plan says {usage}, it is {figures.usage}")


def _stops(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    """Find stops that are not those of the earliest schedule."""
    figures = {route.robot: route for route in verdict.routes}
    for route in plan.routes:
        named = tuple(stop.name for stop in route.stops)
        if named and named != route.tasks:
            detail = f"the stops are those of {', '.join(named)}, not of the route's tasks"
            yield Violation("stop", route.robot, None, detail)
        elif named and route.robot in figures:
            for stated, found in _judged(route.stops, figures[route.robot].stops):
                yield from _stop(route.robot, stated, found, tolerance)


def _judged(stated: Sequence[RouteStop], found: Sequence[Stop]) -> Iterator[tuple[RouteStop, Stop]]:
    """Each stop of a route that was judged, with its figures: stations in turn, as a robot may come again and again."""
    left: dict[str, list[Stop]] = {}
    for one in reversed(found):
        left.setdefault(one.name, []).append(one)
    for stop in stated:
        own = left.get(stop.name)
        if own:
            yield stop, (own.pop() if len(own) > 1 else own[0])


def _stop(robot: str, stated: RouteStop, found: Stop, tolerance: float) -> Iterator[Violation]:
    if stated.is_station != found.is_station:
        names = ("station", "task") if stated.is_station else ("task", "station")
        yield Violation("stop", robot, stated.name, "the plan says that it is a {}, it is a {}".format(*names))
    if stated.charged and found.charged is None:
        detail = f"charged: the plan says {stated.charged}, where no battery is charged"
        yield Violation("stop", robot, stated.name, detail)
    for name, says, is_at in zip(STOP_TIMES, _times_stated(stated), _times_found(found), strict=True):
        if says != is_at and not agrees(says, is_at, tolerance, RELATIVE_TOLERANCE):
            yield Violation("stop", robot, stated.name, f"{name}: the plan says {says}, it is {is_at}")


def _times_stated(stop: RouteStop) -> tuple[float, float, float]:
    return stop.arrive_s, stop.begin_s, stop.end_s


def _times_found(stop: Stop) -> tuple[float, float, float]:
    return stop.arrives_s, stop.starts_s, stop.ends_s


def _history(plan: Plan, verdict: Verdict, tolerance: float) -> Iterator[Violation]:
    """Find what cannot be the history of a search that ended with this plan.

    Times go up and lie within the time of the search. The objective goes down, except where more tasks came in: once
    for each task of the plan at most. It ends at the plan's objective.
    """
    seconds, values = [time for time, _ in plan.history], [value for _, value in plan.history]
    last = max([*seconds, 0.0]) if plan.elapsed_s is None else plan.elapsed_s
    rises = sum(later > value and not agrees(later, value, tolerance) for value, later in pairwise(values))
    most = sum(len(route.tasks) for route in plan.routes)
    objective = plan.objective or verdict.objective_name
    found_value = verdict.value(objective) if objective in OBJECTIVES else None
    end = values[-1] if values else None
    wrong = (
        (any(later < time for time, later in pairwise(seconds)), "its times go back"),
        (any(not 0 <= time <= last + ABSOLUTE_TOLERANCE for time in seconds), f"times outside of 0 to {last:g} s"),
        (rises > most, f"the objective rises {rises} times; {most} tasks can account for {most} of these"),
        (not agrees(end, found_value, tolerance), f"it ends at {end}, the plan's {objective} is {found_value}"),
    )
    for found, detail in wrong:
        if found:
            yield Violation("history", None, None, detail)
