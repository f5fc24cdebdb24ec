"""What disturbs simulated robots: errors of motion and of telemetry, and the wind.

The physics world makes gusts of the wind (`muster_physics`). Imported by the command: no heavy module is imported.
"""

from __future__ import annotations

from typing import Any

from muster.mission.records import Settings, record, spec
from muster.mission.value_types import Fault, JsonSchema, Number, is_list, refuse

_AMOUNT = Number(minimum=0.0)


@record
class Noise(Settings):
    """The noise of all robots alike; all 0 by default. It is drawn from the world's seed.

    Raises
    ------
    ParameterError
        if one is negative or not finite, or `slip` is above 1.
    """

    velocity: float = spec(
        _AMOUNT,
        "standard deviation of the share of its velocity that a robot loses in a step. It never gains velocity, so "
        "that noise alone brings no robot into contact",
        default=0.0,
    )
    slip: float = spec(
        Number(minimum=0.0, maximum=1.0),
        "the greatest share of its way that a robot loses in a step although its odometry counts it; uniform from 0",
        default=0.0,
    )
    odometry: float = spec(_AMOUNT, "standard deviation of the share by which odometry errs in a step", default=0.0)
    motors: float = spec(
        _AMOUNT,
        "standard deviation of the share by which the force of a motor or rotor differs from its command in a step of "
        "the world; in the physics world alone, as robots of the kinematic world have no motors",
        default=0.0,
    )
    position_m: float = spec(
        _AMOUNT, "standard deviation of each coordinate of the position that telemetry gives", default=0.0
    )
    heading_rad: float = spec(
        _AMOUNT, "standard deviation of the heading that telemetry gives", unit="rad", default=0.0
    )
    attitude_rad: float = spec(
        _AMOUNT, "standard deviation of the estimated roll and of the estimated pitch", unit="rad", default=0.0
    )
    gyro_radps: float = spec(_AMOUNT, "standard deviation of the inertial unit's yaw rate in a step", default=0.0)
    gyro_bias_radps: float = spec(
        _AMOUNT, "standard deviation of the inertial unit's constant bias, drawn for each robot", default=0.0
    )
    accelerometer_mps2: float = spec(
        _AMOUNT,
        "standard deviation of each coordinate of the acceleration that the inertial unit gives in a step",
        default=0.0,
    )
    camera_delay_s: float = spec(
        _AMOUNT, "by how much an image is older than the pose that a camera's robot takes it to be from", default=0.0
    )

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


class _Velocity:
    """The kind of a velocity of the air; without a third number the air does not rise."""

    filler = (0.0, 0.0, 0.0)
    expected = "[east, north] or [east, north, up], finite numbers in m/s"

    def read(self, value: object, at: tuple[str | int, ...], faults: list[Fault]) -> Any:
        """See `Kind`."""
        numbers = tuple(map(Number().of, value)) if is_list(value) and len(value) in (2, 3) else (None,)
        return refuse(self, value, at, faults) if None in numbers else (*numbers, 0.0)[:3]

    def schema(self) -> JsonSchema:
        """See `Kind`."""
        return {"type": "array", "items": {"type": "number"}, "minItems": 2, "maxItems": 3}


@record
class Wind(Settings):
    """The wind of a mission, the same everywhere but for gusts.

    Raises
    ------
    ParameterError
        if a number is not finite, or `gusts_mps` below 0.
    """

    velocity_mps: tuple[float, float, float] = spec(
        _Velocity(),
        "velocity of the air: east, north, up",
        default=(0.0, 0.0, 0.0),
        option="--wind",
        metavar="EAST,NORTH[,UP]",
    )
    gusts_mps: float = spec(
        _AMOUNT,
        "gusts, by the wind speed at 6 m (20 ft) by which [milf1980] gives their strength: 7.7 light, 15 moderate, 23 "
        "high",
        default=0.0,
        option="--gusts",
    )

    @property
    def blows(self) -> bool:
        """Whether there is any wind."""
        return self != CALM


NO_NOISE = Noise()
CALM = Wind()
