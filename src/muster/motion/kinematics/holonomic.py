"""Holonomic kinematics: a point that moves in any direction at once, as commanded."""

from __future__ import annotations

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.kinematics.kinematics import reached, shortened, turn_towards
from muster.motion.limits import Limits


class Holonomic:
    """Inputs (n, 4): velocity in the map frame in m/s, and yaw rate."""

    name = "holonomic"
    faces_its_way = False
    input_names = ("east_mps", "north_mps", "up_mps", "yaw_rate_radps")

    def velocities(self, states: Floats, inputs: Floats) -> Floats:
        return inputs.copy()

    def step(self, states: Floats, inputs: Floats, dt: float) -> Floats:
        return states + inputs * dt

    def limited(self, inputs: Floats, limits: Limits, before: Floats | None = None, dt: float = 0.0) -> Floats:
        past = None if before is None else before[:, :3]
        velocity = reached(shortened(inputs[:, :3], limits.speed_mps), past, limits.acceleration_mps2, dt)
        yaw_rate = np.clip(inputs[:, 3], -limits.yaw_rate_radps, limits.yaw_rate_radps)
        return np.column_stack([velocity, yaw_rate])

    def inputs(self, states: Floats, wanted: Floats, headings: Floats | None, limits: Limits) -> Floats:
        yaw_rate = turn_towards(states[:, 3], headings, limits.yaw_rate_radps)
        return self.limited(np.column_stack([wanted, yaw_rate]), limits)
