"""The limits of windows, deadlines and shifts that the earliest times break: then every schedule breaks one."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Protocol

from muster.mission.tasks import Task
from muster.verification.measure import MeasuredRoute, Step
from muster.verification.rules.shift import Shifts
from muster.verification.schedule_nodes import is_after, names_of, place_name
from muster.verification.station_queues import Name
from muster.verification.verdict import Violation


class Graph(Protocol):
    """The earliest times of routes, and the limits that they are to keep, as `schedule` has them."""

    routes: Sequence[MeasuredRoute]
    ignored: Sequence[str]
    task: dict[str, Task]
    windows: dict[str, list[tuple[float, float]]]
    shifts: dict[str, Shifts]
    begin: dict[Name, float]
    node_of: dict[Name, Name]
    seconds: dict[Name, float]

    def limit(self, limit: float) -> float:
        """Return a limit, moved by a margin."""
        ...

    def free(self, robot: str, before: Name | None) -> float:
        """Return when a robot may leave its start, or has ended a stop."""
        ...

    def back(self, route: MeasuredRoute) -> float:
        """Return when a route that has stops ends."""
        ...


def broken_limits(graph: Graph) -> Iterator[Violation]:
    """Yield a violation for each limit that the begins in a graph break."""
    for name, task in graph.task.items():
        yield from _of_task(graph, name, task)
    for route in graph.routes:
        if route.stops and "shift" not in graph.ignored:
            yield from list(_outside_shifts(graph, route)) or _after_last_shift(graph, route)


def _of_task(graph: Graph, name: str, task: Task) -> Iterator[Violation]:
    begin, windows = graph.begin[graph.node_of[name]], graph.windows.get(name)
    if windows and not _in_windows(windows, begin):
        yield Violation("window", None, name, _window_text(task, begin))
    if task.deadline_s is None or "deadline" in graph.ignored:
        return
    end = begin + graph.seconds[name]
    if is_after(end, graph.limit(task.deadline_s)):
        detail = f"ends at {end:,.10g} s at the earliest, its deadline is {task.deadline_s:,.10g} s"
        yield Violation("deadline", None, name, detail)


def _outside_shifts(graph: Graph, route: MeasuredRoute) -> Iterator[Violation]:
    """Yield a violation for each leg and work of a robot with several shifts that none is left for."""
    robot, shifts = route.robot.id, graph.shifts.get(route.robot.id)
    if shifts is None:
        return
    before: Name | None = None
    for name, stop in zip(names_of(route), route.stops, strict=True):
        place, free = place_name(name), graph.free(robot, before)
        if math.isinf(shifts.begin(free, stop.leg.seconds)):
            yield _shift_violation(robot, None, f"the way to {place}", free, stop.leg.seconds, _NONE_LEFT)
        begin = graph.begin[graph.node_of[name]]
        if isinstance(stop, Step) and is_after(first := shifts.begin(begin, stop.seconds), begin):
            why = _NONE_LEFT if math.isinf(first) else _TOO_LATE_THEN
            yield _shift_violation(robot, place, f"the work on {place}", begin, stop.seconds, why)
        before = name
    if route.last_leg is not None:
        free = graph.free(robot, before)
        if math.isinf(shifts.begin(free, route.last_leg.seconds)):
            yield _shift_violation(robot, None, "the way to its end", free, route.last_leg.seconds, _NONE_LEFT)


_NONE_LEFT = "no shift left has room for it"
_TOO_LATE_THEN = "that is not within a shift, and in the next one other limits forbid it"


def _shift_violation(robot: str, task: str | None, what: str, begin: float, seconds: float, why: str) -> Violation:
    return Violation(
        "shift", robot, task, f"{what} takes {seconds:,.10g} s from {begin:,.10g} s at the earliest; {why}"
    )


def _after_last_shift(graph: Graph, route: MeasuredRoute) -> Iterator[Violation]:
    until = route.robot.available_until_s
    if until is not None and is_after(back := graph.back(route), graph.limit(until)):
        detail = f"its route ends at {back:,.10g} s at the earliest, it is available until {until:,.10g} s"
        yield Violation("shift", route.robot.id, None, detail)


def _in_windows(windows: Sequence[tuple[float, float]], begin: float) -> bool:
    return any(not is_after(first, begin) and not is_after(begin, last) for first, last in windows)


def _window_text(task: Task, begin: float) -> str:
    close = task.window_s[-1][1]
    if close is None:  # tasks that begin together have windows of which none is open to all
        return f"begins at {begin:,.10g} s at the earliest, outside its windows"
    last = "" if len(task.window_s) == 1 else "last "
    return f"begins at {begin:,.10g} s at the earliest, its {last}window closes at {close:,.10g} s"
