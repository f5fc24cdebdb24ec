"""How much sensors of a robot err: standard deviations that filters count with and simulated sensors draw from."""

from __future__ import annotations

from dataclasses import asdict, dataclass

from muster.mission.values.ranges import require_finite_not_negative


@dataclass(frozen=True, kw_only=True)
class _Deviations:
    """Numbers of at least 0."""

    def __post_init__(self) -> None:
        require_finite_not_negative(**asdict(self))


@dataclass(frozen=True, kw_only=True)
class GroundErrors(_Deviations):
    """Errors of a robot in the plane: standard deviations of independent errors.

    Parameters
    ----------
    acceleration_mps2, yaw_acceleration_radps2
        by how much its accelerations differ in a step from those that are measured; where none are, from 0.
    odometry_share, odometry_mps
        of the speed by wheels: a share of it, and what there is at rest; they add as variances.
    odometry_slip
        of the share of what wheels count that is never travelled, at the beginning; fixes tell the filter.
    climb_share
        of the metres by which a metre of way rises more or less than odometry has it.
    odometry_radps
        of the yaw rate by wheels.
    gyro_radps, gyro_bias_radps, gyro_walk
        of the yaw rate by the inertial unit; of its bias at the beginning; and by how much that wanders in a second
        (rad/s per root of s).
    position_m, heading_rad
        of fixes, each coordinate.
    range_m, bearing_rad
        of a landmark that is seen.

    Raises
    ------
    ParameterError
        if one is negative or not finite.
    """

    acceleration_mps2: float = 0.3
    yaw_acceleration_radps2: float = 1.0
    odometry_share: float = 0.02
    odometry_mps: float = 0.005
    odometry_slip: float = 0.02
    climb_share: float = 0.05
    odometry_radps: float = 0.05
    gyro_radps: float = 0.01
    gyro_bias_radps: float = 0.01
    gyro_walk: float = 1e-4
    position_m: float = 0.05
    heading_rad: float = 0.05
    range_m: float = 0.01
    bearing_rad: float = 0.01


@dataclass(frozen=True, kw_only=True)
class ReckoningErrors(_Deviations):
    """Errors of dead reckoning, for robots of all kinds: standard deviations of independent errors, and two means.

    Parameters
    ----------
    way_kept, turn_kept
        the share of the counted way, and of the counted turn, that is travelled in the mean.
    way_share
        of the way that odometry counts in a step, along it.
    aside_share
        of the same, in each direction.
    turn_share, turn_per_m
        of the turn that it counts in a step: a share of it, and radians for each metre of way; they add as variances.
    slip, skid
        of the share of the counted way, and of the counted turn, that is never travelled beside `way_kept` and
        `turn_kept`, at the beginning.
    gyro_radps, gyro_bias_radps, gyro_walk
        as in `GroundErrors`.

    Raises
    ------
    ParameterError
        if one is negative or not finite.
    """

    way_kept: float = 1.0
    turn_kept: float = 1.0
    way_share: float = 0.01
    aside_share: float = 0.01
    turn_share: float = 0.01
    turn_per_m: float = 0.02
    slip: float = 0.02
    skid: float = 0.02
    gyro_radps: float = 0.01
    gyro_bias_radps: float = 0.01
    gyro_walk: float = 1e-4


@dataclass(frozen=True, kw_only=True)
class AirErrors(_Deviations):
    """Errors of a drone: standard deviations of independent errors, for each coordinate of the map frame.

    Parameters
    ----------
    acceleration_mps2
        of the measured acceleration; where none is measured, of the acceleration itself.
    unfelt_mps2
        of the acceleration itself, for a tracker that misses the inertial reading.
    velocity_mps
        of the velocity by odometry, visual or other.
    odometry_slip
        of the share of what odometry counts that is never flown, at the beginning; fixes tell the filter.
    gyro_radps, gyro_bias_radps, gyro_walk
        as in `GroundErrors`.
    position_m, heading_rad
        of fixes.

    Raises
    ------
    ParameterError
        if one is negative or not finite.
    """

    acceleration_mps2: float = 0.2
    unfelt_mps2: float = 1.0
    velocity_mps: float = 0.05
    odometry_slip: float = 0.0
    gyro_radps: float = 0.01
    gyro_bias_radps: float = 0.01
    gyro_walk: float = 1e-4
    position_m: float = 0.05
    heading_rad: float = 0.05
