"""AVO: acceleration-velocity obstacles [berg-snape2011]; in the plane.

A robot that chooses a velocity gets to it by proportional control, with an acceleration within its limit. The obstacle
of another robot holds the relative velocities that lead into contact within the horizon if both do so, which is a
disc for each moment. Each of two robots takes its part of the change that leads to the nearest point of the border, as
in ORCA, and the velocity nearest to the preferred one is found by the same linear program, within what the limit
allows. The border is found on 24 discs of each obstacle.

The obstacle is not convex, so a half-plane beyond its border promises less than ORCA's. Beside the paper, no robot
chooses a velocity from which it could not stop within half of the gap to another, or before a wall; where that leaves
nothing, it brakes.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import ClassVar

import numpy as np

from muster import core
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_finite_positive
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles
from muster.motion.avoidance.parameters import CommonParameters


@dataclass(frozen=True, kw_only=True)
class Parameters(CommonParameters):
    """Parameters of AVO. See `CommonParameters` for the rest.

    Parameters
    ----------
    acceleration_mps2
        the limit of every robot.
    horizon_s
        tau: for how long a velocity keeps robots apart.
    response_s
        delta: the acceleration is the change of the velocity over this time.

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    acceleration_mps2: float = 1.0
    horizon_s: float = 5.0
    response_s: float = 0.5

    def __post_init__(self) -> None:
        super().__post_init__()
        require_finite_positive(
            acceleration_mps2=self.acceleration_mps2, horizon_s=self.horizon_s, response_s=self.response_s
        )


@dataclass(frozen=True)
class Avo:
    """Acceleration-velocity obstacles, 2-D."""

    params: Parameters = field(default_factory=Parameters)
    name: ClassVar[str] = "AVO"

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """See `Method`; robots in the plane only. None differs from the present one by more than the limit allows."""
        require_finite_positive(dt=dt)
        p = self.params
        chosen: Floats = core.avo(
            agents.in_plane(),
            np.full(len(agents.radii), p.acceleration_mps2),
            obstacles.still(2),
            dt,
            horizon=p.horizon_s,
            response=p.response_s,
            **p.for_core(),
        )
        return chosen
