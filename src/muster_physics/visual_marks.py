"""Shapes in a picture that are no bodies: flat marks on the ground, trails, poles. Nothing touches them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.motion.grid import Floats
from muster_physics.buildings import Rgba
from muster_physics.library import mujoco

_UPRIGHT = np.eye(3)
_GLOW = 0.1
"""The share of its colour that a mark emits, beside the light that falls on it."""


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
        mujoco.mjv_initGeom(
            geom, self.shape, self.size, self.place, self.axes.ravel(), np.array(self.color, np.float32)
        )
        geom.emission, geom.specular = _GLOW, 0.0
        scene.ngeom += 1


def disc(place: Floats, radius_m: float, color: Rgba, thick_m: float = 0.002) -> Mark:
    """A flat round plate whose upper side is at `place`."""
    middle, size = place - (0.0, 0.0, thick_m / 2), np.array([radius_m, thick_m / 2, 0.0])
    return Mark(mujoco.mjtGeom.mjGEOM_CYLINDER, middle, _UPRIGHT, size, color)


def ball(place: Floats, radius_m: float, color: Rgba) -> Mark:
    """A ball."""
    return Mark(mujoco.mjtGeom.mjGEOM_SPHERE, place, _UPRIGHT, np.full(3, radius_m), color)


def strip(start: Floats, end: Floats, width_m: float, thick_m: float, color: Rgba) -> Mark | None:
    """A straight band from (3,) to (3,), level across; None where both are the same place."""
    x, y, z = (end - start).tolist()
    length, level = math.hypot(x, y, z), math.hypot(x, y)
    if length < 1e-9:
        return None
    c, s = (x / level, y / level) if level > 1e-9 else (1.0, 0.0)
    along, up = level / length, z / length
    axes = np.array([[c * along, -s, -c * up], [s * along, c, -s * up], [up, 0.0, along]])
    size = np.array([length / 2, width_m / 2, thick_m / 2])
    return Mark(mujoco.mjtGeom.mjGEOM_BOX, (start + end) / 2, axes, size, color)
