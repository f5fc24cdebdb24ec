"""What a plan of traffic is made of: robots that travel, and their moves."""

from __future__ import annotations

import math
from collections.abc import Collection, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from muster.mission.model import Robot
from muster.motion.grid import Floats

Point = tuple[float, float]


class Stop(NamedTuple):
    """A place in metres, and seconds for which a robot stays there."""

    at: Point
    hold_s: float = 0.0


@dataclass(frozen=True)
class Traveller:
    """A robot for which moves are planned.

    Parameters
    ----------
    robot
        who it is.
    start
        metres, where its moves begin.
    stops
        where it is to go, one after the other; none: it may be anywhere.
    heading_rad
        at its start.
    ready_s
        seconds for which it stays at its start.
    stays
        whether it stays at its last stop for good; else it leaves then.
    fixed
        whether it stays at its start in any case.
    """

    robot: Robot
    start: Point
    stops: tuple[Stop, ...] = ()
    heading_rad: float = 0.0
    ready_s: float = 0.0
    stays: bool = True
    fixed: bool = False


class Move(NamedTuple):
    """A straight move of a traveller, by its number among all, to a place in metres.

    `stop` is the number of the stop to which the move leads; that of all its stops for moves after the last.
    `speed_mps` is the greatest on it.
    """

    traveller: int
    to: Point
    stop: int = 0
    speed_mps: float = math.inf


class PlannedMoves(NamedTuple):
    """The moves of all travellers, in an order in which each is free while the others stand.

    Parameters
    ----------
    moves : Sequence[Move]
        Moves through all stops of each traveller, or to its first stop at least.
    complete : bool
        False where a traveller that is not cut off found no way to a stop. The moves then lead as near to the stops as
        was found, and the moves of a later incomplete plan may lead back.
    cut_off : frozenset[int]
        Numbers of the travellers that those who never leave let to none of their stops.
    """

    moves: Sequence[Move] = ()
    complete: bool = True
    cut_off: frozenset[int] = frozenset()


class Planner(Protocol):
    """A planner of moves for all travellers."""

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        ...

    def is_open(self, piece: Floats, radius_m: float) -> bool:
        """Whether a straight way (2, 2) leads a robot of a radius through no closed door."""
        ...

    def reaches(self, travellers: Sequence[Traveller], number: int, places: Sequence[Point]) -> list[bool]:
        """To which places a traveller gets past those who never leave; not where it is proven that it has no way."""
        ...

    def __call__(self, travellers: Sequence[Traveller]) -> PlannedMoves:
        """Return moves of all travellers, as far as they are found."""
        ...
