"""The usage of each route (docs/design.md, Meaning; [tcf-thesis] (3.8)-(3.10) and (3.28)-(3.29))."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import NamedTuple

from muster.mission.model import Mission, Robot, Station, Task
from muster.motion.actions import TaskMotion
from muster.motion.leg_times import LegTimes
from muster.verification.energy import NO_CHARGE, Charge, Energy, Gauge
from muster.verification.known_routes import Call, Planned
from muster.verification.travel import (
    Place,
    Travel,
    doing_at,
    place_at_end,
    place_of_start,
    place_of_station,
    place_of_task,
    rise_m,
)


class Leg(NamedTuple):
    """The way to a place. A leg without a way counts nothing, so that the rest of the route can still be judged."""

    exists: bool
    usage: float
    seconds: float


class Step(NamedTuple):
    """One task of a route: the way there, the usage on arrival, and how long the work takes.

    It is passable if there is a way along the way points of its action; without one the work's metres count nothing.
    `energy` is None for a robot without a battery.
    """

    task: Task
    leg: Leg
    arrival_usage: float
    work_s: float
    passable: bool
    energy: Energy | None = None

    @property
    def place_id(self) -> str:
        return self.task.id

    @property
    def seconds(self) -> float:
        """How long the robot stays once it has begun."""
        return self.work_s


class Service(NamedTuple):
    """One visit of a station: the way there, the usage on arrival, and what the station adds to the battery."""

    call: Call
    leg: Leg
    arrival_usage: float
    charge: Charge
    energy: Energy | None

    @property
    def station(self) -> Station:
        return self.call.station

    @property
    def place_id(self) -> str:
        return self.station.id

    @property
    def is_charged(self) -> bool:
        """Whether a battery is charged there, or swapped."""
        return self.energy is not None and self.station.gives_energy

    @property
    def seconds(self) -> float:
        """How long the robot stays once it has begun."""
        return self.charge.seconds


MeasuredStop = Step | Service


@dataclass(frozen=True)
class MeasuredRoute:
    """One robot's route with its costs; `last_leg` goes to where the route must end, if it must and has stops.

    `energy_at_end` is what the battery holds there, or after the last stop; None for a robot without a battery.
    """

    robot: Robot
    stops: tuple[MeasuredStop, ...]
    last_leg: Leg | None
    travel: float
    work: float
    energy_at_end: Energy | None = None

    @cached_property
    def steps(self) -> tuple[Step, ...]:
        """The stops at tasks."""
        return tuple(stop for stop in self.stops if isinstance(stop, Step))

    @property
    def planned(self) -> tuple[Planned, ...]:
        """The stops as the plan has them."""
        return tuple(stop.task if isinstance(stop, Step) else stop.call for stop in self.stops)

    @property
    def usage(self) -> float:
        """Travel plus work: u_i of [tcf-thesis] (3.10)."""
        return self.travel + self.work


def all_measured(
    mission: Mission, travel: Travel, stops_of: Mapping[str, Sequence[Planned]]
) -> tuple[MeasuredRoute, ...]:
    """Measure the routes of all robots, in mission order. A task takes as long as for the slowest of its team."""
    slowest: dict[str, float] = {}
    for robot in mission.robots:
        times = LegTimes.in_mission(robot, mission)
        for task in stops_of.get(robot.id, ()):
            if isinstance(task, Task):
                seconds = work_seconds(times, travel, robot, task)
                slowest[task.id] = max(seconds, slowest.get(task.id, 0.0))
    return tuple(measured(mission, travel, robot, stops_of.get(robot.id, ()), slowest) for robot in mission.robots)


def measured(
    mission: Mission, travel: Travel, robot: Robot, stops: Sequence[Planned], work_s: Mapping[str, float]
) -> MeasuredRoute:
    """Measure one robot's route; `work_s` is how long each task takes."""
    return _Measuring(mission, travel, robot, work_s).route(stops)


