"""The best plan of a tiny mission with rules of every kind, by trying all routes. The judge is the oracle.

It is for four tasks, three robots and two stations at most. Between two tasks a robot goes to each station once at
most, and to none where nothing changes on board or in the battery: without travel tables that is only a detour. A
charge is full; where times count it may also be just what is needed up to the next station that gives energy, or to
the end of the route. Where times count and stations have too few slots all orders in which they serve are tried.

Routes are judged one by one first: what breaks a rule of one robot breaks it in every plan. Of each set of routes the
figures that they have alone bound the objective from below, as no robot gains by waiting for another.
"""

from collections import defaultdict
from dataclasses import dataclass, replace
from functools import cached_property
from itertools import product
from math import prod

from muster.mission.goods import by_commodity
from muster.mission.plan import Plan, Route, RouteStop
from muster.verification import Verdict, verify

TINY = 1e-9
LASTING = {"skill", "suitability", "lock", "unreachable", "window", "deadline"}
"""Kinds of violation by one route that no more stops take away."""
LASTING_WAYS = {"capacity", "shift"}
"""The same where the triangle inequality holds: no task is left elsewhere than entered, and shortens the way home."""
MOST_TOGETHER = 40_000  # sets of routes of one weight that are sorted


@dataclass(frozen=True)
class Best:
    """A best plan, its weight and the value of its objective."""

    weight: float
    objective: float
    plan: Plan


@dataclass(frozen=True)
class Own:
    """One robot's route, with the amounts that it charges, and the figures that it has alone, by task where it can."""

    names: tuple[str, ...]
    charged: tuple[float | None, ...]
    tasks: tuple[str, ...]
    usage: float
    arrivals: dict[str, float]
    ends: float
    late: dict[str, float]


def best_plan(mission, ignore=()):
    """The best of all plans that the judge finds valid; the empty one is among them."""
    return JudgedPlans(mission, ignore).best()


