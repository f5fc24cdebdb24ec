"""What robots' processes tell the one that has started them, and what that tells them. Plain data for pipes."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster.allocation.problem import Problem
from muster.allocation.terms import Terms
from muster.negotiation.members import Patience
from muster.negotiation.messages import Stage
from muster.negotiation.node import NodeStatus
from muster.negotiation.view import View

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
    """

    problem: Problem
    terms: Terms
    key: bytes = field(repr=False)
    method: str = "auction"
    transport: str = "udp"
    patience: Patience = field(default_factory=Patience)


@dataclass(frozen=True)
class Born:
    """A robot has a process."""

    robot: str
    pid: int


@dataclass(frozen=True)
class Gone:
    """A robot's process has ended; why."""

    robot: str
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
