"""The energy of simulated robots: what each begins with, what drains it, and how it is asked for."""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import Self, TypedDict, TypeVar

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.texts.near_matches import did_you_mean
from muster.model.energy import EnergyLevel

T = TypeVar("T")
ALL = "all"
"""Stands for every robot in the place of an id."""
ByRobot = Mapping[str, float]
"""A number by robot, or for `ALL`."""
NONE: ByRobot = MappingProxyType({})


class GivenEnergy(TypedDict, total=False):
    """What makers of worlds are told of the energy of robots, by id or for `all`."""

    batteries: ByRobot
    """Shares of full batteries with which robots begin; else as the mission says. Who has none by either reports no
    charge. A robot whose battery, given by the mission, is empty stops; one that recovers has a full one again."""
    drain: ByRobot
    """How many times as fast as by usage batteries drain."""


_RANGES: Mapping[str, tuple[str, Callable[[float], bool]]] = {
    "battery": ("a share from 0 to 1", lambda share: 0 <= share <= 1),
    "drain": ("a number above 0", lambda factor: 0 < factor < math.inf),
}
"""What is given by robot: the share of a full battery with which it begins, and how many times as fast as by usage that
drains; what is expected of it, and which numbers that are."""
LACKS_ENERGY = dict.fromkeys(("batteries", "drain"), "expected none: the world {world} has no batteries")
"""The settings of worlds about energy, and what is said of a world that does not take one."""


def require_by_robot(what: str, values: ByRobot, robots: Collection[str]) -> None:
    """Refuse shares and factors out of range, and robots that there are not.

    Raises
    ------
    ParameterError
        for these.
    """
    expected, allows = _RANGES[what]
    for robot, value in values.items():
        if robot != ALL and robot not in robots:
            raise ParameterError(f"{what}: robot {robot}; expected {ALL} or a robot{did_you_mean(robot, robots)}")
        if not allows(value):
            raise ParameterError(f"{what}: {robot}={value:g}; expected {expected}")


def of_robot(values: ByRobot, robot: str, default: T) -> float | T:
    """What is given for a robot, or for all; the default where nothing is."""
    return values.get(robot, values.get(ALL, default))


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
        self.spend(self.used(), self.drain)
        return self
