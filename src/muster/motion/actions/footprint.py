"""The piece of flat ground that a robot's camera sees: [tcf-thesis] (4.26), (4.27), (4.31).

Seen from the body it is a trapezoid ahead, from the near edge of the picture to its middle row; what the picture shows
beyond does not count, as in (4.27), for it may reach to the horizon. Its middle is r of (4.26) ahead of the camera.
w_c of (4.31) is its width there, across the way of flight, for pictures of any aspect; (4.28) has the width along the
view, which is the same where the camera looks straight down and the picture is square.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.mission.model import Camera
from muster.motion.actions.action import Impossible
from muster.motion.grid import Floats

_FARTHEST = 1e6
"""Heights: from farther away rounding leaves nothing of the angles."""


@dataclass(frozen=True)
class Footprint:
    """What a camera sees of the ground, metres, in the body's frame.

    Parameters
    ----------
    near_m, middle_m
        how far ahead of the body the near edge and the middle row of the picture are; below 0 is behind it.
    near_half_m, middle_half_m
        half the width there.
    left_m
        how far to the left of the body its middle line is.
    around_m
        the radius of what it sees around the body, whatever the heading; 0 where it sees only what is ahead.
    """

    near_m: float
    middle_m: float
    near_half_m: float
    middle_half_m: float
    left_m: float
    around_m: float

    @property
    def width_m(self) -> float:
        """w_c of (4.31): the width at the middle row."""
        return 2 * self.middle_half_m

    def nearest_m(self, aside_m: Floats) -> Floats:
        """How far ahead a place at such distances from the middle line is seen first; inf where it is not."""
        widens = (self.middle_m - self.near_m) / (self.middle_half_m - self.near_half_m or math.inf)
        ahead = self.near_m + np.maximum(0.0, np.abs(aside_m) - self.near_half_m) * widens
        found: Floats = np.where(np.abs(aside_m) <= self.middle_half_m * (1 + 1e-12), ahead, np.inf)
        return found


def footprint_of(camera: Camera, height_m: float) -> Footprint | Impossible:
    """The footprint of a camera on a body so high above the ground."""
    if camera.tilt_deg <= 0:
        return Impossible(f"its camera (tilt_deg {camera.tilt_deg:g}) does not look down")
    forward, left, up = (*camera.mount, 0.0)[:3]
    height = height_m + up
    if height <= 0:
        return Impossible(f"its camera is not above the ground at height_m {height_m:g}")
    sin, cos = math.sin(math.radians(camera.tilt_deg)), math.cos(math.radians(camera.tilt_deg))
    across = math.tan(math.radians(camera.fov_deg) / 2)
    along = across * camera.height_px / camera.width_px
    if not 1 / _FARTHEST < across < _FARTHEST or cos > sin * _FARTHEST:
        return Impossible(f"its camera (fov_deg {camera.fov_deg:g}, tilt_deg {camera.tilt_deg:g}) sees too little")
    near = height * (cos - along * sin) / (sin + along * cos)
    near_half = height * across / (sin + along * cos)
    return Footprint(
        near_m=near + forward,
        middle_m=height * cos / sin + forward,
        near_half_m=near_half,
        middle_half_m=height * across / sin,
        left_m=left,
        around_m=max(0.0, min(near_half, -near) - math.hypot(forward, left)),
    )
