"""What a robot's route comes to at least with its calls at stations, over all ways to call: the proof behind cuts.

At each stop a robot can have used so much, and have so much energy by such times. Labels hold these; all sequences of
stations between two stops are looked at, and only a label that another covers is left out [desaulniers2016]. Where
there are too many labels nothing is said. A route is looked at by itself, as no robot gains by waiting for another.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass, replace

from muster.allocation.bounds import energy_curve
from muster.allocation.bounds.energy_curve import Curve
from muster.model.parts import Service
from muster.model.problem import Problem

_ROUNDING = 1e-9
_MOST_LABELS = 4_000  # of the way from one stop to the next


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
    since: float  # seconds of ways since then; inf: the robot got energy meanwhile
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
    """The bounds of the routes of a problem. Labels of beginnings of routes are kept."""

    def __init__(self, problem: Problem) -> None:
        self.problem = problem
        self._robots: dict[int, _Robot] = {}

    def of(self, i: int, route: Sequence[int], *, whole: bool) -> RouteBound | None:
        """Return the bound of all routes of robot i that begin with these tasks, or of the whole one; None: unknown."""
        try:
            labels = self._robot(i).labels(tuple(route), whole=whole)
        except TooManyLabelsError:
            return None
        if not labels:
            return RouteBound(math.inf, math.inf)
        return RouteBound(min(label.usage for label in labels), min(map(self._value, labels)))

    def excludes(self, i: int, route: Sequence[int]) -> bool:
        """Return whether robot i cannot do a route, wherever it calls at stations."""
        bound = self.of(i, route, whole=True)
        return bound is not None and math.isinf(bound.usage)

    def _robot(self, i: int) -> _Robot:
        if i not in self._robots:
            self._robots[i] = _Robot(self.problem, i)
        return self._robots[i]

    def _value(self, label: _Label) -> float:
        if self.problem.objective == "makespan":
            with_return = self.problem.mission.rules.makespan_includes_return
            return max(label.ended, label.curve[0][0]) if with_return else label.ended
        return label.extra if self.problem.objective in ("average", "lateness") else 0.0


class _Robot:
    """The labels of one robot's routes, stop after stop."""

    def __init__(self, problem: Problem, i: int) -> None:
        self._problem, self._robot, self._i = problem, problem.robots[i], i
        self._ways: dict[tuple[int, int], tuple[float, float]] = {}
        self._work, self._takes = problem.work_usage(i), problem.work_seconds(i)
        self._full = float(problem.model.energy[i])
        self._drains = math.isfinite(self._full)
        self._until = float(problem.model.over_by[i]) * (1 + _ROUNDING)
        self._most = float(problem.capacity[i]) * (1 + _ROUNDING) + _ROUNDING
        self._goods = range(len(problem.model.meters))
        self._room = [float(meter.most[i]) for meter in problem.model.meters]
        self._known: dict[tuple[int, ...], list[_Label]] = {(): [self._first()]}
        self._left = 0

    def _first(self) -> _Label:
        at_start = float(self._problem.model.energy_at_start[self._i])
        nothing = (0.0,) * len(self._goods)
        return _Label(0.0, 0.0, 0.0, 0.0, [(self._robot.available_from_s, at_start)], nothing)

    def labels(self, route: tuple[int, ...], *, whole: bool) -> list[_Label]:
        """The labels after the last task of a route; `whole`: at its end."""
        labels = self._after(route)
        if whole and self._robot.place_at_end(self._problem.mission.rules) is not None and route:
            return list(self._home(labels, route))
        return [label for label in labels if label.curve[0][0] <= self._until] if whole else labels

    def _after(self, route: tuple[int, ...]) -> list[_Label]:
        if route not in self._known:
            before = self._after(route[:-1])
            self._start_step(route[:-1])
            loads = self._on_board(route)
            self._known[route] = self._undominated(
                done
                for there in self._arrivals(before, self._place(route[:-1]), route[-1])
                for done in self._worked(there, route[-1], loads)
            )
        return self._known[route]

    def _start_step(self, route: tuple[int, ...]) -> None:
        self._left = _MOST_LABELS
        self._loads = self._on_board(route)
        self._kept = self._to_deliver(route)

    def _place(self, route: tuple[int, ...]) -> int:
        return route[-1] if route else self._problem.start(self._i)

    def _on_board(self, route: tuple[int, ...]) -> tuple[float, ...]:
        """The loads after a route as if the robot never unloaded."""
        tasks = list(route)
        return tuple(float(m.at_start[self._i] + m.change[tasks].sum()) for m in self._problem.model.meters)

    def _to_deliver(self, route: tuple[int, ...]) -> tuple[float, ...]:
        """What of that other tasks are going to deliver: it stays on board where the robot unloads."""
        tasks = list(route)
        return tuple(float(m.pending_at_start[self._i] + m.pending[tasks].sum()) for m in self._problem.model.meters)

    def _home(self, labels: list[_Label], route: tuple[int, ...]) -> Iterator[_Label]:
        self._start_step(route)
        for label in self._arrivals(labels, route[-1], self._problem.end(self._i)):
            if label.curve[0][0] <= self._until:
                yield label

    def _arrivals(self, labels: list[_Label], place: int, to: int) -> Iterator[_Label]:
        """Labels at the next place, directly and by way of stations."""
        at: dict[int, list[_Label]] = {}
        waiting = [(place, label) for label in labels]
        first = len(self._problem.tasks) + 2 * len(self._problem.robots)
        stations = () if to in self._problem.model.parts.over else self._problem.model.stations
        while waiting:
            here, label = waiting.pop()
            yield from self._moved(label, here, to)
            for there, station in enumerate(stations, first):
                if not self._problem.model.may_call(self._i, there - first):
                    continue
                for arrived in self._moved(label, here, there) if there != here else ():
                    served, known = self._served(arrived, station), at.setdefault(there, [])
                    if served is not None and not any(other.covers(served) for other in known):
                        known[:] = [other for other in known if not served.covers(other)]
                        known.append(served)
                        waiting.append((there, served))

    def _way(self, here: int, to: int) -> tuple[float, float]:
        """The usage and the seconds of a way."""
        if (here, to) not in self._ways:
            usage = self._problem.legs(self._i, [here], [to])[0, 0]
            seconds = self._problem.travel_seconds(self._i, [here], [to])[0, 0]
            self._ways[here, to] = float(usage), float(seconds)
        return self._ways[here, to]

    def _moved(self, label: _Label, here: int, to: int) -> Iterator[_Label]:
        usage, seconds = self._way(here, to)
        if not math.isfinite(usage) or label.usage + usage > self._most:
            return
        curve = energy_curve.moved(label.curve, seconds, usage if self._drains else 0.0)
        if self._drains:
            curve = energy_curve.with_at_least(curve, -_ROUNDING * (1 + self._full))
        if curve:
            self._left -= 1
            if self._left < 0:
                raise TooManyLabelsError
            since = label.since + seconds  # for this way there was enough energy when the last task ended
            ended = max(label.ended, curve[0][0] - since)
            yield replace(label, usage=label.usage + usage, curve=curve, since=since, ended=ended)

    def _served(self, label: _Label, station: Service) -> _Label | None:
        """A label at a station once the robot is served; None: it would put down more than it has."""
        refill = station.refill if self._drains else None
        curve, since = label.curve, math.inf if refill is not None else label.since
        if refill is not None and refill.rate is None:
            curve = [(curve[0][0] + refill.whole_s, self._full)]
        elif refill is not None and refill.rate is not None:
            fill = energy_curve.filled_partly if refill.partial else energy_curve.filled_up
            curve = fill(curve, refill.rate, self._full)
        put_down = label.put_down
        if station.unloads and self._goods:
            put_down = tuple(self._loads[c] - self._kept[c] for c in self._goods)
        label = replace(label, curve=curve, put_down=put_down, since=since)
        return label if self._is_carried(label, self._loads) else None

    def _is_carried(self, label: _Label, on_board: Sequence[float]) -> bool:
        loads = [on_board[c] - label.put_down[c] for c in self._goods]
        slack = [_ROUNDING * (1 + abs(room)) if math.isfinite(room) else _ROUNDING for room in self._room]
        return all(-slack[c] <= loads[c] <= self._room[c] + slack[c] for c in self._goods)

    def _worked(self, label: _Label, j: int, on_board: Sequence[float]) -> Iterator[_Label]:
        """Labels at a task once the work is done, one for each span in which it may begin."""
        rules, usage, takes = self._problem.model, float(self._work[j]), float(self._takes[j])
        if label.usage + usage > self._most or not self._is_carried(label, on_board):
            return
        latest = (float(rules.ends_by[j]) - takes) * (1 + _ROUNDING) + _ROUNDING
        for opens, closes in rules.openings[j] or ((-math.inf, math.inf),):
            curve = energy_curve.begun(label.curve, opens, min(latest, closes * (1 + _ROUNDING) + _ROUNDING))
            curve = energy_curve.moved(curve, takes, usage if self._drains else 0.0)
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
            return self._problem.tasks[j].priority * max(0.0, ended - float(self._problem.model.due[j]))
        return 0.0

    @staticmethod
    def _undominated(labels: Iterable[_Label]) -> list[_Label]:
        kept: list[_Label] = []
        for label in labels:
            if not any(other.covers(label) for other in kept):
                kept = [other for other in kept if not label.covers(other)]
                kept.append(label)
        return kept
