"""The motion model of the simulated drone: a point with limited speed. NED, metres, origin where it was powered up."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.motion.frames import wrapped
from muster.motion.port import Place

_TURN_RADPS = 1.0
_FALLS_MPS = 8.0


@dataclass
class Flight:
    """Flies straight at constant speed; its yaw follows the flight, or a command, at a constant rate."""

    speed_mps: float = 5.0
    place: Place = (0.0, 0.0, 0.0)
    velocity: Place = (0.0, 0.0, 0.0)
    yaw: float = 0.0

    @property
    def flies(self) -> bool:
        return self.place[2] < -0.1

    def fall(self, by_s: float) -> None:
        """Fall for so long, to the ground, without motors."""
        north, east, down = self.place
        fallen = min(0.0, down + _FALLS_MPS * by_s)
        self.velocity = (0.0, 0.0, _FALLS_MPS if fallen < 0.0 else 0.0)
        self.place = (north, east, fallen)

    def is_turned(self, yaw: float | None) -> bool:
        return yaw is None or abs(float(wrapped(yaw - self.yaw))) < 1e-6

    def go(self, aim: Place, by_s: float, yaw: float | None = None, *, most_mps: float = math.inf) -> bool:
        """Fly towards a place for so long, and turn to a yaw if there is one; whether it is at the place."""
        if yaw is not None:
            most = _TURN_RADPS * by_s
            self.yaw += max(-most, min(most, float(wrapped(yaw - self.yaw))))
        left = math.dist(self.place, aim)
        if left < 1e-6 or by_s <= 0:
            self.velocity = (0.0, 0.0, 0.0)
            return left < 1e-6
        share = min(1.0, min(self.speed_mps, most_mps) * by_s / left)
        step = [(b - a) * share for a, b in zip(self.place, aim, strict=True)]
        self.velocity = (step[0] / by_s, step[1] / by_s, step[2] / by_s)
        self.place = (self.place[0] + step[0], self.place[1] + step[1], self.place[2] + step[2])
        if yaw is None and math.hypot(step[0], step[1]) > 1e-6:
            self.yaw = math.atan2(step[1], step[0])
        return share >= 1.0
