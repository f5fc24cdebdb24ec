"""The earliest schedule of routes, or what forbids one (docs/design.md, Meaning).

[tcf-thesis] (3.25) compares the order within one route only. Here the graph of all routes and all prerequisites
is judged, which also finds robots that wait for each other for ever. Tasks that begin together are one node of it, and
so is a task with its team. Maximum lags are lower bounds of what comes before: the least fixpoint of all bounds is the
earliest schedule.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from graphlib import CycleError, TopologicalSorter
from itertools import groupby, pairwise
from typing import NamedTuple

from muster.mission.plan import tie_order
from muster.mission.task_relations import tied_by
from muster.mission.tasks import Task
from muster.verification.measure import MeasuredRoute
from muster.verification.verdict import Violation

ROUNDING = 1e-9
"""By how much a time may be above a limit, relative, or in seconds where it is below one."""


class Times(NamedTuple):
    """When the robot is at a task, seconds."""

    arrives: float
    starts: float
    ends: float


@dataclass(frozen=True)
class Deadlock:
    """There is no schedule: tasks wait for each other in a cycle, which `violation` names step by step."""

    violation: Violation


@dataclass(frozen=True)
class Schedule:
    """By robot the times at the tasks of its route, in order; and the limits that these break."""

    times: Mapping[str, Sequence[Times]]
    broken: tuple[Violation, ...]


@dataclass(frozen=True)
class _Node:
    """Tasks that begin at the same moment."""

    tasks: list[Task]
    legs: list[tuple[str | None, str, float]] = field(default_factory=list)  # task before, robot, seconds of the leg
    awaited: list[tuple[str, float, float]] = field(default_factory=list)  # prerequisite, least and most lag


@dataclass(frozen=True)
class _Bound:
    """What raises the begin of a node: the end of a task, the begin of one that waits for it, and seconds.

    By a leg of `robot`, or without one by a lag: the most if `delays` the task before, else the least.
    """

    before: str
    seconds: float
    robot: str | None = None
    delays: str | None = None


def is_after(time: float, limit: float) -> bool:
    """Whether a time is later than a limit, by more than rounding."""
    return time > limit + ROUNDING * max(1.0, abs(limit))


def schedule(routes: Sequence[MeasuredRoute], ignored: Sequence[str], margin: float = 0.0) -> Schedule | Deadlock:
    """Find the times of every task, if each robot does its tasks in order, as early as it can.

    A robot leaves when it is available, and waits at a task for its team, the tasks that begin with it, its time window
    and its prerequisites with their lags. All limits are earlier by `margin`, relative, or in seconds where they are
    below one; a margin below 0 makes them later.
    """
    return _Graph(routes, ignored, margin).solve()


class _Graph:
    """What bounds the begin of each node."""

    def __init__(self, routes: Sequence[MeasuredRoute], ignored: Sequence[str], margin: float) -> None:
        self.routes, self.ignored, self.margin = routes, ignored, margin
        self.task = {step.task.id: step.task for route in routes for step in route.steps}
        self.windows = {name: self._windows(task) for name, task in self.task.items() if task.window_s}
        self.work = {step.task.id: step.work_s for route in routes for step in route.steps}
        self.node_of = self._units()
        self.begin = dict.fromkeys(self.node_of.values(), 0.0)
        self.nodes: dict[str, _Node] = {}
        self.raised_by: dict[str, _Bound] = {}  # what has raised the begin of a node last, where no window has

    def _link_nodes(self) -> None:
        self.nodes = {name: _Node([]) for name in self.begin}
        for name, task in self.task.items():
            self.nodes[self.node_of[name]].tasks.append(task)
        for route in self.routes:
            before = None
            for step in route.steps:
                own = self.nodes[self.node_of[step.task.id]]
                own.legs.append((before, route.robot.id, self._leaves(route, before) + step.leg.seconds))
                before = step.task.id
        for name, task in self.task.items():
            self.nodes[self.node_of[name]].awaited.extend(self._lags(task))

    def _limit(self, limit: float) -> float:
        return limit - self.margin * max(1.0, abs(limit)) if math.isfinite(limit) else limit

    def _windows(self, task: Task) -> list[tuple[float, float]]:
        """When work may begin; empty: at any time."""
        if "window" in self.ignored:
            return []
        return [(first, math.inf if last is None else self._limit(last)) for first, last in task.window_s]

    @staticmethod
    def _leaves(route: MeasuredRoute, before: str | None) -> float:
        return route.robot.available_from_s if before is None else 0.0

    def _units(self) -> dict[str, str]:
        """For each task the name of its node."""
        if "relation" in self.ignored:
            return {name: name for name in self.task}
        tasks = list(self.task.values())
        return {task.id: tasks[k].id for task, k in zip(tasks, tied_by("starts_with", tasks), strict=True)}

    def _lags(self, task: Task) -> list[tuple[str, float, float]]:
        if not task.prerequisites or "prerequisite" in self.ignored:
            return []
        lags = ((name, task.lag(name)) for name in task.prerequisites if name in self.task)
        return [
            (name, lag.after_s, math.inf if lag.within_s is None else self._limit(lag.within_s)) for name, lag in lags
        ]

    def solve(self) -> Schedule | Deadlock:
        if self._is_each_for_itself():
            self._follow_routes()
            return Schedule(self._times(), tuple(self._broken()))
        self._link_nodes()
        order = self._order()
        if isinstance(order, Deadlock):
            return order
        lagged = sum(math.isfinite(within) for node in self.nodes.values() for _, _, within in node.awaited)
        jumps, passes = self._windows_passed(), 0
        while True:
            for name in order:
                self.begin[name] = self._earliest(name)
            delayed = self._delay_prerequisites()
            if delayed is None:
                break
            # Between jumps to later windows bounds that still rise after so many passes do so for ever.
            passes += 1
            if self._windows_passed() != jumps:
                jumps, passes = self._windows_passed(), 0
            if passes > lagged + 1:
                return Deadlock(self._too_long(delayed))
        return Schedule(self._times(), tuple(self._broken()))

    def _is_each_for_itself(self) -> bool:
        """Whether no robot waits for another: then there is no need for a graph."""
        if len(self.task) < sum(len(route.steps) for route in self.routes):
            return False  # a team
        return len(self.begin) == len(self.task) and not any(map(self._lags, self.task.values()))

    def _follow_routes(self) -> None:
        for route in self.routes:
            time = route.robot.available_from_s
            for step in route.steps:
                begin = self._open([step.task], time + step.leg.seconds)
                self.begin[step.task.id] = begin
                time = begin + step.work_s

    def _order(self) -> list[str] | Deadlock:
        graph = {
            name: {self.node_of[b] for b in (*(leg[0] for leg in node.legs), *(a[0] for a in node.awaited)) if b}
            for name, node in self.nodes.items()
        }
        try:
            return list(TopologicalSorter(graph).static_order())
        except CycleError as error:
            cycle = error.args[1][:-1]  # graphlib repeats the first node at the end
            return Deadlock(Violation("deadlock", None, None, self._deadlock_text(cycle)))

    def _end(self, task: str) -> float:
        return self.begin[self.node_of[task]] + self.work[task]

    def _bounds(self, name: str) -> Iterator[tuple[float, _Bound | None]]:
        """When a node may begin at the earliest, by each leg and prerequisite."""
        for before, robot, seconds in self.nodes[name].legs:
            if before is None:
                yield seconds, None
            else:
                yield seconds + self._end(before), _Bound(before, seconds, robot)
        for before, after, _ in self.nodes[name].awaited:
            yield after + self._end(before), _Bound(before, after)

    def _earliest(self, name: str) -> float:
        """The begin of a node from what comes before it, and at least what it is now."""
        time = self.begin[name]
        for bound, why in self._bounds(name):
            if bound > time:
                time = bound
                self._raise(name, why)
        later = self._open(self.nodes[name].tasks, time)
        if later > time:
            self._raise(name, None)
        return later

    def _raise(self, name: str, why: _Bound | None) -> None:
        if why is None:
            self.raised_by.pop(name, None)
        else:
            self.raised_by[name] = why

    def _open(self, tasks: Sequence[Task], time: float) -> float:
        """The first time from `time` on that lies in a window of each task; `time` where none is left."""
        if not self.windows:
            return time
        for _ in range(1 + sum(len(task.window_s) for task in tasks)):
            later = max(self._next(task, time) for task in tasks)
            if later == time or math.isinf(later):
                return time
            time = later
        return time

    def _next(self, task: Task, time: float) -> float:
        if not self.windows.get(task.id):
            return time
        left = [first for first, last in self.windows[task.id] if not is_after(time, last)]
        return max(time, min(left)) if left else math.inf

    def _windows_passed(self) -> int:
        """How many windows have closed before their tasks begin."""
        return sum(
            is_after(self.begin[self.node_of[name]], last)
            for name, windows in self.windows.items()
            for _, last in windows
        )

    def _delay_prerequisites(self) -> str | None:
        """Begin later what must not have ended too long before its dependant begins; the last such, if any."""
        found = None
        for own, node in self.nodes.items():
            for name, _, within in node.awaited:
                least = self.begin[own] - within - self.work[name]
                delayed = self.node_of[name]
                if is_after(least, self.begin[delayed]):
                    self.begin[delayed], found = least, delayed
                    self.raised_by[delayed] = _Bound(name, within, delays=own)
        return found

    def _waiting(self, node: str, before: str) -> str:
        """The task of a node that waits for a prerequisite."""
        return next(task.id for task in self.nodes[node].tasks if before in task.prerequisites)

    def _too_long(self, delayed: str) -> Violation:
        """The cycle of bounds that raise each other for ever, in order; `delayed` is a node that they raise."""
        name = delayed
        for _ in self.nodes:
            name = self._raised_from(name)
        cycle = [name]
        while (before := self._raised_from(cycle[0])) != name:
            cycle.insert(0, before)
        bounds = [self.raised_by[node] for node in cycle if node in self.raised_by]
        late = next((bound.delays for bound in bounds if bound.delays), delayed)
        work = ", ".join(f"{b.before} takes {self.work[b.before]:,.10g} s" for b in bounds if not b.delays)
        said = "; ".join([*map(self._said, (node for node in cycle if node in self.raised_by)), work])
        detail = f"no times keep all of these: {said}" if work else "its lags and windows leave no times"
        return Violation("prerequisite", None, self.nodes[late].tasks[0].id, detail)

    def _raised_from(self, name: str) -> str:
        """The node that has raised the begin of a node; itself where a window has."""
        bound = self.raised_by.get(name)
        if bound is None:
            return name
        return bound.delays or self.node_of[bound.before]

    def _said(self, name: str) -> str:
        bound = self.raised_by[name]
        if bound.delays:
            return f"{self._waiting(bound.delays, bound.before)} begins at most {_after(bound)}"
        if bound.robot:
            return f"{bound.robot} comes to {self._task_after(bound.robot, bound.before)} {_after(bound)}"
        return f"{self._waiting(name, bound.before)} begins at least {_after(bound)}"

    def _times(self) -> dict[str, list[Times]]:
        return {route.robot.id: list(self._times_of(route)) for route in self.routes}

    def _times_of(self, route: MeasuredRoute) -> Iterator[Times]:
        leaves = route.robot.available_from_s
        for step in route.steps:
            begin = self.begin[self.node_of[step.task.id]]
            end = begin + step.work_s
            yield Times(leaves + step.leg.seconds, begin, end)
            leaves = end

    def _broken(self) -> list[Violation]:
        """The windows, deadlines and shifts that the earliest begins break: then every schedule breaks one."""
        found = []
        for name, task in self.task.items():
            begin, windows = self.begin[self.node_of[name]], self.windows.get(name)
            if windows and not _in_windows(windows, begin):
                found.append(Violation("window", None, name, _window_text(task, begin)))
            if task.deadline_s is None or "deadline" in self.ignored:
                continue
            end = begin + self.work[name]
            if is_after(end, self._limit(task.deadline_s)):
                detail = f"ends at {end:,.10g} s at the earliest, its deadline is {task.deadline_s:,.10g} s"
                found.append(Violation("deadline", None, name, detail))
        for route in self.routes:
            until = route.robot.available_until_s
            if not route.steps or until is None or "shift" in self.ignored:
                continue
            back = self._end(route.steps[-1].task.id) + (route.last_leg.seconds if route.last_leg else 0.0)
            if is_after(back, self._limit(until)):
                detail = f"its route ends at {back:,.10g} s at the earliest, it is available until {until:,.10g} s"
                found.append(Violation("shift", route.robot.id, None, detail))
        return found

    def _deadlock_text(self, cycle: Sequence[str]) -> str:
        """Describe the cycle step by step, and what makes each: `r_1: 2 -> 16; prerequisite: 16 -> 14; ...`."""
        links = [self._link(node, later) for node, later in pairwise([*cycle, cycle[0]])]
        # Prerequisites have no cycle and routes have none, so a route's step follows on a prerequisite somewhere.
        starts = [k for k in range(len(links)) if links[k][0] and not links[k - 1][0]] or [0]
        first = starts[tie_order([links[k][1] for k in starts])[0]]
        parts = []
        for label, steps in groupby([*links[first:], *links[:first]], key=lambda link: link[0] or "prerequisite"):
            (_, task, later), *others = steps
            parts.append(f"{label}: {' -> '.join([task, later, *(other for _, _, other in others)])}")
        return "; ".join(parts)

    def _link(self, node: str, later: str) -> tuple[str, str, str]:
        """What makes one node come before another: a robot, or nothing for a prerequisite; and the tasks."""
        for before, robot, _ in self.nodes[later].legs:
            if before is not None and self.node_of[before] == node:
                return robot, before, self._task_after(robot, before)
        name = next(name for name, _, _ in self.nodes[later].awaited if self.node_of[name] == node)
        return "", name, next(task.id for task in self.nodes[later].tasks if name in task.prerequisites)

    def _task_after(self, robot: str, before: str) -> str:
        steps = next(route.steps for route in self.routes if route.robot.id == robot)
        return next(after.task.id for first, after in pairwise(steps) if first.task.id == before)


def _after(bound: _Bound) -> str:
    return f"{bound.seconds:,.10g} s after {bound.before} ends"


def _in_windows(windows: Sequence[tuple[float, float]], begin: float) -> bool:
    return any(not is_after(first, begin) and not is_after(begin, last) for first, last in windows)


def _window_text(task: Task, begin: float) -> str:
    close = task.window_s[-1][1]
    if close is None:  # tasks that begin together have windows of which none is open to all
        return f"begins at {begin:,.10g} s at the earliest, outside its windows"
    last = "" if len(task.window_s) == 1 else "last "
    return f"begins at {begin:,.10g} s at the earliest, its {last}window closes at {close:,.10g} s"
