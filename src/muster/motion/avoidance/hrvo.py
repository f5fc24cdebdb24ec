"""HRVO: [snape2011]; in the plane.

Two robots that pass each other should choose the same side. If a robot's velocity is to the right of the centre line of
the reciprocal velocity obstacle, the left side of it is replaced by that of the velocity obstacle: passing on the wrong
side costs more. The apex is where the two sides cross.

A robot takes the velocity nearest to the preferred one outside all obstacles. Candidates are those of ClearPath
[guy2009]: the preferred velocity, 0, the nearest point of each side, where sides cross each other and the disc of
possible speeds. Where none is outside all, it is the one whose first violated obstacle belongs to the farthest robot.

Walls enter as half-planes that keep off them for the horizon (as ORCA's of velocity 0). Of two robots the
one with the lower priority alone gives way, with the whole velocity obstacle; the other does not look at it.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from muster import core
from muster.motion.avoidance.agents import (
    NO_OBSTACLES,
    Agents,
    Floats,
    Obstacles,
    require_counts,
    require_finite_positive,
    require_positive,
)


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Of HRVO.

    Parameters
    ----------
    wall_horizon_s
        for how long a velocity keeps off walls.
    most_neighbours, neighbour_distance_m
        a robot looks at the nearest others, up to this distance between centres.
    threads
        of the processor; the result does not depend on them.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    wall_horizon_s: float = 2.0
    most_neighbours: int = 10
    neighbour_distance_m: float = 15.0
    threads: int = 1

    def __post_init__(self) -> None:
        require_finite_positive(wall_horizon_s=self.wall_horizon_s)
        require_positive(neighbour_distance_m=self.neighbour_distance_m)
        require_counts(most_neighbours=self.most_neighbours, threads=self.threads)


@dataclass(frozen=True)
class Hrvo:
    """Hybrid reciprocal velocity obstacles, 2-D."""

    params: Parameters = field(default_factory=Parameters)
    name: ClassVar[str] = "HRVO"

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """See `Method`; robots in the plane only."""
        require_finite_positive(dt=dt)
        p = self.params
        chosen: Floats = core.hrvo(
            agents.in_plane(),
            obstacles.still(2),
            dt,
            wall_horizon=p.wall_horizon_s,
            most=p.most_neighbours,
            distance=p.neighbour_distance_m,
            threads=p.threads,
        )
        return chosen
