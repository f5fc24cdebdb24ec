"""Wheels of a differential drive ([market-paper], section 3.2.3, equations (5) and (6)).

With the rims' speeds left and right and the distance between the wheels (`track_m`) the robot goes at
V_transl = (right + left) / 2 and turns at (right - left) / track, which a rim feels as V_rot = |yaw rate| track / 2.
The faster rim goes at V_max = V_transl + V_rot: that is (5).

(6) prints V_transl = V_max / (1 + L / R) with L and R the speeds of the wheels. On the straight that is half of V_max,
where nothing turns and (5) gives V_max. With L half the track and R the radius of the turn V_rot is V_transl L / R, and
(6) follows from (5). That is what stands here, with the curvature 1 / R.
"""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats

TRACK_RADII = 0.287 / 0.3
"""The distance between the wheels in radii of the robot: the Wafflebot's of [tcf-thesis] at its inflated radius."""


def wheel_speeds(speed: npt.ArrayLike, yaw_rate: npt.ArrayLike, track_m: float) -> Floats:
    """Rim speeds (..., 2), left and right, in m/s, from m/s ahead (below 0 backwards) and rad/s."""
    forward, rim = np.broadcast_arrays(np.asarray(speed, float), np.asarray(yaw_rate, float) * track_m / 2)
    return np.stack([forward - rim, forward + rim], axis=-1)


def body_speeds(wheels: npt.ArrayLike, track_m: npt.ArrayLike) -> Floats:
    """The inverse of `wheel_speeds`: (..., 2) of speed in m/s and yaw rate in rad/s; of ways as of speeds."""
    left, right = np.moveaxis(np.asarray(wheels, dtype=np.float64), -1, 0)
    return np.stack([(left + right) / 2, (right - left) / track_m], axis=-1)


def fastest_translation(rim_speed_mps: float, curvature: npt.ArrayLike, track_m: float) -> Floats:
    """V_transl of (6): the most m/s on a turn of `curvature` (1/m) at which no rim is faster than V_max."""
    return rim_speed_mps / (1 + np.abs(np.asarray(curvature, dtype=np.float64)) * track_m / 2)
