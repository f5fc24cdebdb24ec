"""Observe a place from a position where the camera sees a given width of it: [tcf-thesis] equations (4.26)-(4.30).

Corrected: (4.29) puts the robot beyond the target, facing away. With the heading phi from robot to target the camera
stands at s - r (cos phi, sin phi), and its mount is rotated by phi with the body. Its height is h, so that the body is
lower by the mount's z; (4.29) adds it. The default heading of (4.30) depends on where the robot comes from, which
nobody knows before it is planned: here it is 0.

The width is that of (4.27): half of it lies between the near edge of the picture and the target. Behind the target the
picture holds more than the other half, unless the camera looks straight down.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster.mission.action_keys import STATIONARY_OBSERVATION, ActionKeys
from muster.mission.model import Camera, Robot, Task
from muster.motion.actions.action import Impossible, TaskMotion, along, given, raised

_FARTHEST = 1e6
"""Widths: from farther away rounding leaves nothing of the angles."""


@dataclass(frozen=True)
class StationaryObservation:
    """Enters, stays and leaves at one place, without cost."""

    name: str = "stationary-observation"
    keys: ActionKeys = STATIONARY_OBSERVATION

    def plan(self, task: Task, robot: Robot) -> TaskMotion | Impossible:
        assert task.action is not None
        if robot.camera is None:
            return Impossible("it has no camera")
        stand = stand_off(robot.camera, *given(task, "width_m"))
        if isinstance(stand, Impossible):
            return stand
        away, height = stand
        if robot.kind == "ground" and len(task.position) == 3:
            return Impossible(f"a ground robot cannot look from {height:g} m above the ground")
        heading = math.radians(task.action.heading_deg or 0.0)
        forward, left, up = (*robot.camera.mount, 0.0)[:3]
        x, y, z = raised(task.position, height - up)
        cos, sin = math.cos(heading), math.sin(heading)
        x -= (away + forward) * cos - left * sin
        y -= (away + forward) * sin + left * cos
        return along(task, robot, [(x, y, z)], [heading])


def stand_off(camera: Camera, width_m: float) -> tuple[float, float] | Impossible:
    """How far from the target on the ground the camera is, and how high above it: r and h, metres."""
    if camera.tilt_deg <= 0:
        return Impossible(f"its camera (tilt_deg {camera.tilt_deg:g}) does not look down")
    alpha, theta = math.radians(90 - camera.tilt_deg), math.radians(camera.fov_deg)
    difference = math.tan(alpha) - math.tan(alpha - theta / 2)
    if difference <= 0 or math.hypot(1.0, math.tan(alpha)) > 2 * difference * _FARTHEST:
        return Impossible(f"its camera (fov_deg {camera.fov_deg:g}) sees too little to see a width of {width_m:g} m")
    height = width_m / (2 * difference)  # (4.28)
    return height * math.tan(alpha), height  # (4.26)
