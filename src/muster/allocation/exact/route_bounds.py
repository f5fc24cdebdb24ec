"""What a robot's route comes to at least with its calls at stations, over all ways to call: the proof behind cuts.

At each stop a robot can have used so much, and have so much energy by such times. Labels hold these; all sequences of
stations between two stops are looked at, and only a label that another covers is left out [desaulniers2016]. Where
there are too many labels nothing is said. A route is looked at by itself, as no robot gains by waiting for another.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np

from muster.allocation.exact import energy_curve
from muster.allocation.exact.energy_curve import Curve
from muster.allocation.problem import Floats, Problem
from muster.allocation.rules.battery import energy_at_start, energy_room
from muster.allocation.rules.load import Load
from muster.mission.stations import Station

_ROUNDING = 1e-9
_MOST_LABELS = 4_000  # of one route


class TooManyLabelsError(Exception):
    """There are more labels than are looked at."""


@dataclass(frozen=True)
class RouteBound:
    """What a route comes to at least; inf where it cannot be done.

    Parameters
    ----------
    usage
        with the way to the robot's end, where the route is whole.
    value
        what its tasks add to the objective: of `average` the sum of usages on arrival, of `makespan` the last end, of
        `lateness` the sum; 0 for others.
    """

    usage: float
    value: float


@dataclass(frozen=True)
class _Label:
    usage: float
    extra: float  # the sum of what the objective counts of each task
    ended: float  # when the last task ended at the earliest
    since: float  # seconds of ways since then; inf: the robot charged meanwhile
    curve: Curve
    put_down: tuple[float, ...]

    def covers(self, other: _Label) -> bool:
        return (
            self.usage <= other.usage
            and self.extra <= other.extra
            and self.ended <= other.ended
            and self.since <= other.since
            and self.put_down == other.put_down
            and energy_curve.covers(self.curve, other.curve)
        )


class RouteBounds:
    """The bounds of the routes of a problem."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._ways: dict[int, tuple[Floats, Floats]] = {}

    def of(self, i: int, route: Sequence[int], *, whole: bool) -> RouteBound | None:
        """Return the bound of all routes of robot i that begin with these tasks, or of the whole one; None: unknown."""
        try:
            labels = _Run(self, i, route).labels(whole=whole)
        except TooManyLabelsError:
            return None
        if not labels:
            return RouteBound(math.inf, math.inf)
        return RouteBound(min(label.usage for label in labels), min(map(self._value, labels)))

    def _value(self, label: _Label) -> float:
        if self.problem.objective == "makespan":
            with_return = self.problem.mission.rules.makespan_includes_return
            return max(label.ended, label.curve[0][0]) if with_return else label.ended
        return label.extra if self.problem.objective in ("average", "lateness") else 0.0

    def ways(self, i: int) -> tuple[Floats, Floats]:
        """(places, places) travel usage of a robot, and seconds."""
        if i not in self._ways:
            problem = self.problem
            places = np.arange(len(problem.tasks) + 2 * len(problem.robots) + len(problem.stations))
            self._ways[i] = problem.legs(i, places, places), problem.travel_seconds(i, places, places)
        return self._ways[i]

    @cached_property
    def loads(self) -> Any:
        """The arrays of loads, as the core has them."""
        return Load().core_arrays(self.problem)


