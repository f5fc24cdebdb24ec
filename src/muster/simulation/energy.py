"""The energy of simulated robots: what each begins with, what drains it, and how it is asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Self

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.texts.near_matches import did_you_mean
from muster.model.energy import EnergyLevel

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
LACKS_ENERGY = dict.fromkeys(("batteries", "drain"), "expected none: the world {world} has no batteries")
"""The settings of worlds about energy, and what is said of a world that does not take one."""


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
    """What a full battery lets a robot use that has none by the mission: its work capacity, in the unit of usage.

    Raises
    ------
    ParameterError
        if the mission does not say that either.
    """
    if robot.work_capacity is None or robot.work_capacity == 0:
        raise ParameterError(
            f"battery: robot {robot.id} has no work_capacity; expected one, which is what its battery holds in the "
            "kinematic world"
        )
    return robot.work_capacity


@dataclass
class SimulatedEnergy(EnergyLevel):
    """What one simulated robot holds.

    Parameters
    ----------
    used
        returns the robot's usage so far, in the unit of the capacity.
    drain
        how many times as fast as that it falls.
    """

    used: Callable[[], float]
    drain: float = 1.0

    def look(self) -> Self:
        """Take off what was used since the last look; who is empty stays empty until a station adds some."""
        self.lower(self.drain * self.count(self.used()))
        return self
