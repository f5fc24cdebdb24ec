"""A world's model to look at: bodies are put where one wants them, in colours that tell them apart, between low walls.

A copy, with its own state: the world goes on by itself.
"""

from __future__ import annotations

import copy
from collections.abc import Callable, Sequence
from typing import Any

import mujoco
import numpy as np

from muster.motion.grid import Floats
from muster.simulation.physics.bodies import Build
from muster.simulation.physics.marks import Rgba
from muster.simulation.physics.model import FIRST_WALLS_BIT, GROUND_BIT, ROBOTS_BIT, UNSEEN
from muster.simulation.physics.stage import Stage

GROUND_RGBA: Rgba = (0.97, 0.975, 0.98, 1.0)
WALL_RGBA: Rgba = (0.74, 0.76, 0.8, 1.0)
GLASS_RGBA: Rgba = (0.85, 0.3, 0.3, 0.12)
_LIGHT = 0.55
"""From everywhere: what lies level is as bright as its colour."""
_SLICES = 40
_AWAY_M = -1000.0
"""The height of a robot that is not there."""
_SAMPLES = 4


class Tableau:
    """Takes the place of a world for a `Renderer`.

    Parameters
    ----------
    stage
        whose robots and walls are shown.
    colors
        of the robots, in order.
    wall_top
        to which height a wall is shown that has its middle at x, y, metres in the map frame.
    smooth
        whether edges are, which takes four times as long.
    """

    def __init__(
        self, stage: Stage, colors: Sequence[Rgba], wall_top: Callable[[float, float], float], *, smooth: bool = False
    ) -> None:
        self._robots = stage
        self.model: Any = copy.copy(stage.model)
        self.data: Any = mujoco.MjData(self.model)
        self.ground_m = float(self.model.geom("ground").pos[2])
        self.model.geom("ground").rgba = GROUND_RGBA
        self._show_walls(wall_top)
        for k, color in enumerate(colors):
            self._paint(k, color)
        self.model.vis.headlight.ambient = (_LIGHT,) * 3
        self.model.vis.quality.numslices = _SLICES
        if smooth:
            self.model.vis.quality.offsamples = _SAMPLES

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
        there = np.isfinite(frames).all(axis=1, keepdims=True)
        places = self._robots.places
        self.data.qpos[places[:, :3]] = np.where(there, frames, (0.0, 0.0, _AWAY_M))
        self.data.qpos[places[:, 3:]] = np.where(there, turns, (1.0, 0.0, 0.0, 0.0))
        mujoco.mj_kinematics(self.model, self.data)
        mujoco.mj_camlight(self.model, self.data)

    def _show_walls(self, wall_top: Callable[[float, float], float]) -> None:
        """Each once, though robots of several kinds are stopped by it; those that stop drones alone like glass."""
        model, ground_sets = self.model, self._sets_of_ground_robots()
        stops = np.asarray(model.geom_contype & ~(GROUND_BIT | ROBOTS_BIT))
        standing = np.asarray((model.geom_bodyid == 0) & (stops != 0))
        twins: dict[tuple[float, ...], list[int]] = {}
        for k in np.flatnonzero(standing).tolist():
            where = np.concatenate([model.geom_pos[k, :2], model.geom_quat[k], model.geom_size[k, :2]])
            twins.setdefault(tuple(np.round(where, 6)), []).append(k)
        for alike in twins.values():
            shown, *others = alike
            solid = any(model.geom_contype[k] & ground_sets for k in alike)
            bottom = model.geom_pos[shown, 2] - model.geom_size[shown, 2]
            top = max(wall_top(*model.geom_pos[shown, :2].tolist()), bottom + 0.01)
            model.geom_pos[shown, 2], model.geom_size[shown, 2] = (top + bottom) / 2, (top - bottom) / 2
            model.geom_rgba[shown] = WALL_RGBA if solid else GLASS_RGBA
            model.geom_group[others] = UNSEEN

    def _sets_of_ground_robots(self) -> int:
        """The bits of the walls that stop them."""
        robots = (robot for robot in self._robots.robots if robot.body.build is not Build.ROTORS)
        return sum({1 << (FIRST_WALLS_BIT + robot.walls) for robot in robots if robot.walls is not None})

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
