"""What a plan of traffic is made of: robots that travel, and their moves."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterable, Sequence
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


class Planner(Protocol):
    """Plans moves of travellers, in an order in which each is free while the others stand."""

    @property
    def cut_off(self) -> Collection[int]:
        """The travellers of the last plan, by number, that those who never leave let to none of their stops."""
        ...

    @property
    def stepwise(self) -> bool:
        """Whether the last moves were planned step by step, without whole ways: made anew they may lead back."""
        ...

    def close(self, doors: Collection[str]) -> None:
        """From now on these doors are closed, and the others open."""
        ...

    def is_open(self, piece: Floats, radius_m: float) -> bool:
        """Whether a straight way (2, 2) leads a robot of a radius through no closed door."""
        ...

    def reaches(self, travellers: Sequence[Traveller], number: int, places: Sequence[Point]) -> list[bool]:
        """To which places a traveller gets past those who never leave; not where it is proven that it has no way."""
        ...

    def __call__(self, travellers: Sequence[Traveller]) -> Iterable[Move]:
        """Moves, as far as they are found."""
        ...

    def whole(self, travellers: Sequence[Traveller]) -> Iterable[Move] | None:
        """Moves along whole ways to all first stops at least; None where some find no way."""
        ...
