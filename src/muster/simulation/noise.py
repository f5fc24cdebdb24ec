"""What a simulated robot does other than it means to, and what it says of itself other than it is."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields

from muster.mission.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Noise:
    """Of all robots alike; all 0 by default. Drawn from the world's seed.

    Parameters
    ----------
    velocity
        standard deviation of the share of its velocity that a robot misses in a step. It never gets more than it
        wanted, so that noise alone brings no robot into contact.
    slip
        the most of its way, as a share, that a robot loses in a step though its odometry counts it; evenly from 0.
    odometry
        standard deviation of the share by which odometry errs in a step.
    motors
        standard deviation of the share by which the force of a motor or rotor differs from what is asked of it in a
        step of the world; in the physics world alone, as robots of the kinematic world have no motors.
    position_m, heading_rad
        standard deviations of each coordinate and of the heading that telemetry gives.
    attitude_rad
        standard deviation of the roll and of the pitch that a robot takes itself to have.
    gyro_radps, gyro_bias_radps
        standard deviations of the yaw rate that the inertial unit gives in a step, and of what each robot's gives too
        much all the time.
    accelerometer_mps2
        standard deviation of each coordinate of the acceleration that the inertial unit gives in a step.

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

    def __post_init__(self) -> None:
        for field in fields(self):
            value = getattr(self, field.name)
            if not 0 <= value < math.inf:
                raise ParameterError(f"{field.name}: {value}; expected a number of at least 0")
        if self.slip > 1:
            raise ParameterError(f"slip: {self.slip}; expected at most 1")

    @property
    def of_telemetry(self) -> bool:
        """Whether robots are not where they say, or their inertial units err."""
        told = self.position_m, self.heading_rad, self.gyro_radps, self.gyro_bias_radps, self.accelerometer_mps2
        return any(told)

    @property
    def of_pose(self) -> bool:
        """Whether robots are not where they say, or not turned so."""
        return self.position_m > 0 or self.heading_rad > 0


NO_NOISE = Noise()