class _Measuring:
    """Goes along one route, and adds up what it costs."""

    def __init__(self, mission: Mission, travel: Travel, robot: Robot, work_s: Mapping[str, float]) -> None:
        self._mission, self._travel, self._robot, self._work_s = mission, travel, robot, work_s
        self._in_time = mission.rules.usage == "time"
        self._times = LegTimes.in_mission(robot, mission)
        self._gauge = None if robot.battery is None else Gauge(robot.battery)
        self._here = place_of_start(robot)
        self._travelled = self._worked = 0.0

    def route(self, planned: Sequence[Planned]) -> MeasuredRoute:
        # One after the other: what is here is added to what was before.
        stops = tuple([self._at_task(one) if isinstance(one, Task) else self._at_station(one) for one in planned])
        end = place_at_end(self._robot, self._mission.rules) if stops else None
        last_leg = None if end is None else self._leg(end)
        return MeasuredRoute(self._robot, stops, last_leg, self._travelled, self._worked, self._energy())

    def _energy(self) -> Energy | None:
        return None if self._gauge is None else self._gauge.now

    def _leg(self, there: Place) -> Leg:
        leg = leg_between(self._travel, self._robot, self._here, there, self._times, self._in_time)
        self._here = there
        self._travelled += leg.usage
        if self._gauge is not None:
            self._gauge.draw(leg.usage)
        return leg

    def _at_task(self, task: Task) -> Step:
        leg = self._leg(place_of_task(task, self._robot))
        arrival_usage, energy = self._travelled + self._worked, self._energy()
        metres = self._travel.work_metres(self._robot, task)
        seconds = self._work_s[task.id]
        work = seconds if self._in_time else metres or 0.0
        self._worked += work
        if self._gauge is not None and energy is not None:
            self._gauge.draw(work)
            energy = self._gauge.now._replace(arrives=energy.arrives)
        return Step(task, leg, arrival_usage, seconds, metres is not None, energy)

    def _at_station(self, call: Call) -> Service:
        leg = self._leg(place_of_station(call.station))
        arrival_usage, energy = self._travelled + self._worked, self._energy()
        charge = NO_CHARGE
        if self._gauge is not None and energy is not None and call.station.gives_energy:
            charge = self._gauge.visit(call.station, call.charged, self._travel.tolerance)
            energy = energy._replace(leaves=self._gauge.level)
        return Service(call, leg, arrival_usage, charge, energy)


def place_of_stop(stop: MeasuredStop, robot: Robot) -> Place:
    """Return the place of a stop for a robot."""
    return place_of_task(stop.task, robot) if isinstance(stop, Step) else place_of_station(stop.station)


def leg_between(travel: Travel, robot: Robot, start: Place, end: Place, times: LegTimes, in_time: bool) -> Leg:
    """Measure the leg from the exit of one place to the entry of another."""
    metres = travel.metres(robot, start, end)
    if metres is None:
        return Leg(exists=False, usage=0.0, seconds=0.0)
    if travel.keeps_to_lanes(robot):
        seconds = travel.lane_seconds(robot, start.exit, end.entry)
    else:
        seconds = times.leg_seconds(metres, rise_m(start, end), math.dist(start.exit, end.entry))
    return Leg(exists=True, usage=seconds if in_time else metres, seconds=seconds)


def work_seconds(times: LegTimes, travel: Travel, robot: Robot, task: Task) -> float:
    """Return how long the robot works on the task: duration by efficiency where one is given.

    Else the time of its motion profile along the way points of the task's action, if it has any; else cost by speed.
    """
    duration = task.duration_s
    if duration is None and task.action is not None:
        duration = task.action.duration_s
    if duration is not None:
        return duration / robot.efficiency
    metres = travel.work_metres(robot, task) or 0.0
    doing = None if times.is_constant else doing_at(robot, task)
    if not isinstance(doing, TaskMotion) or metres == 0.0:
        return metres / robot.speed_mps
    if doing.is_travel and travel.keeps_to_lanes(robot):
        return sum(travel.lane_seconds(robot, *leg) for leg in doing.legs)
    return times.work_seconds(doing.points, travel.leg_metres(robot, doing))


def equality_index(usages: Sequence[float]) -> float:
    """Return 1 - Gini over the usages of all robots, [tcf-thesis] (3.28) and (3.29); 1 if all are 0.

    From 1/M, where one of M robots has all the usage, to 1, where all have the same.
    """
    total = sum(usages)
    if total == 0:
        return 1.0
    count = len(usages)
    # A share first, then its weight: the sum of rank times usage may overflow where the index does not.
    ranked = sum(rank * (usage / total) for rank, usage in enumerate(sorted(usages), start=1))
    gini = 2 * ranked / count - (count + 1) / count
    return 1 - gini
