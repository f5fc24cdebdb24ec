"""The earliest schedule of routes, or what forbids one (docs/design.md, Meaning).

[tcf-thesis] (3.25) compares the order within one route only. Here the graph of all routes and all prerequisites
is judged, which also finds robots that wait for each other for ever. Tasks that begin together are one node of it, and
so is a task with its team, and a visit of a station. Maximum lags are lower bounds of what comes before: the least
fixpoint of all bounds is the earliest schedule. Stations serve in an order that is known before: the plan's, or else
that of arrival, which is found by going through the visits as they happen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import replace
from graphlib import CycleError, TopologicalSorter
from itertools import pairwise

from muster.mission.task_relations import tied_by
from muster.mission.tasks import Task
from muster.verification.broken_limits import broken_limits
from muster.verification.measure import MeasuredRoute
from muster.verification.no_schedule import Rising, cycle_fault
from muster.verification.rules import RULES
from muster.verification.rules.shift import Shifts
from muster.verification.rules.span_rule import Span, SpanRule
from muster.verification.schedule_nodes import Bound, Deadlock, Links, Node, Schedule, Times, is_after, names_of
from muster.verification.station_queues import Name, Stations, Turn
from muster.verification.verdict import Violation

_MOST_ORDERS = 20
"""So many orders of arrival are tried where greatest lags change them."""


def schedule(routes: Sequence[MeasuredRoute], ignored: Sequence[str], margin: float = 0.0) -> Schedule | Deadlock:
    """Find the times of every stop, if each robot makes its stops in order, as early as it can.

    A robot leaves when it is available, and waits at a task for its team, the tasks that begin with it, its time window
    and its prerequisites with their lags, at a station for its turn, and where it stands for a shift that lasts until
    the end of its next leg or work. It leaves, and begins what another task delivers, later than that where a `Span`
    would be too long otherwise. All limits are earlier by `margin`, relative, or in seconds where they are below one; a
    margin below 0 makes them later.
    """
    kept = [rule for rule in RULES if isinstance(rule, SpanRule) and rule.holds(ignored)]
    spans = [span for rule in kept for route in routes if route.stops for span in rule.spans(route)]
    found = Graph(routes, ignored, margin, spans).solve()
    return _without_spans(routes, ignored, margin, spans) if spans and not found.is_kept else found


def _without_spans(
    routes: Sequence[MeasuredRoute], ignored: Sequence[str], margin: float, spans: Sequence[Span]
) -> Schedule | Deadlock:
    """Find the times of routes that break a limit; if the rest of the limits can be kept, say which spans break theirs.

    These are the spans that are too long by themselves; if there are none, those that are too long at these times.
    """
    graph = Graph(routes, ignored, margin, ())
    found = graph.solve()
    if isinstance(found, Deadlock) or found.broken:
        return found
    long = [span for span in spans if is_after(graph.seconds_of(span), span.most)]
    alone = [span for span in long if not Graph(routes, ignored, margin, [span]).solve().is_kept]
    broken = [
        Violation(span.kind, span.robot, span.before, span.text(graph.seconds_of(span)))
        for span in alone or long or spans
    ]
    return replace(found, broken=tuple(broken))


class Graph:
    """What bounds the begin of each node."""

    def __init__(
        self, routes: Sequence[MeasuredRoute], ignored: Sequence[str], margin: float, spans: Sequence[Span]
    ) -> None:
        self.routes, self.ignored, self.margin, self.spans = routes, ignored, margin, spans
        self.route = {route.robot.id: route for route in routes}
        self.task = {step.task.id: step.task for route in routes for step in route.steps}
        self.windows = {name: self._windows(task) for name, task in self.task.items() if task.window_s}
        self.shifts = {} if "shift" in ignored else Shifts.by_robot(routes, self.limit)
        self.crews = Shifts.by_task(routes, self.shifts) if self.shifts else {}
        self.stations = Stations(routes)
        self.seconds = {
            name: stop.seconds for route in routes for name, stop in zip(names_of(route), route.stops, strict=True)
        }
        self.node_of: dict[Name, Name] = {**self._units(), **{turn: turn for turn in self.stations.visits}}
        self.links = Links(routes, self.node_of, {})
        self._begin_anew()

    def _begin_anew(self) -> None:
        self.begin: dict[Name, float] = dict.fromkeys(self.node_of.values(), 0.0)
        self.leaves = {name: route.robot.available_from_s for name, route in self.route.items()}
        self.raised_by: dict[Name, Bound] = {}  # what has raised the begin of a node last, where no window has
        self.queues = self.stations.queues()

    def _link_nodes(self) -> None:
        nodes = {name: Node([]) for name in self.begin}
        for task in self.task.values():
            nodes[self.node_of[task.id]].tasks.append(task)
        for route in self.routes:
            before: Name | None = None
            for name, stop in zip(names_of(route), route.stops, strict=True):
                leg = (before, route.robot.id, stop.leg.seconds)
                nodes[self.node_of[name]].legs.append(leg)
                before = name
        for task in self.task.values():
            nodes[self.node_of[task.id]].awaited.extend(self._lags(task))
        self.links = Links(self.routes, self.node_of, nodes)

    def limit(self, limit: float) -> float:
        return limit - self.margin * max(1.0, abs(limit)) if math.isfinite(limit) else limit

    def _windows(self, task: Task) -> list[tuple[float, float]]:
        """When work may begin; empty: at any time."""
        if "window" in self.ignored:
            return []
        return [(first, math.inf if last is None else self.limit(last)) for first, last in task.window_s]

    def _starts(self, robot: str, time: float, seconds: float) -> float:
        """When a robot that is free begins a leg; at once where no shift is left for it."""
        begin = self.shifts[robot].begin(time, seconds) if robot in self.shifts else time
        return time if math.isinf(begin) else begin

    def free(self, robot: str, before: Name | None) -> float:
        """When a robot may leave its start, or has ended a stop."""
        return self.leaves[robot] if before is None else self.end(before)

    def _there(self, robot: str, before: Name | None, seconds: float) -> float:
        """When a robot is at its next stop, or at its end, after another stop."""
        return self._starts(robot, self.free(robot, before), seconds) + seconds

    def _units(self) -> dict[Name, Name]:
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
            (name, lag.after_s, math.inf if lag.within_s is None else self.limit(lag.within_s)) for name, lag in lags
        ]

    def solve(self) -> Schedule | Deadlock:
        if self._is_each_for_itself():
            self._follow_routes()
            return self._found()
        self._link_nodes()
        order = self._order({})
        if isinstance(order, Deadlock):
            return order
        if not self.queues:
            return self._least(order)
        return self._with_stations()

    def _with_stations(self) -> Schedule | Deadlock:
        stated = self.stations.stated(self._before({}))
        order = self._order(stated)
        if isinstance(order, Deadlock):
            return order
        if len(stated) == len(self.queues):
            return self._least(order)
        orders = self._serve_by_arrival(stated)
        return self._delayed_by_lags(orders, stated) if self._lagged else self._found()

    def _found(self) -> Schedule:
        return Schedule(self._times(), tuple(broken_limits(self)), *self._ends_of_routes())

    def _is_each_for_itself(self) -> bool:
        """Whether no robot waits for another: then there is no need for a graph."""
        if self.spans or self.stations.visits or len(self.task) < sum(len(route.steps) for route in self.routes):
            return False  # limits between moments, stations, or a team
        return len(self.begin) == len(self.task) and not any(map(self._lags, self.task.values()))

    def _follow_routes(self) -> None:
        for route in self.routes:
            before: Name | None = None
            for step in route.steps:
                arrives = self._there(route.robot.id, before, step.leg.seconds)
                self.begin[step.task.id] = self._open([step.task], arrives)
                before = step.task.id

    # --- orders ------------------------------------------------------------------------------------------------------

    def _before(self, orders: Mapping[str, Sequence[Turn]]) -> dict[Name, set[Name]]:
        """For each node those that begin before it, if stations serve in some orders."""
        graph = {
            name: {self.node_of[b] for b in (*(leg[0] for leg in node.legs), *(a[0] for a in node.awaited)) if b}
            for name, node in self.links.nodes.items()
        }
        for turns in orders.values():
            for first, second in pairwise(turns):
                graph[second].add(first)
        return graph

    def _order(self, orders: Mapping[str, Sequence[Turn]]) -> list[Name] | Deadlock:
        try:
            return list(TopologicalSorter(self._before(orders)).static_order())
        except CycleError as error:
            return Deadlock(cycle_fault(self.links, error.args[1][:-1]))  # graphlib repeats the first node at the end

    def _serve_by_arrival(self, stated: Mapping[str, Sequence[Turn]]) -> dict[str, list[Turn]]:
        """Go through all stops as they happen, greatest lags aside; the order in which each station serves."""
        self._begin_anew()

        def begin(name: Name) -> None:
            self.begin[name] = self._earliest(name)

        return self.stations.in_turn(self._before(stated), stated, self._arrives, begin)

    def _delayed_by_lags(
        self, orders: Mapping[str, Sequence[Turn]], stated: Mapping[str, Sequence[Turn]]
    ) -> Schedule | Deadlock:
        """The earliest schedule in which the orders are those of arrival, where greatest lags delay arrivals.

        An order in which bounds raise each other for ever says by these who arrives later.
        """
        for _ in range(_MOST_ORDERS):
            order = self._order(orders)
            if isinstance(order, Deadlock):
                return order
            found = self._least(order)
            self._go_through(order)
            by_arrival = self.stations.in_turn(self._before(stated), stated, self._arrives)
            if by_arrival == orders:
                return found
            orders = by_arrival
        names = ", ".join(name for name in self.queues if name not in stated)
        return Deadlock(Violation("deadlock", None, None, f"lags leave no order of arrival at {names}"))

    # --- the least times ---------------------------------------------------------------------------------------------

    @property
    def _lagged(self) -> int:
        """How many greatest lags and spans there are."""
        lags = (within for node in self.links.nodes.values() for _, _, within in node.awaited)
        return len(self.spans) + sum(map(math.isfinite, lags))

    def _least(self, order: Sequence[Name]) -> Schedule | Deadlock:
        """The least begins that keep all bounds, with nodes in an order in which each comes after what it waits for."""
        self._begin_anew()
        # Of a station with one slot the bounds are sums, as all others are; with more of them paths change.
        most = (self._lagged + 1) * (1 + sum(visit.station.slots > 1 for visit in self.stations.visits.values()))
        jumps, passes = self._windows_passed(), 0
        while True:
            self._go_through(order)
            delayed = self._delay_prerequisites()
            if not self._shorten_spans() and delayed is None:
                return self._found()
            # Between jumps to later windows bounds that still rise after so many passes do so for ever.
            passes += 1
            if self._windows_passed() != jumps:
                jumps, passes = self._windows_passed(), 0
            if passes > most and (self.spans or delayed is None):
                return Deadlock(Violation("deadlock", None, None, "no times keep all limits"))
            if passes > most and delayed is not None:
                return Deadlock(Rising(self.links, self.raised_by, self.seconds).fault(delayed))

    def _go_through(self, order: Sequence[Name]) -> None:
        """Raise begins to what comes before them."""
        self.queues = self.stations.queues()
        for name in order:
            self.begin[name] = self._earliest(name)

    def end(self, name: Name) -> float:
        return self.begin[self.node_of[name]] + self.seconds[name]

    def _arrives(self, turn: Turn) -> float:
        """When a robot is at a station."""
        ((before, robot, seconds),) = self.links.nodes[turn].legs
        return self._there(robot, before, seconds)

    def _bounds(self, name: Name) -> Iterator[tuple[float, Bound | None]]:
        """When a node may begin at the earliest, by each leg and prerequisite, and by the queue of a station."""
        node = self.links.nodes[name]
        for before, robot, seconds in node.legs:
            yield self._there(robot, before, seconds), None if before is None else Bound(before, seconds, robot)
        for awaited, after, _ in node.awaited:
            yield after + self.end(awaited), Bound(awaited, after)
        if isinstance(name, Turn):
            for free, turn in self.queues[name.station].bounds():
                yield free, Bound(turn, 0.0, queues=True)

    def _earliest(self, name: Name) -> float:
        """The begin of a node from what comes before it, and at least what it is now."""
        time = self.begin[name]
        for bound, why in self._bounds(name):
            if bound > time:
                time = bound
                self._raise(name, why)
        if isinstance(name, Turn):
            self.queues[name.station].take(name, time, self.seconds[name])
            return time
        later = self._open(self.links.nodes[name].tasks, time)
        if later > time:
            self._raise(name, None)
        return later

    def _raise(self, name: Name, why: Bound | None) -> None:
        if why is None:
            self.raised_by.pop(name, None)
        else:
            self.raised_by[name] = why

    def _open(self, tasks: Sequence[Task], time: float) -> float:
        """The first time from `time` on in a window of each task and in shifts that last; `time` where none is left."""
        if not self.windows and not self.crews:
            return time
        shifts = [len(own.times) for task in tasks for own in self.crews.get(task.id, ())]
        for _ in range(1 + sum(len(task.window_s) for task in tasks) + sum(shifts)):
            later = max(self._next(task, time) for task in tasks)
            if later == time or math.isinf(later):
                return time
            time = later
        return time

    def _next(self, task: Task, time: float) -> float:
        shifts = (own.begin(time, self.seconds[task.id]) for own in self.crews.get(task.id, ()))
        time = max(time, *shifts) if task.id in self.crews else time
        if not self.windows.get(task.id):
            return time
        left = [first for first, last in self.windows[task.id] if not is_after(time, last)]
        return max(time, min(left)) if left else math.inf

    def _windows_passed(self) -> int:
        """How many windows and shifts have ended before stops begin."""
        shifts = (
            self.shifts[name].over(self.begin[self.node_of[stop]])
            for name in self.shifts
            for stop in names_of(self.route[name])
        )
        return sum(shifts) + sum(
            is_after(self.begin[self.node_of[name]], last)
            for name, windows in self.windows.items()
            for _, last in windows
        )

    def _delay_prerequisites(self) -> Name | None:
        """Begin later what must not have ended too long before its dependant begins; the last such, if any."""
        found: Name | None = None
        for own, node in self.links.nodes.items():
            for name, _, within in node.awaited:
                least = self.begin[own] - within - self.seconds[name]
                delayed = self.node_of[name]
                if is_after(least, self.begin[delayed]):
                    self.begin[delayed], found = least, delayed
                    self.raised_by[delayed] = Bound(name, within, delays=own)
        return found

    def _shorten_spans(self) -> bool:
        """Begin later what comes too long before the end of a span; return whether anything does."""
        found = False
        for span in self.spans:
            least = self._last_of(span) - self.limit(span.most)
            if is_after(least, self._first_of(span)):
                found = True
                if span.after is None:
                    self.leaves[span.robot] = least
                else:
                    self.begin[self.node_of[span.after]] = least - self.seconds[span.after]
        return found

    def _first_of(self, span: Span) -> float:
        return self._departure(self.route[span.robot]) if span.after is None else self.end(span.after)

    def _departure(self, route: MeasuredRoute) -> float:
        name = route.robot.id
        return self._starts(name, self.leaves[name], route.stops[0].leg.seconds) if route.stops else self.leaves[name]

    def _ends_of_routes(self) -> tuple[dict[str, float], dict[str, float]]:
        """When each robot leaves its start, and when each route that has stops ends."""
        leaves = {name: self._departure(route) for name, route in self.route.items()}
        return leaves, {name: self.back(route) for name, route in self.route.items() if route.stops}

    def _last_of(self, span: Span) -> float:
        return self.back(self.route[span.robot]) if span.before is None else self.begin[self.node_of[span.before]]

    def seconds_of(self, span: Span) -> float:
        """Return how long a span takes at the times found."""
        return self._last_of(span) - self._first_of(span)

    def back(self, route: MeasuredRoute) -> float:
        """When a route that has stops ends."""
        last = names_of(route)[-1]
        if route.last_leg is None:
            return self.end(last)
        return self._there(route.robot.id, last, route.last_leg.seconds)

    def _times(self) -> dict[str, list[Times]]:
        return {route.robot.id: list(self._times_of(route)) for route in self.routes}

    def _times_of(self, route: MeasuredRoute) -> Iterator[Times]:
        before: Name | None = None
        for name, stop in zip(names_of(route), route.stops, strict=True):
            begin = self.begin[self.node_of[name]]
            yield Times(self._there(route.robot.id, before, stop.leg.seconds), begin, begin + stop.seconds)
            before = name
