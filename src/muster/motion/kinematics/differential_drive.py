"""The differential drive of [tcf-thesis], section 4.1.2: forward, backward, and turning."""

from __future__ import annotations

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.kinematics.kinematics import moved_along_arc, reached, turn_towards
from muster.motion.limits import Limits


class DifferentialDrive:
    """Inputs (n, 2) of (4.19): v ahead in m/s, omega in rad/s."""

    name = "differential-drive"
    faces_its_way = True
    input_names = ("ahead_mps", "yaw_rate_radps")

    def velocities(self, states: Floats, inputs: Floats) -> Floats:
        """(4.20)."""
        ahead, yaw = inputs[:, 0], states[:, 3]
        return np.column_stack([ahead * np.cos(yaw), ahead * np.sin(yaw), np.zeros_like(yaw), inputs[:, 1]])

    def step(self, states: Floats, inputs: Floats, dt: float) -> Floats:
        return moved_along_arc(states, inputs[:, 0], np.zeros(len(states)), inputs[:, 1], dt)

    def limited(self, inputs: Floats, limits: Limits, before: Floats | None = None, dt: float = 0.0) -> Floats:
        past = None if before is None else before[:, :1]
        wanted = np.clip(inputs[:, :1], -limits.speed_mps, limits.speed_mps)
        ahead = reached(wanted, past, limits.acceleration_mps2, dt)
        yaw_rate = np.clip(inputs[:, 1], -limits.yaw_rate_radps, limits.yaw_rate_radps)
        return np.column_stack([ahead, yaw_rate])

    def inputs(self, states: Floats, wanted: Floats, headings: Floats | None, limits: Limits) -> Floats:
        """(4.21)-(4.25). It drives backward where it looks away from its way; a robot that is to stand stays as it is.

        `headings` count where nothing is wanted of the velocity: there it turns to them.
        """
        speed = np.hypot(wanted[:, 0], wanted[:, 1])
        going = speed > 0
        aims = states[:, 3] if headings is None else headings
        off = np.where(going, np.arctan2(wanted[:, 1], wanted[:, 0]), aims) - states[:, 3]
        on_the_spot = turn_towards(states[:, 3], headings, limits.yaw_rate_radps)
        yaw_rate = np.where(going, limits.yaw_rate_radps * np.sin(off), on_the_spot)
        return self.limited(np.column_stack([speed * np.cos(off), yaw_rate]), limits)
