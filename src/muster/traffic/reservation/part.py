"""A robot that takes part in traffic by reservation."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise

from muster.mission.model import Robot
from muster.motion.kinematics.registry import limits_of
from muster.motion.outlook import Outlook
from muster.motion.port import planar
from muster.traffic.journeys.travellers import Point
from muster.traffic.reservation.managed_port import ManagedPort

_AWAY_M = 1e7
"""A robot that was taken away is so far from all others, and from any other like it."""


@dataclass(frozen=True)
class Aim:
    """Where a robot goes by a plan.

    Parameters
    ----------
    goal : Point or None
        The first stop, metres; None: it may be anywhere.
    arrives : bool
        Whether it has something to do at its goal.
    stop : int
        Number of the goal among all its stops, those of earlier plans included.
    ahead : tuple of Point
        Stops after the goal.
    more : bool
        Whether it has more stops than were planned.
    stays : bool
        Whether it stays at the last stop for good.
    """

    goal: Point | None = None
    arrives: bool = False
    stop: int = 0
    ahead: tuple[Point, ...] = ()
    more: bool = False
    stays: bool = False


@dataclass
class Part:
    """A robot in traffic, and what of it is planned."""

    robot: Robot
    port: ManagedPort
    number: int
    outlook: Outlook = Outlook(stays=True)  # where it will go after its goal
    moves_passed: int = 0  # ends of moves, by the orders before the last
    sent_s: float = -math.inf  # when it was last sent on
    ends: int = 0  # how many of the places of the last order are ends of moves
    aim: Aim = Aim()  # by the last plan
    done_s: float = math.inf  # when it was first seen to have nothing more to do at its goal
    no_way_s: float = math.inf  # since when it has no way to its goal
    to_go: bool = False  # whether it has been let go further than where it is
    stood: Point = (0.0, 0.0)
    moved_s: float = -math.inf  # when it last moved, or had no reason to
    broken: bool = False
    broken_s: float = 0.0  # since when
    tried: int = 0  # how often it was told anew where to go since it last moved
    orders: int = 0  # how many orders it had got when it was told last
    removed: bool = False  # whether it was taken away
    gone: bool = False  # whether it is out, and not to be sent anywhere
    may_be_at: tuple[Point, ...] = ()  # where else it may be then

    @property
    def fixed(self) -> bool:
        """Whether others have to get round it where it is."""
        return self.broken or self.gone

    def gone_on(self, now: float) -> Iterator[Point]:
        """Where it may be that was stopped now: on the way that it was sent, as far as it can have come unheard.

        The places are no farther from each other than its radius.
        """
        left_m = self._unheard_m(now)
        for (x, y), (u, v) in self.pieces_ahead():
            if left_m <= 0:
                return
            long_m = math.dist((x, y), (u, v))
            end = min(1.0, left_m / long_m) if long_m else 1.0
            pieces = math.ceil(end * long_m / self.robot.radius_m)
            for k in range(1, pieces + 1):
                yield x + (u - x) * end * k / pieces, y + (v - y) * end * k / pieces
            left_m -= long_m

    def _unheard_m(self, now: float) -> float:
        """How far it can have come since it was last heard, and until it stands."""
        said, limits = self.port.heard, limits_of(self.robot)
        if said is None:
            return limits.braking_m(limits.speed_mps)
        unheard_s = now - said.time_s
        speed_mps = math.hypot(*said.velocity)
        if unheard_s > 0:
            speed_mps = min(limits.speed_mps, speed_mps + limits.acceleration_mps2 * unheard_s)
        return speed_mps * unheard_s + limits.braking_m(speed_mps)

    def pieces_ahead(self) -> Iterator[tuple[Point, Point]]:
        """The straight pieces of the way that it was last sent, from where it is; after a stop of that before."""
        return pairwise([self.near, *map(planar, self.port.sent_ahead)])

    @property
    def goal(self) -> Point | None:
        """Where it is to go or to stay now; None: where it has nothing to do it may be anywhere."""
        goal = self.port.goal
        if goal is None or not (self.port.arrives or self.outlook.visits or self.outlook.stays):
            return None
        return planar(goal)

    @property
    def near(self) -> Point:
        if self.removed:
            return _AWAY_M, _AWAY_M * (1 + self.number)
        said = self.port.heard
        return planar(said.position) if said is not None else self.stood
