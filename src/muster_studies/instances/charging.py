"""Batteries and stations for instances of Solomon, in the manner of Schneider, Stenger and Goeke [schneider2014].

A battery lasts for 0.6 of the mean route of the best plan without batteries, and from the farthest customer to its
station and back; filling it takes as long as three customers. A window that nobody can keep who charges is opened.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import replace
from random import Random
from types import MappingProxyType

from muster.mission.model import Mission, Robot, Task
from muster.mission.stations import Battery, Station
from muster_studies.instances.solomon import REFERENCES, solomon_instance

Place = tuple[float, ...]

_STATIONS = 20
_SHARE_OF_ROUTE = 0.6
_CUSTOMERS_A_CHARGE = 3
_ROBOTS = 2
"""So many times the robots of the plan without batteries."""
_CLEAR = 1.0
"""Windows are opened by so much more than they must be."""

CHARGING_REFERENCES: Mapping[tuple[str, int], float] = MappingProxyType(
    {("R101", 0): 1912.1572, ("C101", 0): 1448.0674}
)
"""By instance and seed: the total that `search` found in 150 s of processor time."""


def charging_mission(name: str, seed: int) -> Mission:
    """Solomon's instance of that name with batteries, a station at the depot and 20 at places of a seed."""
    fleet = min(robots for instance, robots in REFERENCES if instance == name)
    mission = solomon_instance(name, _ROBOTS * fleet, loads=True)
    draw = Random(f"charging {name} {seed}")
    robot, tasks = mission.robots[0], mission.tasks
    xs, ys = zip(*(task.position[:2] for task in tasks), strict=True)
    places = [robot.position]
    places += [(draw.uniform(min(xs), max(xs)), draw.uniform(min(ys), max(ys))) for _ in range(_STATIONS)]
    farthest = max(min(math.dist(task.position, place) for place in places) for task in tasks)
    capacity = max(_SHARE_OF_ROUTE * REFERENCES[name, fleet] / fleet, 2 * farthest)
    full_s = _CUSTOMERS_A_CHARGE * sum(task.duration_s or 0.0 for task in tasks) / len(tasks)
    rides = _Rides(robot, places, capacity, full_s)
    return replace(
        mission,
        name=f"charging-{name}-{seed}",
        robots=tuple(replace(each, battery=Battery(capacity=capacity)) for each in mission.robots),
        tasks=tuple(_opened(task, rides) for task in tasks),
        stations=tuple(_station(k, place, len(mission.robots), capacity / full_s) for k, place in enumerate(places)),
    )


def _station(number: int, place: Place, slots: int, per_s: float) -> Station:
    return Station(
        id=f"S{number}", position=place, services=("charge",), slots=slots, charge_per_s=per_s, partial=False
    )


class _Rides:
    """How early a robot is at a place, and how late it may leave it, with at most one charge each way."""

    def __init__(self, robot: Robot, stations: Sequence[Place], capacity: float, full_s: float) -> None:
        self._depot, self._stations, self._capacity, self._full_s = robot.position, stations, capacity, full_s
        self._until = robot.available_until_s or math.inf

    def _out(self, place: Place) -> list[tuple[float, float]]:
        """From the depot: seconds, and what is used up since the last charge."""
        found = [(math.dist(self._depot, place),) * 2]
        for station in self._stations:
            to, on = math.dist(self._depot, station), math.dist(station, place)
            if to <= self._capacity:
                found.append((to + to * self._full_s / self._capacity + on, on))
        return found

    def _back(self, place: Place) -> list[tuple[float, float]]:
        """To the depot: seconds at most, and what is used up before the next charge."""
        found = [(math.dist(place, self._depot),) * 2]
        for station in self._stations:
            to, on = math.dist(place, station), math.dist(station, self._depot)
            if on <= self._capacity:
                found.append((to + self._full_s + on, to))
        return found

    def limits(self, task: Task) -> tuple[float, float] | None:
        """The earliest arrival, and the latest from which there is a way back with the battery of that arrival."""
        outs, backs = self._out(task.position), self._back(task.position)
        pairs = [(out, back) for out, used in outs for back, more in backs if used + more <= self._capacity]
        if not pairs:
            return None
        out, back = min(pairs, key=sum)
        return out, self._until - back - (task.duration_s or 0.0)


def _opened(task: Task, rides: _Rides) -> Task:
    """The task, with a window that a robot alone can keep."""
    limits = rides.limits(task)
    assert limits is not None  # the battery lasts to a station and back
    (opens, closes), (first, last) = task.window_s[0], limits
    return replace(task, window_s=((min(opens, last - _CLEAR), max(closes or math.inf, first + _CLEAR)),))
