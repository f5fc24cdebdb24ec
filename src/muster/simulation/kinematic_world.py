"""The fast world: robots as discs or balls that move exactly by their kinematics in fixed steps of virtual time."""

from __future__ import annotations

import numpy as np

from muster.motion.grid import Floats
from muster.motion.map_world import body_of
from muster.perception.laser import NO_DISCS, Scanner, faces_at
from muster.simulation.crowded_world import CrowdedWorld, Event
from muster.simulation.lasers import discs_at, mounted_m


class KinematicWorld(CrowdedWorld):
    """Robots that go as they are told, but for noise; see `CrowdedWorld`."""

    def scan(self, robot: str, scanner: Scanner, cylinders: Floats = NO_DISCS, height_m: float | None = None) -> Floats:
        """See `SimulatedWorld`. Robots are seen as large as their radius; those without are not seen."""
        number = self._number(robot)
        it, places = self._robots[number], self.positions
        x, y, z = map(float, places[number])
        height = z + mounted_m(it, height_m)
        walls = faces_at(self._faces_for(body_of(it))[0], height)
        others = discs_at(self._robots, places, number, height)
        pose = (x, y, float(self.headings[number]))
        return np.minimum(scanner.ranges(pose, walls, others), scanner.ranges(pose, discs=cylinders))

    def _go_on(self, until_s: float) -> list[Event]:
        return self._crowd.advance(until_s)
