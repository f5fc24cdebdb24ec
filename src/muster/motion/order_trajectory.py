"""The trajectory of an order: through its way points, to a stand at each where the robot stops.

Between stops the way is smoothed by the turning radius of the robot, or a smaller one where that does not fit, and gets
its velocities from `velocity.timed` ([market-paper], section 3.2.3). The robot keeps a part of its limits in reserve:
by that it catches up.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.limits import Limits
from muster.motion.path import Path
from muster.motion.port import Waypoint
from muster.motion.smoothing import Clear, Smoothed, smoothed
from muster.motion.trajectory import Trajectory, joined
from muster.motion.velocity import timed

RESERVE = 0.05
"""The share of its limits that a robot keeps to catch up."""
STEP_S = 0.02
_RADII = 2  # the radius of full speed and half of it; a robot is faster where it stops and turns than on less
_SAME_M = 1e-7


@dataclass(frozen=True, eq=False)
class OrderTrajectory:
    """Where a robot is to be, every `STEP_S` seconds, and when it passes each way point.

    Parameters
    ----------
    poses
        (k, 4): x, y, z in metres of the map frame, and heading.
    times
        (n,) seconds, one for each way point.
    """

    poses: Floats
    times: Floats


@dataclass(frozen=True)
class TrajectoryMaker:
    """Makes trajectories of a robot's orders.

    Parameters
    ----------
    limits, faces_its_way
        of the robot.
    radius_m
        the turning radius that is tried first.
    clear
        whether straight pieces are free for the robot.
    dimensions
        of the mission, 2 or 3.
    """

    limits: Limits
    faces_its_way: bool
    radius_m: float
    clear: Clear
    dimensions: int

    def trajectory(self, pose: Sequence[float], waypoints: Sequence[Waypoint]) -> OrderTrajectory:
        """The trajectory from a pose (x, y, z, heading) through at least one way point."""
        place, heading = np.array(pose[:3], dtype=np.float64), float(pose[3])
        parts: list[Trajectory] = []
        times: list[float] = []
        begun_s = 0.0
        for section in _sections(waypoints):
            motion, passed = self._section(place, heading, section)
            parts.append(motion)
            times += [begun_s + time for time in passed]
            begun_s += motion.duration_s
            place = np.array(section[-1].position)
            stays = section[-1].heading
            heading = float(motion.headings[-1]) if stays is None else stays
        whole = joined(parts)
        clock = whole.times[0] + STEP_S * np.arange(round(whole.duration_s / STEP_S) + 1)
        return OrderTrajectory(self._poses(whole.at(clock), float(pose[2])), np.array(times))

    def _section(self, place: Floats, heading: float, section: Sequence[Waypoint]) -> tuple[Trajectory, list[float]]:
        """The motion to a stop, and when it passes the way points on the way there."""
        points = np.vstack([place, *(point.position for point in section)])[:, : self.dimensions]
        keep = [k + 1 for k, point in enumerate(section) if point.label]
        radii = [self.radius_m * 0.5**k for k in range(_RADII)]
        found = smoothed(Path(points), self.clear, radii_m=radii, keep=keep)
        motion = timed(found.curve, self._limits, faces_its_way=self.faces_its_way, start_heading=heading)
        motion = _in_whole_steps(motion)
        return motion, _passings(found, motion)

    @property
    def _limits(self) -> Limits:
        share, limits = 1.0 - RESERVE, self.limits
        return replace(
            limits,
            speed_mps=share * limits.speed_mps,
            acceleration_mps2=share * limits.acceleration_mps2,
            yaw_rate_radps=share * limits.yaw_rate_radps,
        )

    def _poses(self, motion: Trajectory, height_m: float) -> Floats:
        heights = motion.positions[:, 2] if self.dimensions == 3 else np.full(len(motion.times), height_m)
        return np.column_stack([motion.positions[:, :2], heights, motion.headings])


def _sections(waypoints: Sequence[Waypoint]) -> Iterator[Sequence[Waypoint]]:
    """The way points up to each at which the robot stops."""
    first = 0
    for k, point in enumerate(waypoints, 1):
        if point.hold_s > 0 or point.heading is not None or k == len(waypoints):
            yield waypoints[first:k]
            first = k


def _in_whole_steps(motion: Trajectory) -> Trajectory:
    """The same motion in a whole number of steps, so that it has a moment at the stop."""
    steps = math.ceil(motion.duration_s / STEP_S - 1e-9)
    return motion.slower(steps * STEP_S / motion.duration_s) if motion.duration_s > 0 else motion


def _passings(found: Smoothed, motion: Trajectory) -> list[float]:
    """When the motion is at the end of the segments before each point but the first, in order."""
    control, at, times = found.curve.control, 0, []
    for before in found.before[1:]:
        place = control[before - 1, 3] if before else control[0, 0]
        near = np.flatnonzero(np.linalg.norm(motion.positions[at:] - place, axis=1) < _SAME_M)
        at += int(near[0]) if len(near) else 0
        times.append(float(motion.times[at]))
    times[-1] = float(motion.times[-1])
    return times
