"""What robots' processes tell the one that has started them, and what that tells them. Plain data for pipes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from muster.allocation.auction_terms import Terms
from muster.allocation.problem import Problem
from muster.negotiation.members import Patience
from muster.negotiation.messages import Stage
from muster.negotiation.node import NodeStatus
from muster.negotiation.robot_view import View

TRANSPORTS = ("udp", "zenoh")

GO, SHOW = "go", "show"
"""Commands to a robot: begin; tell what you know."""


@dataclass(frozen=True, kw_only=True)
class Order:
    """An auction that is to be held by the whole team of a mission.

    Parameters
    ----------
    problem, terms
        what about, and on which terms.
    method, transport
        names of METHODS and TRANSPORTS.
    key
        that the team shares.
    patience
        how long robots wait for one another.
    late
        robots that are not started with the others, but when `Team.start` is called.
    lives
        how many processes those robots have, one after another, that have more than one.
    memory
        a folder in which robots keep what they know for their next life; needed where one has it.
    part
        what a robot's process does; None: it holds the auction, and no more.
    """

    problem: Problem
    terms: Terms
    key: bytes = field(repr=False)
    method: str = "auction"
    transport: str = "udp"
    patience: Patience = field(default_factory=Patience)
    late: frozenset[str] = frozenset()
    lives: Mapping[str, int] = field(default_factory=dict)
    memory: Path | None = None
    part: Callable[[Any], None] | None = None

    @property
    def seats(self) -> list[tuple[str, int]]:
        """All processes: whose, and which of its lives, from 1."""
        robots = [robot.id for robot in self.problem.mission.robots]
        return [(robot, life + 1) for robot in robots for life in range(self.lives.get(robot, 1))]


@dataclass(frozen=True)
class Born:
    """A robot has a process, for one of its lives."""

    robot: str
    life: int
    pid: int


@dataclass(frozen=True)
class Gone:
    """A robot's process has ended; why."""

    robot: str
    life: int
    why: str


@dataclass(frozen=True)
class Ready:
    """A robot could take part now."""


@dataclass(frozen=True)
class Failed:
    """A robot cannot take part."""

    why: str


@dataclass(frozen=True)
class News:
    """How far a robot is; `view` if it was asked to show it."""

    status: NodeStatus
    stage: Stage
    view: View | None = None
