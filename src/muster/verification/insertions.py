"""Inserts one more task in a route: whether the task can be reached, and the least usage of the route."""

from __future__ import annotations

import math

import numpy as np

from muster.mission.model import Mission, Point, Task
from muster.motion.grid import Floats
from muster.motion.leg_times import LegTimes
from muster.verification.measure import MeasuredRoute, Step, place_of_stop, work_seconds
from muster.verification.travel import Place, Travel, place_at_end, place_of_start, place_of_task


class Insertions:
    """The gaps of a route in which a task can be put: before each of its stops, and after the last one.

    Methods look at the gaps from number `first` on.
    """

    def __init__(self, mission: Mission, travel: Travel, route: MeasuredRoute) -> None:
        self._travel, self._route = travel, route
        self._times = LegTimes.in_mission(route.robot, mission)
        self._in_time = mission.rules.usage == "time"
        self._pace = 1 / route.robot.speed_mps if self._in_time else 1.0  # usage a metre
        end = place_at_end(route.robot, mission.rules)
        stops = [place_of_start(route.robot), *(place_of_stop(stop, route.robot) for stop in route.stops)]
        legs = [*(stop.leg for stop in route.stops), route.last_leg]
        self._gaps = list(zip(stops, [*stops[1:], end], strict=True))
        self._legs = np.array([leg.usage / self._pace if leg else 0.0 for leg in legs])
        self._passable = all(stop.leg.exists and (not isinstance(stop, Step) or stop.passable) for stop in route.stops)
        self._from = _rows([before.exit for before, _ in self._gaps])
        self._to = _rows([(after or before).entry for before, after in self._gaps])
        self._goes_on = np.array([after is not None for _, after in self._gaps])

    def is_reachable(self, task: Task, first: int) -> bool:
        """Whether a gap has a way to the task, along its way points and on, and the route has one elsewhere."""
        if not self._passable or self._travel.work_metres(self._route.robot, task) is None:
            return False
        place = place_of_task(task, self._route.robot)
        return any(math.isfinite(self._metres_more(k, place)) for k in range(first, len(self._gaps)))

    def least_usage(self, task: Task, first: int, capacity: float) -> float:
        """The usage of the route with the task in its best gap; inf where no gap has a way.

        Where a leg takes long to measure a usage that is not above `capacity` may not be the least one, and one above
        it may be too low, but not below `capacity`.
        """
        metres = self._travel.work_metres(self._route.robot, task)
        if metres is None or not self._passable:
            return math.inf
        work = work_seconds(self._times, self._travel, self._route.robot, task) if self._in_time else metres
        used = self._route.usage + work
        margin = 2 * self._travel.tolerance * capacity / self._pace
        return used + self._least_metres(task, first, (capacity - used) / self._pace, margin) * self._pace

    def _least_metres(self, task: Task, first: int, enough: float, margin: float) -> float:
        """What the task adds at least, measured where that is not plainly more than `enough`."""
        place = place_of_task(task, self._route.robot)
        least = self._at_least(place)[first:]
        if self._travel.is_straight:
            return float(least.min())
        best = math.inf
        for k in np.argsort(least, kind="stable").tolist():
            if best <= enough - margin:
                break
            if least[k] > min(best, enough + margin):
                return min(best, float(least[k]))
            best = min(best, self._metres_more(first + k, place))
        return best

    def _at_least(self, place: Place) -> Floats:
        """What the task adds at least to the metres travelled, for each gap: as if there were a straight way."""
        if self._travel.is_tabled:
            return np.full(len(self._gaps), -math.inf)
        there = np.linalg.norm(self._from - _rows([place.entry]), axis=1)
        on = np.linalg.norm(self._to - _rows([place.exit]), axis=1)
        return np.asarray(there + np.where(self._goes_on, on, 0.0) - self._legs)

    def _metres_more(self, k: int, place: Place) -> float:
        """What the task adds to the metres travelled in a gap; inf where there is no way."""
        before, after = self._gaps[k]
        there = self._travel.metres(self._route.robot, before, place)
        on = 0.0 if after is None else self._travel.metres(self._route.robot, place, after)
        return math.inf if there is None or on is None else there + on - float(self._legs[k])


def _rows(points: list[Point]) -> Floats:
    return np.array([(*point, 0.0)[:3] for point in points], dtype=np.float64)
