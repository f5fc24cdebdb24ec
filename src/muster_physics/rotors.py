"""The rotors of drones that are simulated rotor by rotor: speeds that follow commands, thrust, moments, drag.

The motor model of [furrer2016]: each speed follows its command as a first-order lag, faster up than down; thrust and
moment go with its square; air across the axis drags with speed and airspeed [martin2010].
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Floats
from muster_physics.airframes import MOST_ROTORS, Airframe
from muster_physics.vectors import cross


@dataclass
class RotorState:
    """State of the rotors of all robots of a model, robots without rotors included.

    Parameters
    ----------
    speeds
        (n, MOST_ROTORS) rad/s.
    disturbances
        (n, 6): accelerations by what the controller does not know of, as it estimates them; see `DisturbanceObserver`.
    wind
        (n, 3): the velocity of the air around each robot, m/s.
    """

    speeds: Floats
    disturbances: Floats
    wind: Floats

    @classmethod
    def hovering(cls, airframes: Sequence[Airframe | None]) -> RotorState:
        """Rotors at the speed of hovering; None: a robot without rotors."""
        count = len(airframes)
        speeds = np.zeros((count, MOST_ROTORS))
        for k, airframe in enumerate(airframes):
            if airframe is not None:
                speeds[k, : len(airframe.rotors)] = airframe.hover_radps
        return cls(speeds, np.zeros((count, 6)), np.zeros((count, 3)))


class Rotors:
    """Rotors of some airframes as arrays: (n, MOST_ROTORS), 0 where an airframe has fewer."""

    def __init__(self, airframes: Sequence[Airframe], step_s: float) -> None:
        shape = len(airframes), MOST_ROTORS
        self.places, turns = np.zeros((*shape, 3)), np.zeros(shape)
        self.to_thrusts = np.zeros((*shape, 4))
        for k, one in enumerate(airframes):
            count = len(one.rotors)
            self.places[k, :count] = [(x, y, one.rotor_height_m) for x, y, _ in one.rotors]
            turns[k, :count] = [turn for _, _, turn in one.rotors]
            self.to_thrusts[k, :count] = np.linalg.pinv(one.allocation)
        self.constant = np.array([one.motor_constant for one in airframes])[:, None]
        self.yaw_arms = -np.array([one.moment_constant for one in airframes])[:, None] * turns
        self.most_radps = np.array([one.most_radps for one in airframes])[:, None]
        self.most_thrust = self.constant * self.most_radps**2
        self.drag = np.array([one.drag for one in airframes])[:, None]
        self.rolling = np.array([one.rolling for one in airframes])[:, None]
        self._up = np.array([-math.expm1(-step_s / one.up_s) for one in airframes])[:, None]
        self._down = np.array([-math.expm1(-step_s / one.down_s) for one in airframes])[:, None]

    def followed(self, speeds: Floats, commanded: Floats) -> Floats:
        """The speeds after a step in which they follow commands, exactly as a first-order lag does."""
        wanted = np.clip(commanded, 0.0, self.most_radps)
        after: Floats = speeds + np.where(wanted > speeds, self._up, self._down) * (wanted - speeds)
        return after

    def allocated(self, moments: Floats, thrust: Floats) -> Floats:
        """Commanded speeds (n, rotors) for moments (n, 3) about the body's axes and a whole thrust (n,).

        The yaw moment gets what the others leave: its rotors turn by at most what keeps all within their limits.
        """
        wrench = np.column_stack([moments[:, :2], np.zeros(len(thrust)), thrust])
        level = np.clip((self.to_thrusts @ wrench[:, :, None])[:, :, 0], 0.0, self.most_thrust)
        yaw = self.to_thrusts[:, :, 2] * moments[:, 2:]
        room = np.where(yaw > 0, self.most_thrust - level, level)
        share = np.min(np.where(yaw != 0, room / np.maximum(np.abs(yaw), 1e-12), np.inf), axis=1, keepdims=True)
        speeds: Floats = np.sqrt(np.maximum(level + np.minimum(share, 1.0) * yaw, 0.0) / self.constant)
        return speeds

    def thrusts(self, speeds: Floats) -> Floats:
        """(n, rotors) N."""
        found: Floats = self.constant * speeds**2
        return found

    def moments(self, thrusts: Floats) -> Floats:
        """(n, 3): of thrusts about the body's axes, N m."""
        about_x = (self.places[:, :, 1] * thrusts).sum(axis=1)
        about_y = -(self.places[:, :, 0] * thrusts).sum(axis=1)
        return np.column_stack([about_x, about_y, (self.yaw_arms * thrusts).sum(axis=1)])

    def drags(self, speeds: Floats, airspeeds: Floats, rates: Floats) -> tuple[Floats, Floats]:
        """Force (n, 3) and moment (n, 3) in the body frame of air that meets the rotors, N and N m.

        Parameters
        ----------
        airspeeds, rates
            (n, 3) velocity of the body against the air, and angular velocity, both in the body frame.
        """
        met = airspeeds[:, None, :] + cross(rates[:, None, :], self.places)
        met[:, :, 2] = 0.0
        forces = -(self.drag * speeds)[:, :, None] * met
        turning = cross(self.places, forces) - (self.rolling * speeds)[:, :, None] * met
        return forces.sum(axis=1), turning.sum(axis=1)

    def power(self, speeds: Floats) -> Floats:
        """(n,) W: moments about the axes times speeds."""
        found: Floats = (np.abs(self.yaw_arms) * self.thrusts(speeds) * speeds).sum(axis=1)
        return found
