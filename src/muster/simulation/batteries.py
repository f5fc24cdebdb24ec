"""Batteries of simulated robots: what each begins with, what drains it, and what it reports."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.texts.near_matches import did_you_mean

ALL = "all"
"""Stands for every robot in the place of an id."""
ByRobot = Mapping[str, float]
"""A number by robot, or for `ALL`."""
Charges = ByRobot
"""The share of a full battery with which a robot begins, 0 to 1; who is not named begins as the mission says, and
reports none where that gives it no battery."""
Drains = ByRobot
"""How many times as fast as by usage the battery of a robot drains; 1 for who is not named."""
NO_CHARGES: Charges = MappingProxyType({})
NO_DRAINS: Drains = MappingProxyType({})


def require_charges(charges: Charges, robots: Collection[str]) -> None:
    """Refuse shares out of range, and robots that there are not.

    Raises
    ------
    ParameterError
        for these.
    """
    _require_robots("battery", charges, robots)
    for robot, share in charges.items():
        if not 0 <= share <= 1:
            raise ParameterError(f"battery: {robot}={share:g}; expected a share from 0 to 1")


def require_drains(drains: Drains, robots: Collection[str]) -> None:
    """Refuse factors that are not above 0, and robots that there are not.

    Raises
    ------
    ParameterError
        for these.
    """
    _require_robots("drain", drains, robots)
    for robot, factor in drains.items():
        if not 0 < factor < math.inf:
            raise ParameterError(f"drain: {robot}={factor:g}; expected a number above 0")


def _require_robots(what: str, values: ByRobot, robots: Collection[str]) -> None:
    for robot in values:
        if robot != ALL and robot not in robots:
            raise ParameterError(f"{what}: robot {robot}; expected {ALL} or a robot{did_you_mean(robot, robots)}")


def charge_at_start(charges: Charges, robot: Robot) -> float | None:
    """The share that a robot begins with; None where it has no battery that reports."""
    by_mission = None if robot.battery is None else robot.battery.at_start
    return charges.get(robot.id, charges.get(ALL, by_mission))


def drain_of(drains: Drains, robot: str) -> float:
    """How many times as fast as by usage the battery of a robot drains."""
    return drains.get(robot, drains.get(ALL, 1.0))


def capacity_in_usage(robot: Robot) -> float:
    """What a full battery lets a robot use, in the unit of usage: its battery's capacity, else its work capacity.

    Raises
    ------
    ParameterError
        if the mission says neither.
    """
    if robot.battery is not None:
        return robot.battery.capacity
    if robot.work_capacity is None or robot.work_capacity == 0:
        raise ParameterError(
            f"battery: robot {robot.id} has no work_capacity; expected one, which is what its battery holds in the "
            "kinematic world"
        )
    return robot.work_capacity


class Battery:
    """The battery of one robot.

    Parameters
    ----------
    capacity
        what it holds when it is full.
    at_start
        the share that it begins with.
    drained
        returns what was drained so far, in the unit of the capacity.
    drain
        times that.
    """

    def __init__(self, capacity: float, at_start: float, drained: Callable[[], float], drain: float = 1.0) -> None:
        self.capacity, self.drain = capacity, drain
        self._level, self._drained = at_start * capacity, drained
        self._seen: float | None = None

    @property
    def level(self) -> float:
        """What is left; an empty battery stays empty until it is charged."""
        drained = self._drained()
        more = drained if self._seen is None else drained - self._seen
        self._seen = drained
        self._level = max(0.0, self._level - self.drain * more)
        return self._level

    @property
    def charge(self) -> float:
        """The share that is left."""
        return self.level / self.capacity

    def add(self, amount: float) -> None:
        """Charge it, until it is full."""
        self._level = min(self.capacity, self.level + amount)

    def fill(self) -> None:
        """Put a full one in its place."""
        self.add(self.capacity)
