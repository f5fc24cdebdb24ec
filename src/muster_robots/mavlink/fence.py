"""The fence of a drone: inside the map's boundary and outside the zones that are forbidden to it."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.mission.model import Mission, Robot
from muster.motion.map_world import World
from muster.motion.port import Place, Waypoint

_EVERY_M = 0.25
_ROUNDING_M = 0.05  # ways go along what is grown by the radius


class MapFence:
    """The fence of a mission with a map, for one robot.

    Parameters
    ----------
    world
        the map.
    robot
        its kind and its radius count.
    """

    def __init__(self, world: World, robot: Robot) -> None:
        self._world, self._robot = world, robot

    def __call__(self, here: Place, waypoints: Sequence[Waypoint]) -> str:
        """Why a robot may not go from a place straight through way points; empty if it may."""
        before = here
        for waypoint in waypoints:
            pieces = max(1, math.ceil(math.dist(before, waypoint.position) / _EVERY_M))
            way = np.linspace(before, waypoint.position, pieces + 1)[1:, : self._world.dimensions]
            clearance = self._world.clearance(way, self._robot.kind, self._robot.radius_m)
            bad = np.flatnonzero(clearance < self._robot.radius_m - _ROUNDING_M)
            if len(bad) and (before is not here or not _leaves(clearance)):
                place = ", ".join(f"{c:.2f}" for c in way[bad[0]])
                return f"way to ({place}); expected a way inside the boundary and outside of zones"
            before = waypoint.position
        return ""


def _leaves(clearance: np.ndarray[tuple[int], np.dtype[np.float64]]) -> bool:
    """Whether a way that begins too near to something only leads away from it, into the free."""
    return bool((np.diff(clearance) >= -1e-9).all() and clearance[-1] > 0)


def no_fence(here: Place, waypoints: Sequence[Waypoint]) -> str:
    """In a mission without a map a robot may go anywhere."""
    return ""


def fences_of(mission: Mission) -> dict[str, MapFence]:
    """For each robot of a mission its fence; none in a mission without a map.

    Raises
    ------
    MissionError, MissingExtraError
        as `World.of`.
    """
    if mission.map is None:
        return {}
    world = World.of(mission)
    return {robot.id: MapFence(world, robot) for robot in mission.robots}
