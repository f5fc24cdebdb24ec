"""Batteries and stations for missions of vehicles, in the manner of Schneider, Stenger and Goeke [schneider2014].

A battery lasts to each customer and back, with at most one charge each way; filling it takes as long as three
customers. A window that nobody can keep who charges is opened.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from random import Random

from muster.generation.customers import KIND, customers_mission
from muster.generation.generator import MOST_TASKS, Generator
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Checked, record, spec
from muster.mission.stations import Battery, Station
from muster.mission.value_types import Number, Whole

Place = tuple[float, ...]

_CUSTOMERS_A_CHARGE = 3
_PER_VEHICLE = 2
_CLEAR = 1.0
"""Windows are opened by so much more than they must be."""


@record
class Charging(Checked):
    """What missions of the family `charging` share."""

    kind: str = spec(KIND, "where customers are, and how long the day is", default="R1")
    customers: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many customers: tasks", default=20)
    stations: int = spec(Whole(maximum=1000), "stations besides the one at the depot", default=5)
    battery_m: float = spec(Number(above=0), "how far a full battery lasts; more where it must", default=160.0)


def with_batteries(mission: Mission, draw: Random, battery: float, stations: int) -> Mission:
    """A mission of vehicles from one depot with batteries, a station at the depot and others at random places.

    Parameters
    ----------
    battery
        what a battery holds, in the unit of usage; more where it would not last to a customer and back.
    stations
        how many, besides the one at the depot.
    """
    robot, tasks = mission.robots[0], mission.tasks
    xs, ys = zip(*(task.position[:2] for task in tasks), strict=True)
    places = [robot.position]
    places += [(draw.uniform(min(xs), max(xs)), draw.uniform(min(ys), max(ys))) for _ in range(stations)]
    capacity = max(battery, *(_needed(robot.position, places, task.position) for task in tasks))
    full_s = _CUSTOMERS_A_CHARGE * sum(task.duration_s or 0.0 for task in tasks) / len(tasks)
    rides = _Rides(robot, places, capacity, full_s)
    return replace(
        mission,
        robots=tuple(replace(each, battery=Battery(capacity=capacity)) for each in mission.robots),
        tasks=tuple(_opened(task, rides) for task in tasks),
        stations=tuple(_station(k, place, len(mission.robots), capacity / full_s) for k, place in enumerate(places)),
    )


def _station(number: int, place: Place, slots: int, per_s: float) -> Station:
    return Station(
        id=f"S{number}", position=place, services=("charge",), slots=slots, charge_per_s=per_s, partial=False
    )


def _needed(depot: Place, stations: Sequence[Place], place: Place) -> float:
    """What a battery must hold for the way to a place and back, with at most one charge each way."""
    ends: list[tuple[float, float]] = []  # from the place to where it is charged, and from there to the depot
    for end in sorted(
        [(math.dist(depot, place), 0.0), *((math.dist(s, place), math.dist(depot, s)) for s in stations)]
    ):
        if not ends or end[1] < ends[-1][1]:
            ends.append(end)
    return min(max(here + there, far, away) for here, far in ends for there, away in ends)


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
    assert limits is not None  # `_needed`
    (opens, closes), (first, last) = task.window_s[0], limits
    return replace(task, window_s=((min(opens, last - _CLEAR), max(closes or math.inf, first + _CLEAR)),))


def _make(given: Charging, seed: int) -> Mission:
    plain = customers_mission(given.kind, given.customers, seed, per_vehicle=_PER_VEHICLE)
    return with_batteries(plain, Random(f"stations {seed}"), given.battery_m, given.stations)


CHARGING = Generator(
    name="charging",
    summary="customers with time windows and loads, vehicles with batteries, stations where they charge",
    source="in the manner of [schneider2014]; the table `charging` of `muster bench peers-goods`",
    parameters=Charging,
    make=_make,
)