class JudgedPlans:
    """The plans of a mission, as far as the judge finds them valid.

    `most` is how many sets of routes are judged; None: all. `complete` tells whether all were that had to be.
    """

    def __init__(self, mission, ignore=(), most=None):
        assert mission.travel_rule != "matrix"
        self.mission, self.ignore = mission, ignore
        self.tasks = {task.id: task for task in mission.tasks}
        self.stations = {station.id: station for station in mission.stations}
        self.left, self.complete = most, True
        self._full = {}
        is_left_elsewhere = any(task.entry or task.exit for task in mission.tasks)
        self._lasting = LASTING if is_left_elsewhere else LASTING | LASTING_WAYS

    @cached_property
    def times_count(self):
        """Whether when something happens makes a difference, beside who does what in which order."""
        limits = any(t.window_s or t.deadline_s is not None or t.lags or t.starts_with for t in self.mission.tasks)
        late = any(robot.available_until_s is not None for robot in self.mission.robots)
        team = self.mission.rules.usage == "time" and any(task.is_for_team for task in self.mission.tasks)
        return limits or late or team or self.mission.rules.objective in ("makespan", "lateness")

    # --- routes of one robot ---------------------------------------------------------------------------------------

    @cached_property
    def routes(self):
        """For each robot the routes that break no rule by themselves; the empty one first."""
        return [self._routes_of(robot) for robot in self.mission.robots]

    def _routes_of(self, robot):
        found = [self._own(robot, (), ())]
        self._grow(robot, (), found)
        if self.times_count:
            return found
        best = {}
        for own in found:  # of stations only the detour counts
            arrivals = sum(own.arrivals.values())
            key = (own.usage, arrivals) if self.mission.rules.objective != "average" else (arrivals, own.usage)
            if own.tasks not in best or key < best[own.tasks][0]:
                best[own.tasks] = (key, own)
        return [own for _, own in best.values()]

    def _grow(self, robot, names, found):
        for name in self._next(robot, names):
            longer = (*names, name)
            if not self._may_go_on(robot, longer):
                continue
            if self._is_whole(robot, longer):
                found.extend(self._own(robot, longer, charged) for charged in self._amounts(robot, longer))
            self._grow(robot, longer, found)

    def _next(self, robot, names):
        yield from (name for name, task in self.tasks.items() if name not in names and task.delivers in (None, *names))
        gap = []
        for name in reversed(names):
            if name in self.tasks:
                break
            gap.append(name)
        if len(gap) < 2 and (robot.battery is not None or any(task.load for task in self.tasks.values())):
            yield from (name for name in self.stations if name not in gap)

    def _may_go_on(self, robot, names):
        """Whether the last stop of a route keeps its rules, and changes something if it is a station."""
        verdict = self._alone(robot, names)
        if any(fault.kind in self._lasting for fault in verdict.violations):
            return False
        stops = _route_in(verdict, robot).stops
        if not stops:
            return False
        last = stops[-1]
        before = stops[-2].load_after if len(stops) > 1 else by_commodity(robot.load_at_start)
        if any(" on board after" in fault.detail for fault in verdict.violations):
            return False
        if robot.battery is not None and "battery" not in self.ignore:
            least = robot.battery.least - TINY * robot.battery.capacity
            if min(last.arrival_level, last.level_after) < least:
                return False
        charges = last.charged is not None and last.charged > TINY
        unloads = dict(before) != dict(last.load_after)
        return not last.is_station or charges or unloads

    def _is_whole(self, robot, names):
        """Whether a route may end so: pairs in it, and no station last where the robot need not go on."""
        delivered = {task.delivers for task in self.tasks.values() if task.delivers in names}
        pairs = all(any(self.tasks[n].delivers == p for n in names if n in self.tasks) for p in delivered)
        needless = names[-1] in self.stations and robot.place_at_end(self.mission.rules) is None
        return (pairs or "load" in self.ignore) and not needless

    def _amounts(self, robot, names):
        """What is charged at each stop: None for a full charge, and where no charge is."""
        route = _route_in(self._alone(robot, names), robot)
        partial = [k for k, stop in enumerate(route.stops) if stop.charged and self._is_partial(stop.name)]
        full = (None,) * len(names)
        yield full
        if not self.times_count or not partial:
            return
        for chosen in product((False, True), repeat=len(partial)):
            amounts = self._needed(robot, route, {k for k, is_needed in zip(partial, chosen, strict=True) if is_needed})
            if amounts is not None and amounts != full:
                yield amounts

    def _is_partial(self, name):
        station = self.stations.get(name)
        return station is not None and station.charges and station.partial

    def _needed(self, robot, route, chosen):
        """The amounts with which a battery is at its reserve where the next charge begins, or at the end of the route.

        None where that is more than there is room for, or nothing.
        """
        leaving = [robot.battery.level_at_start, *(stop.level_after for stop in route.stops)]
        draws = [start - stop.arrival_level for start, stop in zip(leaving, route.stops, strict=False)]
        works = [stop.arrival_level - stop.level_after if not stop.is_station else 0.0 for stop in route.stops]
        last = route.usage - sum(draws) - sum(works)
        level, amounts = robot.battery.level_at_start, []
        for k, stop in enumerate(route.stops):
            level -= draws[k] + works[k]
            amount = None
            if stop.charged is not None and k in chosen:
                until = next((n for n in range(k + 1, len(draws)) if route.stops[n].charged is not None), None)
                ahead = range(k + 1, len(draws) if until is None else until + 1)
                need = sum(draws[n] + works[n] for n in ahead) + (last if until is None else 0.0)
                amount = need + robot.battery.least - level
                if not 0 < amount <= robot.battery.capacity - level:
                    return None
                level += amount
            elif stop.charged is not None:
                level = robot.battery.capacity
            amounts.append(amount)
        return tuple(amounts)

    def _own(self, robot, names, charged):
        is_full = all(amount is None for amount in charged)
        verdict = self._alone(robot, names) if is_full else self._judge([self._stated(robot.id, names, charged)])
        route = _route_in(verdict, robot)
        ends = [visit.ends_s for visit in route.visits]
        if self.mission.rules.makespan_includes_return and route.back_s is not None:
            ends.append(route.back_s)
        return Own(
            names=names,
            charged=charged,
            tasks=route.tasks,
            usage=route.usage,
            arrivals={visit.task: visit.arrival_usage for visit in route.visits},
            ends=max(ends, default=0.0),
            late={visit.task: self._lateness(visit) for visit in route.visits},
        )

    def _lateness(self, visit):
        task = self.tasks[visit.task]
        return 0.0 if task.due_s is None else task.priority * max(0.0, visit.ends_s - task.due_s)

    # --- plans -----------------------------------------------------------------------------------------------------

    def best(self):
        """Go through all plans from the highest weight and the lowest bound on; the first valid one bounds the rest."""
        for weight in sorted(self._classes, reverse=True):
            best = None
            for plan in self._in_order(self._classes[weight]):
                if best is not None and self._bound(plan) >= best.objective - TINY:
                    break
                for found in self._judged(plan):
                    if best is None or found.objective < best.objective:
                        best = found
                if self.left is not None and self.left <= 0:
                    self.complete = False
                    break
            if best is not None:
                return replace(best, plan=self._restated(best.plan))
        raise AssertionError("the empty plan is valid")

    def find(self, is_wanted, most=None):
        """A valid plan of which `is_wanted` holds, asked of the tasks of each robot in order; None: there is none.

        `most` is how many are judged; beyond, none is said to be found.
        """
        kept, left, seen = self.left, most, self.complete
        self.left = left
        try:
            for sets in self._classes.values():
                for plan in self._in_order([sorted_out for sorted_out in sets if self._may_be(sorted_out, is_wanted)]):
                    if is_wanted(tuple(own.tasks for own in plan)):
                        for found in self._judged(plan):
                            return self._restated(found.plan)
                        if self.left is not None and self.left <= 0:
                            return None
        finally:
            self.left, self.complete = kept, seen
        return None

    def _may_be(self, chosen, is_wanted):
        return any(is_wanted(orders) for orders in product(*({own.tasks for own in group} for group in chosen)))

    @cached_property
    def _classes(self):
        """By weight the sets of tasks, one a robot, that can make a plan, each as the routes that do them."""
        groups = []
        for routes in self.routes:
            by_tasks = defaultdict(list)
            for own in routes:
                by_tasks[frozenset(own.tasks)].append(own)
            groups.append(by_tasks)
        classes = defaultdict(list)
        for chosen in product(*groups):
            done = frozenset[str]().union(*chosen)
            if all(self._has_robots(name, chosen) for name in done) and self._keeps_together(done):
                weight = round(sum(self.tasks[name].priority for name in sorted(done)), 9)
                classes[weight].append([group[tasks] for group, tasks in zip(groups, chosen, strict=True)])
        return classes

    def _in_order(self, sets):
        """The plans of sets of routes, those with the lowest bound first."""
        if sum(prod(map(len, chosen)) for chosen in sets) > MOST_TOGETHER:
            self.complete = False
            return []
        return sorted((plan for chosen in sets for plan in product(*chosen)), key=self._bound)

    def _has_robots(self, name, chosen):
        """Whether as many robots do a task as it needs, as far as their number tells."""
        task, members = self.tasks[name], [k for k, tasks in enumerate(chosen) if name in tasks]
        if "team" in self.ignore:
            return len(members) == 1
        if task.needs is not None:
            return True
        needed = sum(part.count for part in task.team) if task.team else task.robots_needed or 1
        return len(members) == needed

    def _keeps_together(self, done):
        links = [(task, name) for task in self.tasks.values() for name in task.prerequisites]
        together = all(name in done for task, name in links if task.id in done)
        tied = all((name in done) == (task.id in done) for task in self.tasks.values() for name in task.starts_with)
        return (together or "prerequisite" in self.ignore) and (tied or "relation" in self.ignore)

    def _bound(self, plan):
        """The objective of a plan, as if no robot waited for another."""
        usages = [own.usage for own in plan]
        values = {
            "total": sum(usages),
            "max": max(usages),
            "total+max": sum(usages) + max(usages),
            "average": _mean(_of_teams(own.arrivals for own in plan)),
            "makespan": max(own.ends for own in plan),
            "lateness": sum(_of_teams(own.late for own in plan).values()),
        }
        return values[self.mission.rules.objective]

    def _judged(self, plan):
        """The plan as far as the judge finds it valid: in order of arrival, and where times count in all orders."""
        routes = list(zip(self.mission.robots, plan, strict=True))
        if not self.times_count or not any(self._has_turns(plan, name) for name in self.stations):
            is_full = [all(amount is None for amount in own.charged) for own in plan]
            yield from self._valid(
                [
                    Route(robot.id, own.names) if full else self._stated(robot.id, own.names, own.charged)
                    for (robot, own), full in zip(routes, is_full, strict=True)
                ]
            )
            return
        for turns in product(*(self._orders(plan, name) for name in self.stations)):
            numbers = {place: number for order in turns for number, place in enumerate(order)}
            yield from self._valid(
                [
                    self._stated(
                        robot.id, own.names, own.charged, [numbers.get((i, k), 0) for k in range(len(own.names))]
                    )
                    for i, (robot, own) in enumerate(routes)
                ]
            )

    def _has_turns(self, plan, station):
        """Whether more robots come to a station than it has slots."""
        return sum(station in own.names for own in plan) > self.stations[station].slots

    def _orders(self, plan, station):
        """All orders in which a station may serve: of visits (robot, place in its route)."""
        visits = [[(i, k) for k, name in enumerate(own.names) if name == station] for i, own in enumerate(plan)]
        for merged in _merges([len(own) for own in visits]):
            yield [visits[i][number] for i, number in merged]

    def _stated(self, robot, names, charged, begins=None):
        """A route that says who is served when, by numbers in place of times."""
        stops = [
            RouteStop(name, 0, begin, 0, name in self.stations, amount)
            for name, amount, begin in zip(names, charged, begins or range(len(names)), strict=True)
        ]
        return Route(robot, names, stops=tuple(stops))

    def _restated(self, plan):
        """The plan with the times of the schedule in the place of numbers."""
        times = {route.robot: route.stops for route in self._judge(plan.routes).routes}
        return Plan(
            routes=tuple(
                replace(
                    route,
                    stops=tuple(
                        replace(stop, arrive_s=found.arrives_s, begin_s=found.starts_s, end_s=found.ends_s)
                        for stop, found in zip(route.stops, times[route.robot], strict=False)
                    ),
                )
                for route in plan.routes
            )
        )

    def _valid(self, routes):
        if self.left is not None:
            self.left -= 1
        verdict = self._judge(routes)
        if all(fault.kind == "stop" for fault in verdict.violations):  # times, which are numbers yet
            yield Best(verdict.weight_completed, verdict.value(), Plan(routes=tuple(routes)))

    def _alone(self, robot, names):
        """The verdict of one route alone, with full charges."""
        if (robot.id, names) not in self._full:
            self._full[robot.id, names] = self._judge([Route(robot.id, names)])
        return self._full[robot.id, names]

    def _judge(self, routes) -> Verdict:
        return verify(self.mission, Plan(routes=tuple(routes)), self.ignore)


def _route_in(verdict, robot):
    return next(route for route in verdict.routes if route.robot == robot.id)


def _of_teams(figures):
    """Of each task the largest figure of its robots."""
    largest = {}
    for own in figures:
        for name, figure in own.items():
            largest[name] = max(figure, largest.get(name, 0.0))
    return largest


def _mean(values):
    return sum(values.values()) / max(1, len(values))


def _merges(lengths):
    """All orders of items (list, place in it) that keep those of some lists."""
    if not any(lengths):
        yield []
        return
    for i, length in enumerate(lengths):
        if length:
            for merged in _merges([*lengths[:i], length - 1, *lengths[i + 1 :]]):
                yield [*merged, (i, length - 1)]
