"""The lidar of a simulated robot behind a bridge, and the map that the robot builds with it, as an occupancy grid."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import numpy.typing as npt

from muster.mission.model import Robot
from muster.motion.grid import Grid
from muster.motion.map_world import World, body_of
from muster.motion.port import Place
from muster.perception.explored_ground import map_to_build
from muster.perception.laser import LIDAR, NO_DISCS, faces_at
from muster.perception.occupancy_map import Scan
from muster.planning.loading import load
from muster.simulation.walls import faces_and_slabs

MAP_S = 1.0
"""Seconds between two messages of the map."""
_SCAN_S = 0.2
_LASER_M = 0.1
"""Height of the lidar."""


class SimulatedMapping:
    """What one robot has seen of the obstacles of a mission.

    Parameters
    ----------
    mission : Path
        File of the mission whose obstacles the lidar sees.
    robot : Robot
        The robot.
    """

    def __init__(self, mission: Path, robot: Robot) -> None:
        world, body = World.of(load(mission)), body_of(robot)
        self._walls = faces_at(faces_and_slabs(world, body)[0], _LASER_M)
        self._map = map_to_build(world, [robot.radius_m])
        self._scanned_s = self._told_s = -math.inf

    @property
    def frame(self) -> Grid:
        """The cells of the map, in the frame of the mission."""
        return self._map.frame

    def look(self, now: float, place: Place, heading: float) -> bool:
        """Scan from a place, metres, with a heading, radians, if that is due; return whether the map is to be told."""
        if now >= self._scanned_s + _SCAN_S:
            self._scanned_s = now
            pose = (place[0], place[1], heading)
            self._map.see(Scan.of(pose, LIDAR.ranges(pose, self._walls, NO_DISCS)), LIDAR)
        is_due = now >= self._told_s + MAP_S
        if is_due:
            self._told_s = now
        return is_due

    def per_cent(self) -> npt.NDArray[np.int8]:
        """Return the occupancy of the cells (rows * columns,): 0, 100, or -1 where nothing was seen."""
        cells = np.where(self._map.known, 0, -1)
        cells[self._map.occupied] = 100
        return cells.astype(np.int8).ravel()
