"""A world's model to look at: bodies are put where one wants them, in colours that tell them apart, between low walls.

A copy, with its own state: the world goes on by itself.
"""

from __future__ import annotations

import copy
from collections.abc import Sequence
from typing import Any

import mujoco
import numpy as np

from muster.motion.grid import Floats
from muster.simulation.physics.bodies import Build
from muster.simulation.physics.marks import Rgba
from muster.simulation.physics.model import GROUND_BIT, ROBOTS_BIT, UNSEEN
from muster.simulation.physics.stage import Stage

GROUND_RGBA: Rgba = (0.93, 0.94, 0.95, 1.0)
WALL_RGBA: Rgba = (0.62, 0.64, 0.68, 1.0)
_AWAY_M = -1000.0
"""The height of a robot that is not there."""
_SHADOW_PX, _SAMPLES = 4096, 4


class Tableau:
    """Takes the place of a world for a `Renderer`.

    Parameters
    ----------
    stage
        whose robots and walls are shown.
    colors
        of the robots, in order.
    wall_m
        the height above the ground to which walls are shown, so that one sees over them.
    fine
        with shadows and smooth edges, which take ten times as long.
    """

    def __init__(self, stage: Stage, colors: Sequence[Rgba], wall_m: float, *, fine: bool = False) -> None:
        self._robots = stage
        self.model: Any = copy.copy(stage.model)
        self.data: Any = mujoco.MjData(self.model)
        self.ground_m = float(self.model.geom("ground").pos[2])
        self.model.geom("ground").rgba = GROUND_RGBA
        self._cut_walls(wall_m)
        for k, color in enumerate(colors):
            self._paint(k, color)
        if fine:
            self.model.vis.quality.shadowsize, self.model.vis.quality.offsamples = _SHADOW_PX, _SAMPLES

    @property
    def stage(self) -> Tableau:
        """What a renderer draws."""
        return self

    def put(self, frames: Floats, turns: Floats) -> None:
        """Put the bodies somewhere.

        Parameters
        ----------
        frames, turns
            (n, 3) metres, and (n, 4) quaternions, w first, in the map frame; who has NaN is not there.
        """
        there = np.isfinite(frames).all(axis=1)[:, None]
        places = self._robots.places
        self.data.qpos[places[:, :3]] = np.where(there, frames, (0.0, 0.0, _AWAY_M))
        self.data.qpos[places[:, 3:]] = np.where(there, turns, (1.0, 0.0, 0.0, 0.0))
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def _cut_walls(self, height_m: float) -> None:
        model = self.model
        standing = (model.geom_bodyid == 0) & (model.geom_contype & ~(GROUND_BIT | ROBOTS_BIT) != 0)
        for k in np.flatnonzero(standing):
            half, middle = model.geom_size[k, 2], model.geom_pos[k, 2]
            low, high = middle - half, min(middle + half, self.ground_m + height_m)
            high = max(high, low + 0.01)
            model.geom_size[k, 2], model.geom_pos[k, 2] = (high - low) / 2, (high + low) / 2
            model.geom_rgba[k] = WALL_RGBA

    def _paint(self, robot: int, color: Rgba) -> None:
        """Its rotors, or what of it is broadest."""
        model, body = self.model, self._robots.bodies[robot]
        seen = np.flatnonzero((model.geom_bodyid == body) & (model.geom_group != UNSEEN))
        if self._robots.robots[robot].body.build is Build.WHEELS:
            painted = seen[:1]
        else:
            painted = seen[model.geom_type[seen] == mujoco.mjtGeom.mjGEOM_CYLINDER]
        for k in painted:
            model.geom_rgba[k] = color
