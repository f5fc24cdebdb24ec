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
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.parameters import CommonParameters


class Parameters(CommonParameters):
    """The parameters of HRVO, which are those of all methods."""


@dataclass(frozen=True)
class Hrvo:
    """Hybrid reciprocal velocity obstacles, 2-D."""

    params: Parameters = field(default_factory=Parameters)
    name: ClassVar[str] = "HRVO"

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """See `Method`; robots in the plane only."""
        require_finite_positive(dt=dt)
        chosen: Floats = core.hrvo(agents.in_plane(), obstacles.still(2), dt, **self.params.for_core())
        return chosen
