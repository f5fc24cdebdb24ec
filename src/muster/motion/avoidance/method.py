"""The one interface of all methods of collision avoidance."""

from __future__ import annotations

from typing import Protocol

from muster.mission.values.arrays import Floats
from muster.motion.avoidance.agents import NO_OBSTACLES, Agents, Obstacles


class Method(Protocol):
    """Chooses new velocities for all robots at once, each of them as if it decided for itself."""

    @property
    def name(self) -> str: ...

    def velocities(self, agents: Agents, obstacles: Obstacles = NO_OBSTACLES, dt: float = 0.25) -> Floats:
        """New velocities (n, d), m/s in the map frame, to be kept for `dt` seconds; none is above its maximum speed.

        Raises
        ------
        ParameterError
            if dt is not above 0, or the method is not for so many dimensions.
        """
        ...
