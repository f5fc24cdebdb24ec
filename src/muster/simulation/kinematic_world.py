"""The fast world: robots as discs or balls that move exactly by their kinematics in fixed steps of virtual time."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.mission.model import Tag
from muster.motion.grid import Floats
from muster.motion.map_world import body_of
from muster.perception.laser import NO_DISCS, Scanner, faces_at
from muster.simulation.cameras import GeometricCameras
from muster.simulation.declaration import EXACT, declares
from muster.simulation.energy import LACKS_ENERGY
from muster.simulation.lasers import discs_seen_at, laser_height_m
from muster.simulation.world_base import Event, WorldBase


@declares(settings=("law", *LACKS_ENERGY, "snapshot"), abilities=(EXACT,))
class KinematicWorld(WorldBase):
    """Robots that follow their velocity commands exactly, but for noise; see `WorldBase`."""

    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """See `SimulatedWorld`. Robots are seen as large as their radius; those without are not seen."""
        number = self._number(robot)
        it, places = self._robots[number], self.positions
        x, y, z = map(float, places[number])
        height = z + laser_height_m(it, height_m)
        walls = faces_at(self._faces_for(body_of(it))[0], height)
        others = discs_seen_at(self._robots, places, number, height)
        pose = (x, y, float(self.headings[number]))
        return np.minimum(scanner.ranges(pose, walls, others), scanner.ranges(pose, discs=cylinders))

    def cameras(self, tags: Sequence[Tag], seed: int) -> GeometricCameras:
        """See `WithCameras`; pictures are not drawn."""
        return GeometricCameras(tags, seed)

    def _go_on(self, until_s: float) -> list[Event]:
        return self._crowd.advance(until_s)