class _Run:
    """The labels of one route, stop after stop."""

    def __init__(self, bounds: RouteBounds, i: int, route: Sequence[int]) -> None:
        self._problem, self._robot, self._i, self._route = bounds.problem, bounds.problem.robots[i], i, route
        self._usage, self._seconds = bounds.ways(i)
        self._work, self._takes = self._problem.work_usage(i), self._problem.work_seconds(i)
        self._full = energy_room(self._robot) if self._problem.holds("battery") else math.inf
        self._drains = math.isfinite(self._full)
        self._until = float(self._problem.timed_rules.available_until[i]) * (1 + _ROUNDING)
        self._most = float(self._problem.capacity[i]) * (1 + _ROUNDING) + _ROUNDING
        arrays, self._goods = bounds.loads, range(bounds.loads["commodities"])
        self._room = [float(arrays["load_capacity"][i, c]) for c in self._goods]
        self._loads = [tuple(float(arrays["load_at_start"][i, c]) for c in self._goods)]
        self._pending = [tuple(float(arrays["pending_at_start"][i, c]) for c in self._goods)]
        for j in route:
            self._loads.append(tuple(self._loads[-1][c] + float(arrays["load"][j, c]) for c in self._goods))
            self._pending.append(tuple(self._pending[-1][c] + float(arrays["pending"][j, c]) for c in self._goods))
        self._left = _MOST_LABELS

    def labels(self, *, whole: bool) -> list[_Label]:
        problem, start = self._problem, self._robot.available_from_s
        at_start = energy_at_start(problem, self._i) if self._drains else energy_curve.NEVER_EMPTY
        labels = [_Label(0.0, 0.0, 0.0, 0.0, [(start, at_start)], (0.0,) * len(self._goods))]
        place = problem.start(self._i)
        for stop, j in enumerate(self._route):
            labels = self._undominated(
                done for there in self._arrivals(labels, place, j, stop) for done in self._worked(there, j, stop + 1)
            )
            place = j
        if whole and self._robot.place_at_end(problem.mission.rules) is not None and self._route:
            return list(self._home(labels, place))
        return [label for label in labels if label.curve[0][0] <= self._until] if whole else labels

    def _home(self, labels: list[_Label], place: int) -> Iterator[_Label]:
        for label in self._arrivals(labels, place, self._problem.end(self._i), len(self._route)):
            if label.curve[0][0] <= self._until:
                yield label

    def _arrivals(self, labels: list[_Label], place: int, to: int, stop: int) -> Iterator[_Label]:
        """Labels at the next place, directly and by way of stations."""
        at: dict[int, list[_Label]] = {}
        waiting = [(place, label) for label in labels]
        while waiting:
            here, label = waiting.pop()
            yield from self._moved(label, here, to)
            for number, station in enumerate(self._problem.stations):
                there = len(self._problem.tasks) + 2 * len(self._problem.robots) + number
                if there == here:
                    continue
                for arrived in self._moved(label, here, there):
                    served = self._served(arrived, station, stop)
                    known = at.setdefault(there, [])
                    if served is not None and not any(other.covers(served) for other in known):
                        known[:] = [other for other in known if not served.covers(other)]
                        known.append(served)
                        waiting.append((there, served))

    def _moved(self, label: _Label, here: int, to: int) -> Iterator[_Label]:
        usage = float(self._usage[here, to])
        if not math.isfinite(usage) or label.usage + usage > self._most:
            return
        seconds = float(self._seconds[here, to])
        curve = energy_curve.shifted(label.curve, seconds, usage if self._drains else 0.0)
        if self._drains:
            curve = energy_curve.with_at_least(curve, -_ROUNDING * (1 + self._full))
        if curve:
            self._left -= 1
            if self._left < 0:
                raise TooManyLabelsError
            since = label.since + seconds  # for this way there was enough energy when the last task ended
            ended = max(label.ended, curve[0][0] - since)
            yield replace(label, usage=label.usage + usage, curve=curve, since=since, ended=ended)

    def _served(self, label: _Label, station: Station, stop: int) -> _Label | None:
        """A label at a station once the robot is served; None: nothing is put down that may be."""
        curve, since = label.curve, math.inf if self._drains and station.gives_energy else label.since
        if self._drains and station.swaps:
            curve = [(curve[0][0] + station.swap_s, self._full)]
        elif self._drains and station.charge_per_s is not None:
            serve = energy_curve.charged if station.partial else energy_curve.filled
            curve = serve(curve, station.charge_per_s, self._full)
        put_down = label.put_down
        if station.unloads and self._goods:
            put_down = tuple(self._loads[stop][c] - self._pending[stop][c] for c in self._goods)
        label = replace(label, curve=curve, put_down=put_down, since=since)
        return label if self._is_carried(label, stop) else None

    def _is_carried(self, label: _Label, stop: int) -> bool:
        loads = [self._loads[stop][c] - label.put_down[c] for c in self._goods]
        slack = [_ROUNDING * (1 + abs(room)) if math.isfinite(room) else _ROUNDING for room in self._room]
        return all(-slack[c] <= loads[c] <= self._room[c] + slack[c] for c in self._goods)

    def _worked(self, label: _Label, j: int, stop: int) -> Iterator[_Label]:
        """Labels at a task once the work is done, one for each of its windows."""
        rules, usage, takes = self._problem.timed_rules, float(self._work[j]), float(self._takes[j])
        if label.usage + usage > self._most or not self._is_carried(label, stop):
            return
        latest = (float(rules.deadline[j]) - takes) * (1 + _ROUNDING) + _ROUNDING
        for opens, closes in rules.windows[j] or ((-math.inf, math.inf),):
            curve = energy_curve.begun(label.curve, opens, min(latest, closes * (1 + _ROUNDING) + _ROUNDING))
            curve = energy_curve.shifted(curve, takes, usage if self._drains else 0.0)
            if self._drains:
                curve = energy_curve.with_at_least(curve, -_ROUNDING * (1 + self._full))
            if curve:
                ended = max(label.ended, curve[0][0])
                extra = label.extra + self._counted(label, j, ended)
                yield _Label(label.usage + usage, extra, ended, 0.0, curve, label.put_down)

    def _counted(self, label: _Label, j: int, ended: float) -> float:
        if self._problem.objective == "average":
            return label.usage
        if self._problem.objective == "lateness":
            return self._problem.tasks[j].priority * max(0.0, ended - float(self._problem.timed_rules.due[j]))
        return 0.0

    @staticmethod
    def _undominated(labels: Iterable[_Label]) -> list[_Label]:
        kept: list[_Label] = []
        for label in labels:
            if not any(other.covers(label) for other in kept):
                kept = [other for other in kept if not label.covers(other)]
                kept.append(label)
        return kept
