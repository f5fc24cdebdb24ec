"""What is put into a picture that is no body: flat marks on the ground, trails, poles. Nothing touches them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np

from muster.motion.grid import Floats

Rgba = tuple[float, float, float, float]
"""Red, green, blue and how opaque: 0 to 1."""

_UPRIGHT = np.eye(3)
_GLOW = 0.55
"""Of its colour a mark shines by itself, so that it looks alike whatever the light."""


@dataclass(frozen=True, eq=False)
class Mark:
    """A shape of MuJoCo's in a picture.

    Parameters
    ----------
    shape
        an mjtGeom.
    place, axes, size
        its middle (3,) in the map frame, metres; its axes as the columns of (3, 3); its half sizes (3,), as MuJoCo has
        them.
    color
        of it.
    """

    shape: int
    place: Floats
    axes: Floats
    size: Floats
    color: Rgba

    def put(self, scene: Any) -> None:
        """Into a scene of MuJoCo's that has room for it."""
        if scene.ngeom >= scene.maxgeom:
            return
        geom = scene.geoms[scene.ngeom]
        mujoco.mjv_initGeom(geom, self.shape, self.size, self.place, self.axes.ravel(), np.array(self.color, np.float32))
        geom.emission, geom.specular = _GLOW, 0.0
        scene.ngeom += 1


def disc(place: Floats, radius_m: float, color: Rgba, thick_m: float = 0.002) -> Mark:
    """A flat round plate whose upper side is at `place`."""
    middle, size = place - (0.0, 0.0, thick_m / 2), np.array([radius_m, thick_m / 2, 0.0])
    return Mark(mujoco.mjtGeom.mjGEOM_CYLINDER, middle, _UPRIGHT, size, color)


def ball(place: Floats, radius_m: float, color: Rgba) -> Mark:
    """A ball."""
    return Mark(mujoco.mjtGeom.mjGEOM_SPHERE, place, _UPRIGHT, np.full(3, radius_m), color)


def block(place: Floats, sides_m: Floats, yaw: float, color: Rgba) -> Mark:
    """A box turned about the upright axis; `place` (3,) is its middle, `sides_m` (3,) its whole sides."""
    c, s = np.cos(yaw), np.sin(yaw)
    axes = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return Mark(mujoco.mjtGeom.mjGEOM_BOX, place, axes, sides_m / 2, color)


def strip(start: Floats, end: Floats, width_m: float, thick_m: float, color: Rgba) -> Mark | None:
    """A straight band from (3,) to (3,), level across; None where both are the same place."""
    along = end - start
    length = float(np.linalg.norm(along))
    if length < 1e-9:
        return None
    ahead = along / length
    left = np.cross((0.0, 0.0, 1.0), ahead)
    left = left / np.linalg.norm(left) if np.linalg.norm(left) > 1e-9 else np.array([0.0, 1.0, 0.0])
    axes = np.column_stack([ahead, left, np.cross(ahead, left)])
    return Mark(
        mujoco.mjtGeom.mjGEOM_BOX, (start + end) / 2, axes, np.array([length, width_m, thick_m]) / 2, color
    )
