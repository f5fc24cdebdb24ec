"""A trajectory as a table (CSV): place, heading, speeds and, of a differential drive, the speeds of its rims."""

from __future__ import annotations

import csv
import io

import numpy as np
import numpy.typing as npt

from muster.motion.trajectory import Trajectory
from muster.motion.wheels import wheel_speeds

Floats = npt.NDArray[np.float64]


def trajectory_csv(motion: Trajectory, *, track_m: float | None, faces_its_way: bool) -> str:
    """One row a moment: t, x, y, z in space, heading, speed, yaw rate, and left and right rim speed.

    Parameters
    ----------
    track_m
        the distance between the wheels; None: a robot without a left and a right wheel.
    faces_its_way
        whether the speed is that ahead; otherwise it is the speed in any direction.
    """
    names = ["t_s", *(f"{axis}_m" for axis in "xyz"[: motion.positions.shape[1]]), "heading_rad"]
    names += ["speed_mps", "yaw_rate_radps"]
    speeds = _ahead(motion) if faces_its_way else np.linalg.norm(motion.velocities, axis=1)
    columns = [motion.times, *motion.positions.T, motion.headings, speeds, motion.yaw_rates]
    if track_m is not None:
        names += ["left_rim_mps", "right_rim_mps"]
        columns += [*wheel_speeds(speeds, motion.yaw_rates, track_m).T]
    out = io.StringIO()
    writer = csv.writer(out, lineterminator="\n")
    writer.writerow(names)
    writer.writerows([f"{value:.6f}" for value in row] for row in np.column_stack(columns).tolist())
    return out.getvalue()


def _ahead(motion: Trajectory) -> Floats:
    """Speeds over ground ahead, below 0 backward; in space the climb adds to them."""
    ahead = motion.velocities[:, 0] * np.cos(motion.headings) + motion.velocities[:, 1] * np.sin(motion.headings)
    return np.asarray(np.copysign(np.linalg.norm(motion.velocities, axis=1), ahead))
