"""A model for pictures: bodies are put at any poses, in colours that tell robots apart."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from muster.motion.grid import Floats
from muster_physics.bodies import BodyKind
from muster_physics.buildings import Rgba
from muster_physics.library import mujoco
from muster_physics.model import UNSEEN
from muster_physics.simulated_model import SimulatedModel

GROUND_RGBA: Rgba = (0.97, 0.975, 0.98, 1.0)
_LIGHT = 0.55
"""Ambient light: a level surface is as bright as its colour."""
_SLICES = 40
_AWAY_M = -1000.0
"""The height of a robot that is not shown."""
_SAMPLES = 4


class PosedScene:
    """A model with settable poses that a `Renderer` draws in place of a world.

    Parameters
    ----------
    simulated
        a model of its own: see `PhysicsWorld.replica`.
    colors
        of the robots, in order.
    smooth
        whether edges are smoothed, which takes four times as long.
    """

    def __init__(self, simulated: SimulatedModel, colors: Sequence[Rgba], *, smooth: bool = False) -> None:
        self._robots = simulated
        self.model: Any = simulated.model
        self.data: Any = simulated.data
        self.ground_m = float(self.model.geom("ground").pos[2])
        self.model.geom("ground").rgba = GROUND_RGBA
        for k, color in enumerate(colors):
            self._paint(k, color)
        self.model.vis.headlight.ambient = (_LIGHT,) * 3
        self.model.vis.quality.numslices = _SLICES
        if smooth:
            self.model.vis.quality.offsamples = _SAMPLES

    @property
    def simulated(self) -> PosedScene:
        """What a renderer draws."""
        return self

    def put(self, frames: Floats, turns: Floats) -> None:
        """Set the poses of the bodies.

        Parameters
        ----------
        frames, turns
            (n, 3) metres, and (n, 4) quaternions, w first, in the map frame; a robot with NaN is not shown.
        """
        there = np.isfinite(frames).all(axis=1, keepdims=True)
        places = self._robots.places
        self.data.qpos[places[:, :3]] = np.where(there, frames, (0.0, 0.0, _AWAY_M))
        self.data.qpos[places[:, 3:]] = np.where(there, turns, (1.0, 0.0, 0.0, 0.0))
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def _paint(self, robot: int, color: Rgba) -> None:
        """Colour the rotors of a robot, or its hull."""
        model, body = self.model, self._robots.bodies[robot]
        seen = np.flatnonzero((model.geom_bodyid == body) & (model.geom_group != UNSEEN))
        if self._robots.robots[robot].body.kind is BodyKind.WHEELS:
            painted = seen[:1]
        else:
            painted = seen[model.geom_type[seen] == mujoco.mjtGeom.mjGEOM_CYLINDER]
        for k in painted:
            model.geom_rgba[k] = color
