"""The quadcopter of [tcf-thesis], section 4.1.1: it hovers, climbs, turns, and glides in any direction meanwhile.

(4.8) prints x' = v_x cos + v_y sin; right is x' = v_x cos - v_y sin, y' = v_x sin + v_y cos, with which (4.15) and
(4.16) give the direction of travel that (4.11) asks for. (4.9) prints z_d - z_d for z_d - z_c.
"""

from __future__ import annotations

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.kinematics.kinematics import moved_along_arc, reached, shortened, turn_towards
from muster.motion.limits import Limits


class Quadcopter:
    """Inputs (n, 4) of (4.7): v_x ahead, v_y to the left, v_z up in m/s, omega in rad/s."""

    name = "quadcopter"
    faces_its_way = False
    input_names = ("ahead_mps", "left_mps", "up_mps", "yaw_rate_radps")

    def velocities(self, states: Floats, inputs: Floats) -> Floats:
        """(4.8), its sign corrected."""
        c, s = np.cos(states[:, 3]), np.sin(states[:, 3])
        ahead, left = inputs[:, 0], inputs[:, 1]
        return np.column_stack([ahead * c - left * s, ahead * s + left * c, inputs[:, 2:]])

    def step(self, states: Floats, inputs: Floats, dt: float) -> Floats:
        after = moved_along_arc(states, inputs[:, 0], inputs[:, 1], inputs[:, 3], dt)
        after[:, 2] += inputs[:, 2] * dt
        return after

    def limited(self, inputs: Floats, limits: Limits, before: Floats | None = None, dt: float = 0.0) -> Floats:
        level = shortened(inputs[:, :2], limits.speed_mps)
        climb = np.clip(inputs[:, 2], -limits.climb, limits.climb)
        past = None if before is None else before[:, :3]
        velocity = reached(np.column_stack([level, climb]), past, limits.acceleration_mps2, dt)
        yaw_rate = np.clip(inputs[:, 3], -limits.yaw_rate_radps, limits.yaw_rate_radps)
        return np.column_stack([velocity, yaw_rate])

    def inputs(self, states: Floats, wanted: Floats, headings: Floats | None, limits: Limits) -> Floats:
        """(4.11) and (4.13)-(4.16); of (4.12) the caller's `approach` makes the wanted climb."""
        off = np.arctan2(wanted[:, 1], wanted[:, 0]) - states[:, 3]
        level = np.hypot(wanted[:, 0], wanted[:, 1])
        yaw_rate = turn_towards(states[:, 3], headings, limits.yaw_rate_radps)
        made = np.column_stack([level * np.cos(off), level * np.sin(off), wanted[:, 2], yaw_rate])
        return self.limited(made, limits)
