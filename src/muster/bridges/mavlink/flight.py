"""A point that flies: how the simulated autopilot moves. NED, metres, from where it was switched on."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.motion.port import Place


@dataclass
class Flight:
    """Straight to where it is told, at an even speed."""

    speed_mps: float = 5.0
    place: Place = (0.0, 0.0, 0.0)
    velocity: Place = (0.0, 0.0, 0.0)
    yaw: float = 0.0

    @property
    def flies(self) -> bool:
        return self.place[2] < -0.1

    def go(self, aim: Place, by_s: float) -> bool:
        """Fly towards a place for so long; whether it is there."""
        left = math.dist(self.place, aim)
        if left < 1e-6 or by_s <= 0:
            self.velocity = (0.0, 0.0, 0.0)
            return left < 1e-6
        share = min(1.0, self.speed_mps * by_s / left)
        step = [(b - a) * share for a, b in zip(self.place, aim, strict=True)]
        self.velocity = (step[0] / by_s, step[1] / by_s, step[2] / by_s)
        self.place = (self.place[0] + step[0], self.place[1] + step[1], self.place[2] + step[2])
        if math.hypot(step[0], step[1]) > 1e-6:
            self.yaw = math.atan2(step[1], step[0])
        return share >= 1.0
