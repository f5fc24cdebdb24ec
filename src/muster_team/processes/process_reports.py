"""Messages between robots' processes and their starter. Plain data for pipes."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from muster.allocation.auctions.auction_terms import Terms
from muster.model.problem import Problem
from muster.perception.team_map import TeamMap
from muster_team.knowledge.messages import Stage
from muster_team.membership.members import Timeouts
from muster_team.negotiators.robot_view import View
from muster_team.processes.node import NodeStatus

GO, SHOW = "go", "show"
"""Commands to a robot: begin; send your view."""


@dataclass(frozen=True, kw_only=True)
class TeamSetup:
    """An auction that the whole team of a mission takes part in.

    Parameters
    ----------
    problem, terms
        the mission and the method's parameters.
    method, transport
        names of METHODS and TRANSPORTS.
    key
        the team's key.
    timeouts
        the protocol's time limits.
    late
        robots that are not started with the others, but by `Team.start`.
    starts
        the number of processes, one after another, of each robot that has more than one.
    memory
        a folder in which robots store what they need after a restart; required where a robot restarts.
    part
        what a robot's process does; None: it takes part in the auction and does nothing else.
    speed
        by how much the mission's time goes faster than real time.
    ground
        the map, as far as it is known beforehand, where robots build it; None: they have it.
    """

    problem: Problem
    terms: Terms
    key: bytes = field(repr=False)
    method: str = "auction"
    transport: str = "udp"
    timeouts: Timeouts = field(default_factory=Timeouts)
    late: frozenset[str] = frozenset()
    starts: Mapping[str, int] = field(default_factory=dict)
    memory: Path | None = None
    part: Callable[[Any], None] | None = None
    speed: float = 1.0
    ground: TeamMap | None = None

    @property
    def processes(self) -> list[tuple[str, int]]:
        """All processes: the robot, and the number of the start, from 1."""
        robots = [robot.id for robot in self.problem.mission.robots]
        return [(robot, start_number + 1) for robot in robots for start_number in range(self.starts.get(robot, 1))]


@dataclass(frozen=True)
class ProcessStarted:
    """A process of a robot has started."""

    robot: str
    start_number: int
    pid: int


@dataclass(frozen=True)
class ProcessEnded:
    """A process of a robot has ended, and why."""

    robot: str
    start_number: int
    why: str


@dataclass(frozen=True)
class Ready:
    """A robot is ready to take part."""


@dataclass(frozen=True)
class Failed:
    """A robot cannot take part, and why."""

    why: str


@dataclass(frozen=True)
class Progress:
    """A robot's progress; `view` if it was asked for."""

    status: NodeStatus
    stage: Stage
    view: View | None = None
