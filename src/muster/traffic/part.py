"""A robot that takes part in traffic by reservation."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field

from muster.mission.model import Robot
from muster.traffic.managed_port import ManagedPort
from muster.traffic.travellers import Point


@dataclass
class Part:
    """A robot in traffic, and what of it is planned."""

    robot: Robot
    port: ManagedPort
    number: int
    moves_passed: int = 0  # ends of moves, by the orders before the last
    ends: int = 0  # how many of the places of the last order are ends of moves
    goal: Point | None = None  # by the last plan
    arrives: bool = False  # whether it has something to do there, by the last plan
    stop: int = 0  # the number of its goal among its stops
    ahead: list[Point] = field(default_factory=list)  # stops after its goal, by the last plan
    more: bool = False  # whether it has more than were planned
    stays: bool = False  # whether it stays at the last of them for good
    done_s: float = math.inf  # when it was first seen to have nothing more to do at its goal
    to_go: bool = False  # whether it has been let go further than where it is
    stood: Point = (0.0, 0.0)
    moved_s: float = -math.inf  # when it last moved, or had no reason to
    broken: bool = False
    broken_s: float = 0.0  # since when

    @property
    def near(self) -> Point:
        said = self.port.heard
        return planar(said.position) if said is not None else self.stood


def planar(place: Sequence[float]) -> Point:
    """A place without its height."""
    return (place[0], place[1])
