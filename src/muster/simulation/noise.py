"""Noise of simulated robots: errors of motion, and errors of telemetry."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from muster.mission.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Noise:
    """The noise of all robots alike; all 0 by default. It is drawn from the world's seed.

    Parameters
    ----------
    velocity
        standard deviation of the share of its velocity that a robot loses in a step. It never gains velocity, so that
        noise alone brings no robot into contact.
    slip
        the greatest share of its way that a robot loses in a step although its odometry counts it; uniform from 0.
    odometry
        standard deviation of the share by which odometry errs in a step.
    motors
        standard deviation of the share by which the force of a motor or rotor differs from its command in a
        step of the world; in the physics world alone, as robots of the kinematic world have no motors.
    position_m, heading_rad
        standard deviations of each coordinate and of the heading that telemetry gives.
    attitude_rad
        standard deviation of the estimated roll and of the estimated pitch.
    gyro_radps, gyro_bias_radps
        standard deviations of the inertial unit's yaw rate in a step, and of its constant bias, drawn for each robot.
    accelerometer_mps2
        standard deviation of each coordinate of the acceleration that the inertial unit gives in a step.
    camera_delay_s
        the seconds by which an image is older than the pose that a camera's robot takes it to be from.

    Raises
    ------
    ParameterError
        if one is negative or not finite, or `slip` is above 1.
    """

    velocity: float = 0.0
    slip: float = 0.0
    odometry: float = 0.0
    motors: float = 0.0
    position_m: float = 0.0
    heading_rad: float = 0.0
    attitude_rad: float = 0.0
    gyro_radps: float = 0.0
    gyro_bias_radps: float = 0.0
    accelerometer_mps2: float = 0.0
    camera_delay_s: float = 0.0

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not 0 <= value < math.inf:
                raise ParameterError(f"{field.name}: {value}; expected a number of at least 0")
        if self.slip > 1:
            raise ParameterError(f"slip: {self.slip}; expected at most 1")

    @property
    def of_telemetry(self) -> bool:
        """Whether telemetry has errors: in poses, or of inertial units."""
        told = self.position_m, self.heading_rad, self.gyro_radps, self.gyro_bias_radps, self.accelerometer_mps2
        return any(told)

    @property
    def of_pose(self) -> bool:
        """Whether positions or headings in telemetry have errors."""
        return self.position_m > 0 or self.heading_rad > 0

    @property
    def of_odometry(self) -> bool:
        """Whether odometry counts what is not so: dead reckoning leads astray."""
        return self.slip > 0 or self.odometry > 0

    @property
    def of_gyro(self) -> bool:
        """Whether inertial units err about the rate of the heading."""
        return self.gyro_radps > 0 or self.gyro_bias_radps > 0


NO_NOISE = Noise()
