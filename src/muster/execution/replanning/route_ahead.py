"""What a robot uses after each stop of a planned route, and the calls at stations on it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import pairwise

from muster.allocation.allocator import scheduled
from muster.execution.robots.station_calls import Call, in_one_visit, tasks_and_calls
from muster.mission.plan import RouteStop
from muster.model.energy_under_way import refilled_to
from muster.model.problem import Problem


@dataclass(frozen=True)
class RouteAhead:
    """What lies ahead of a robot.

    Parameters
    ----------
    usage
        by task of the route what the robot uses after it, in the mission's unit, the way to its end included; under the
        empty name after what it is doing.
    calls
        at stations, in order.
    """

    usage: dict[str, float] = field(default_factory=lambda: {"": 0.0})
    calls: tuple[Call, ...] = ()


def stops_of(problem: Problem, routes: Sequence[Sequence[int]]) -> list[tuple[RouteStop, ...]]:
    """By robot its stops: the tasks of its route, and the stations that the plan puts between them."""
    if problem.stations:
        found = [route.stops for route in scheduled(problem, [list(route) for route in routes])]
        if any(found):
            return found
    return [tuple(_untimed(problem.tasks[j].id) for j in route) for route in routes]


@lru_cache(maxsize=4096)
def _untimed(task: str) -> RouteStop:
    """A stop at a task, of whose times nothing is said."""
    return RouteStop(task, 0.0, 0.0, 0.0)


def route_ahead(problem: Problem, i: int, stops: Sequence[RouteStop]) -> RouteAhead:
    """What lies ahead of robot i, whose stops begin with its past if it has one."""
    if not stops:
        return RouteAhead()
    n, m = len(problem.tasks), len(problem.robots)
    number = {station.id: n + 2 * m + k for k, station in enumerate(problem.stations)}
    places = [number[stop.name] if stop.is_station else problem.task_index[stop.name] for stop in stops]
    legs, work = problem.legs(i, [problem.start(i), *places], places), problem.work_usage(i)
    must_end = problem.robots[i].place_at_end(problem.mission.rules) is not None
    left = float(problem.legs(i, places[-1:], [problem.end(i)])[0, 0]) if must_end else 0.0
    after = [0.0] * len(places)
    for k in reversed(range(len(places))):
        after[k] = left
        left += float(legs[k, k]) + (0.0 if stops[k].is_station else float(work[places[k]]))
    usage = {stop.name: rest for stop, rest in zip(stops, after, strict=True) if not stop.is_station}
    past = problem.beginning(i)
    usage[""] = usage[problem.tasks[past[0]].id] if past else left
    return RouteAhead(usage, _calls(problem, i, stops, after, left))


def _calls(
    problem: Problem, i: int, stops: Sequence[RouteStop], after: Sequence[float], whole: float
) -> tuple[Call, ...]:
    """The calls among stops, after each of which the robot uses so much, with the shares up to which it is filled."""
    usages = [before - rest for before, rest in pairwise((whole, *after))]  # the work of a task included
    shares = refilled_to(problem, i, stops, usages)
    details = [(share, rest) for stop, share, rest in zip(stops, shares, after, strict=True) if stop.is_station]
    past = {problem.tasks[j].id for j in problem.beginning(i)}
    names = [stop.name for stop in stops if stop.name not in past]
    return in_one_visit(tasks_and_calls(names, {station.id for station in problem.stations}, details)[1])
