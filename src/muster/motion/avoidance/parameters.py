"""Parameters that all methods of collision avoidance have."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from muster.mission.values.ranges import require_counts, require_finite_positive, require_positive


@dataclass(frozen=True, kw_only=True)
class CommonParameters:
    """Common parameters.

    Parameters
    ----------
    wall_horizon_s
        for how long a velocity keeps off walls and other static obstacles.
    most_neighbours, neighbour_distance_m
        a robot considers the nearest others, up to this distance between centres.
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
        require_counts(1, most_neighbours=self.most_neighbours, threads=self.threads)

    def for_core(self) -> dict[str, Any]:
        """The same as keyword arguments of the core's methods."""
        return {
            "wall_horizon": self.wall_horizon_s,
            "most": self.most_neighbours,
            "distance": self.neighbour_distance_m,
            "threads": self.threads,
        }
