"""Calls of a route at stations: where a robot gets energy or unloads between its tasks."""

from __future__ import annotations

from collections.abc import Collection, Container, Iterable, Sequence
from dataclasses import dataclass, replace


@dataclass(frozen=True)
class Call:
    """A visit of a station.

    Parameters
    ----------
    station
        its id.
    before
        the task of the route before which the robot goes there; None: after the last one.
    until
        the share of its capacity up to which the robot is filled; None: until it is full, or nothing is added.
    left
        what the robot uses after it, to the end of its route, in the mission's unit, as planned.
    planned
        whether a plan has it; else the robot goes for energy of itself, as it has nothing to do or runs low.
    """

    station: str
    before: str | None
    until: float | None = None
    left: float = 0.0
    planned: bool = True


def tasks_and_calls(
    names: Iterable[str], stations: Collection[str], details: Sequence[tuple[float | None, float]] = ()
) -> tuple[tuple[str, ...], tuple[Call, ...]]:
    """The tasks of a route that names stations too, and its calls.

    Parameters
    ----------
    details
        for each station in the route `until` and `left` of its call; empty: nothing is known of them.
    """
    tasks: list[str] = []
    calls: list[Call] = []
    ahead: list[int] = []  # calls whose task comes next
    for name in names:
        if name in stations:
            until, left = details[len(calls)] if details else (None, 0.0)
            ahead.append(len(calls))
            calls.append(Call(name, None, until, left))
            continue
        for k in ahead:
            calls[k] = replace(calls[k], before=name)
        ahead = []
        tasks.append(name)
    return tuple(tasks), tuple(calls)


def without_tasks(route: Sequence[str], calls: Sequence[Call], gone: Container[str]) -> tuple[list[str], list[Call]]:
    """A route and its calls without some tasks; a call before one of them comes before the next that is left."""
    following: dict[str | None, str | None] = {None: None}
    after = None
    for task in reversed(route):
        after = after if task in gone else task
        following[task] = after
    left = [task for task in route if task not in gone]
    return left, [replace(call, before=following.get(call.before, call.before)) for call in calls]


def as_one(visit: Call, following: Call) -> Call:
    """A visit under way and a call at the same station that comes next: one visit, up to the higher level."""
    full = visit.until is None or following.until is None
    return replace(following, until=None if full else max(visit.until or 0.0, following.until or 0.0))


def in_one_visit(calls: Iterable[Call]) -> tuple[Call, ...]:
    """The calls, of which several at one station with no task between them are one."""
    found: list[Call] = []
    for call in calls:
        if found and (found[-1].station, found[-1].before) == (call.station, call.before):
            call = as_one(found.pop(), call)
        found.append(call)
    return tuple(found)


def next_call(route: Sequence[str], calls: Sequence[Call]) -> Call | None:
    """The call that comes before the next task of a route."""
    first = route[0] if route else None
    return next((call for call in calls if call.before == first), None)


def with_calls(route: Iterable[str], calls: Sequence[Call]) -> tuple[str, ...]:
    """The tasks of a route and the stations between them, in order."""
    if not calls:
        return tuple(route)
    names: list[str] = []
    for task in route:
        names += [call.station for call in calls if call.before == task]
        names.append(task)
    return (*names, *(call.station for call in calls if call.before is None))
