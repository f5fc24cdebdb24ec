"""Batteries of simulated robots: what each begins with, and what it reports."""

from __future__ import annotations

from collections.abc import Callable, Collection, Mapping
from types import MappingProxyType

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.mission.near_matches import did_you_mean

ALL = "all"
"""Stands for every robot in the place of an id."""
Charges = Mapping[str, float]
"""By robot, or for `ALL`, the share of a full battery that it begins with, 0 to 1; who is not named reports none."""
NO_CHARGES: Charges = MappingProxyType({})


def require_charges(charges: Charges, robots: Collection[str]) -> None:
    """Refuse shares out of range, and robots that there are not.

    Raises
    ------
    ParameterError
        for these.
    """
    for robot, share in charges.items():
        if robot != ALL and robot not in robots:
            raise ParameterError(f"battery: robot {robot}; expected {ALL} or a robot{did_you_mean(robot, robots)}")
        if not 0 <= share <= 1:
            raise ParameterError(f"battery: {robot}={share:g}; expected a share from 0 to 1")


def charge_at_start(charges: Charges, robot: str) -> float | None:
    """The share that a robot begins with; None where it has no battery that reports."""
    return charges.get(robot, charges.get(ALL))


def capacity_in_usage(robot: Robot) -> float:
    """What a full battery lets a robot use in the kinematic world: its work capacity, in the unit of usage.

    Raises
    ------
    ParameterError
        if the mission does not say that.
    """
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
    at_start
        the share that it begins with.
    drained
        returns the share of a full battery that was drained so far.
    """

    def __init__(self, at_start: float, drained: Callable[[], float]) -> None:
        self._at_start, self._drained = at_start, drained

    @property
    def charge(self) -> float:
        """The share that is left; an empty battery stays empty."""
        return max(0.0, self._at_start - self._drained())
