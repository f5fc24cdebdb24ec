"""The geometric tracking controller of [lee2010] with the gains of [furrer2016]: from errors to thrust and moments."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.motion.grid import Floats
from muster_physics.airframes import GRAVITY_MPS2, Airframe
from muster_physics.vectors import cross

UP = np.array([0.0, 0.0, 1.0])


class GeometricController:
    """Thrust and moments of some drones by where they are and where they should be.

    As in [furrer2016] the wanted angular velocity is that about the upright axis alone, and constant.
    """

    def __init__(self, airframes: Sequence[Airframe]) -> None:
        self.mass = np.array([one.mass_kg for one in airframes])
        self.inertia = np.array([one.inertia_kgm2 for one in airframes]).reshape(-1, 3)
        self.position = np.array([one.gains.position for one in airframes])
        self.velocity = np.array([one.gains.velocity for one in airframes])
        self.attitude = np.array([one.gains.attitude for one in airframes]).reshape(-1, 3)
        self.angular_rate = np.array([one.gains.angular_rate for one in airframes]).reshape(-1, 3)

    def wanted_force(self, position_error: Floats, velocity_error: Floats, acceleration: Floats) -> Floats:
        """-k_x e_x - k_v e_v + m g e_3 + m a_d: (n, 3) N in the map frame; errors are actual less wanted."""
        fed_back = -self.position[:, None] * position_error - self.velocity[:, None] * velocity_error
        found: Floats = fed_back + self.mass[:, None] * (GRAVITY_MPS2 * UP + acceleration)
        return found

    def thrust(self, force: Floats, axes: Floats) -> Floats:
        """The thrust, (n,) N: F . R e_3."""
        found: Floats = (force * axes[:, :, 2]).sum(axis=1)
        return found

    def moments(self, force: Floats, axes: Floats, rates: Floats, heading: Floats, yaw_rate: Floats) -> Floats:
        """M = -k_R e_R - k_Omega e_Omega + Omega x J Omega: (n, 3) N m in the body frame.

        Parameters
        ----------
        axes
            (n, 3, 3) R, the axes of the bodies as columns.
        rates
            (n, 3) Omega, in the body frame.
        heading, yaw_rate
            (n,) wanted.
        """
        relative = wanted_axes(force, heading).transpose(0, 2, 1) @ axes  # R_d^T R
        skew = 0.5 * (relative - relative.transpose(0, 2, 1))
        attitude_error = np.column_stack([skew[:, 2, 1], skew[:, 0, 2], skew[:, 1, 0]])
        wanted_rates = relative[:, 2, :] * yaw_rate[:, None]  # R^T R_d (0, 0, yaw rate)
        gyroscopic = cross(rates, self.inertia * rates)
        found: Floats = -self.attitude * attitude_error - self.angular_rate * (rates - wanted_rates) + gyroscopic
        return found


def wanted_axes(force: Floats, heading: Floats) -> Floats:
    """R_d: (n, 3, 3) whose third axis is along the wanted force, and whose first looks to the wanted heading."""
    up = force / np.linalg.norm(force, axis=1, keepdims=True)
    ahead = np.column_stack([np.cos(heading), np.sin(heading), np.zeros_like(heading)])
    left = cross(up, ahead)
    left /= np.linalg.norm(left, axis=1, keepdims=True)
    return np.stack([cross(left, up), left, up], axis=2)
