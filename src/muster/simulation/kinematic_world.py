"""The fast world: robots as discs or balls that move exactly by their kinematics in fixed steps of virtual time."""

from __future__ import annotations

from muster.simulation.crowded_world import CrowdedWorld, Event


class KinematicWorld(CrowdedWorld):
    """Robots that go as they are told, but for noise; see `CrowdedWorld`."""

    def _go_on(self, until_s: float) -> list[Event]:
        return self._crowd.advance(until_s)
