"""The smoothed path of `muster path`: its turning radius, its trajectory, and where no radius fits."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path as File
from typing import TYPE_CHECKING, Any

from muster.mission.errors import ParameterError
from muster.mission.model import Robot
from muster.motion.path import Path

if TYPE_CHECKING:
    from muster.motion.curves.curve import Curve
    from muster.motion.limits import Limits
    from muster.motion.map_world import Body, World

_STEP_M = 0.1
_STEP_S = 0.05


@dataclass(frozen=True)
class SmoothPath:
    """A path as a curve, the radius by which its corners are rounded, and the corners that stay."""

    curve: Curve
    radius_m: float
    corners: tuple[tuple[float, ...], ...]

    @property
    def path(self) -> Path:
        """The curve in pieces of at most 0.1 m."""
        return Path(self.curve.sample(_STEP_M))

    def answer(self) -> dict[str, Any]:
        """What programs are told of it."""
        return {
            "max_curvature_per_m": self.curve.max_curvature,
            "turning_radius_m": self.radius_m,
            "corners": [list(corner) for corner in self.corners],
        }


def bends_of(answer: Mapping[str, Any]) -> str:
    """How a smooth path bends, for people."""
    radius = f"turning radius {answer['turning_radius_m']:.3g} m"
    return f"smooth, greatest curvature {answer['max_curvature_per_m']:.3f} per metre, {radius}"


def corners_of(answer: Mapping[str, Any]) -> str:
    """Where no radius fitted, for people."""
    places = ", ".join("(" + ", ".join(f"{value:.3f}" for value in corner) + ")" for corner in answer["corners"])
    return f"the map has no room for that radius at {len(answer['corners'])} of its corners, which stay: {places}"


def smooth_path(world: World | None, body: Body, path: Path, robot: Robot | None, radius: float | None) -> SmoothPath:
    """Round the corners of a path by a turning radius; None: that of the robot at full speed, or 0.1 m."""
    from muster.motion.kinematics.registry import FREE_RADIUS_M, turning_radius_of
    from muster.motion.paths.robot_paths import RobotPaths
    from muster.motion.smoothing import smoothed

    if radius is None:
        radius = FREE_RADIUS_M if robot is None else turning_radius_of(robot)
    if world is None:
        found = smoothed(path, lambda _: True, radii_m=(radius,))
    else:
        found = RobotPaths(world).smoothed(body, path, radius)
    return SmoothPath(found.curve, radius, tuple(tuple(corner) for corner in found.corners.tolist()))


def require_turning_radius(radius: float | None) -> None:
    """Refuse a radius that is no radius."""
    if radius is not None and not (math.isfinite(radius) and radius > 0):
        raise ParameterError(f"--turning-radius: {radius:g}; expected a finite number above 0")


def write_trajectory(file: File, curve: Curve | None, path: Path, robot: Robot | None) -> None:
    """Write the trajectory of a robot along a curve, else a path, as fast as its limits allow: a row each 0.05 s."""
    from muster.motion.curves.curve import Curve
    from muster.motion.kinematics.registry import kinematics_named
    from muster.motion.trajectory import trajectory_csv
    from muster.motion.velocity import timed
    from muster.motion.wheels import TRACK_RADII

    faces = robot is None or kinematics_named(robot.kinematics).faces_its_way
    track_m = TRACK_RADII * (robot.radius_m if robot is not None and robot.radius_m > 0 else 0.3) if faces else None
    heading = None if robot is None or faces else math.radians(robot.heading_deg)
    motion = timed(
        Curve.along(path) if curve is None else curve, _limits(robot), faces_its_way=faces, start_heading=heading
    )
    text = trajectory_csv(motion.sample(_STEP_S), track_m=track_m, faces_its_way=faces)
    file.write_text(text, encoding="utf-8", newline="")


def _limits(robot: Robot | None) -> Limits:
    from muster.motion.kinematics.registry import USUAL_YAW_RATE_RADPS, limits_of
    from muster.motion.limits import Limits

    return Limits(yaw_rate_radps=USUAL_YAW_RATE_RADPS) if robot is None else limits_of(robot)
