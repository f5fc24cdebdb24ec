"""The manager of traffic: between who orders robots and the robots, so that they do not stand in each other's way."""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from typing import Protocol

from muster.mission.model import Robot
from muster.motion.outlook import Outlook
from muster.motion.port import Place, RobotPort

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

    def moved(self, robot: str) -> None:
        """Somebody has put a robot, by its name, where it now says that it is."""
        ...

    def reaches(self, robot: str, places: Sequence[Place]) -> list[bool]:
        """To which places a robot, by its name, can get past those that stand for good, for all that is known."""
        ...

    def makes_no_room(self, robot: str) -> bool:
        """Whether a robot that has nothing to do was told several times to make room, and has not moved."""
        ...

    def look(self, now: float) -> None:
        """See how far robots are and send them on; to be called every `LOOK_S` seconds of the mission's clock."""
        ...
