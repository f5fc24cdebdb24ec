"""The manager of traffic: between who orders robots and the robots, so that they do not stand in each other's way."""

from __future__ import annotations

from collections.abc import Callable, Collection
from typing import Protocol

from muster.mission.model import Robot
from muster.motion.outlook import Outlook
from muster.motion.port import RobotPort

LOOK_S = 0.2
"""Seconds between two looks of a manager."""


class TrafficManager(Protocol):
    """Decides who goes where when, for all robots of a mission."""

    def managed(self, robot: Robot, port: RobotPort) -> RobotPort:
        """The port by which a robot is to be ordered from now on."""
        ...

    def expect(self, outlook: Callable[[str], Outlook]) -> None:
        """From now on this says where a robot, by its name, will go after where it has been sent."""
        ...

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        ...

    def look(self, now: float) -> None:
        """See how far robots are and send them on; to be called every `LOOK_S` seconds of the mission's clock."""
        ...
