"""ORCA: [berg2011], in the plane and in space.

Each pair of robots leaves each other a half of the velocities (section 4); a robot takes the velocity nearest to the
preferred one that all others and all walls leave it, by a linear program (section 5), and where they leave none, the
one that goes least deep into what they do not leave. Against walls in the plane the half-plane is the one nearest
to the robot's own velocity, and where those leave nothing, the one nearest to 0, which always leaves 0; against
boxes in space it is always that one.

Of what two robots have to change in their relative velocity, equals take one half each; the one with the lower priority
takes all. Of what they have to spare, equals may use one half each; the one with the higher priority may use all. So
the two parts always add up to the whole, on which the guarantee rests.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.parameters import CommonParameters


@dataclass(frozen=True, kw_only=True)
class Parameters(CommonParameters):
    """Parameters of ORCA, by default those of the authors' circle of 250 robots. See `CommonParameters` for the rest.

    Parameters
    ----------
    horizon_s
        tau: for how long a velocity keeps robots apart.
    keep_apart
        whether no robot may use more than half of the gap to another in one step, in any case: then robots that do not
        overlap never will.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    horizon_s: float = 10.0
    wall_horizon_s: float = 10.0
    keep_apart: bool = True

    def __post_init__(self) -> None:
        super().__post_init__()
        require_finite_positive(horizon_s=self.horizon_s)


@dataclass(frozen=True)
class Orca:
    """Optimal reciprocal collision avoidance, 2-D and 3-D."""

    params: Parameters = field(default_factory=Parameters)
    name: ClassVar[str] = "ORCA"

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """See `Method`."""
        require_finite_positive(dt=dt)
        p = self.params
        known = agents.in_plane() if agents.dimensions == 2 else agents.in_space()
        chosen: Floats = known.orca(
            obstacles.still(agents.dimensions),
            dt,
            horizon=p.horizon_s,
            apart=p.keep_apart,
            **p.for_core(),
        )
        return chosen
