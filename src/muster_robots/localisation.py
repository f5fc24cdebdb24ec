"""Where one robot is on the map, by all that says so: poses, fixes of a localisation, odometry and tf (REP-105).

The sources in the order in which they count, on ROS 1 and ROS 2 alike:

1. Poses on the map, such as those of motion capture. Where they stop, odometry continues from the last one.
2. Odometry whose frame tf ties to the map, as amcl does.
3. Odometry from the last fix (`amcl_pose`), whose rate is too low to drive by.
4. The fixes themselves, and the robot's frame in tf, where no odometry is published.

A source in a frame that nothing ties to the map counts for nothing; `untied` names it.
"""

from __future__ import annotations

import logging
import math

from muster.motion.frames import Floats, inverse
from muster_robots.tied_frames import TiedFrames

POSES_LAST_S = 1.0
"""Seconds for which a pose on the map comes before odometry, and odometry before what is left."""
BODY_FRAMES = ("base_link", "base_footprint")
"""Names of the frame of a robot's body in tf (REP-105, REP-120), behind the robot's namespace."""
_log = logging.getLogger(__name__)


class Localisation:
    """Decides which messages of one robot say where it is on the map. Matrices are (4, 4), in metres.

    Parameters
    ----------
    frames : TiedFrames
        Which frames are tied to the map.
    poses_last_s : float, optional
        Seconds after the last pose from which odometry counts; infinite where poses alone are to count from the first.
    """

    def __init__(self, frames: TiedFrames, *, poses_last_s: float = POSES_LAST_S) -> None:
        self.frames, self._poses_last_s = frames, poses_last_s
        self.untied = ""  # what is wrong with the frame of the last message, and what is expected
        self._odometry: Floats | None = None  # the last one, in its own frame
        self._pose: Floats | None = None  # the last pose, or the last fix where there was no pose yet, on the map
        self._odometry_to_map: Floats | None = None
        self._posed_s = self._reckoned_s = -math.inf
        self._unnamed: set[str] = set()  # topics of poses that name no frame

    def pose(self, now_s: float, topic: str, frame: str, matrix: Floats) -> Floats | None:
        """Return a pose of a pose topic as one on the map; None if nothing ties its frame to the map."""
        there = self._on_map(topic, frame, matrix)
        if there is not None:
            self._posed_s = now_s
            self._tie(there)
        return there

    def fix(self, now_s: float, topic: str, frame: str, matrix: Floats) -> Floats | None:
        """Return a pose of a localisation as one on the map; None while odometry or poses are better than it."""
        there = self._on_map(topic, frame, matrix)
        if there is None or self._has_poses(now_s):
            return None
        self._tie(there)
        return None if now_s - self._reckoned_s < POSES_LAST_S else there

    def odometry(self, now_s: float, topic: str, frame: str, matrix: Floats) -> Floats | None:
        """Return a pose of odometry as one on the map; None if poses come before it, or nothing ties it to the map."""
        if self._odometry is None and self._pose is not None:
            self._odometry_to_map = self._pose @ inverse(matrix)
        self._odometry = matrix
        if self._has_poses(now_s):
            return None
        there = None if self._posed_s > -math.inf else self._on_map(topic, frame, matrix)
        if there is None and self._odometry_to_map is not None:
            there, self.untied = self._odometry_to_map @ matrix, ""
        if there is not None:
            self._reckoned_s = now_s
        return there

    def body(self, now_s: float, frames: TiedFrames, frame: str) -> Floats | None:
        """Return the pose of the robot's frame in a tf; None while anything else says where it is, or tf does not."""
        if self._has_poses(now_s) or now_s - self._reckoned_s < POSES_LAST_S:
            return None
        return frames.of_body(frame)

    def _has_poses(self, now_s: float) -> bool:
        return now_s - self._posed_s < self._poses_last_s

    def _tie(self, there: Floats) -> None:
        """Tie odometry to the map: the last one is at this pose."""
        self._pose = there
        if self._odometry is not None:
            self._odometry_to_map = there @ inverse(self._odometry)

    def _on_map(self, topic: str, frame: str, matrix: Floats) -> Floats | None:
        there = self.frames.to_map(frame, matrix)
        self.untied = self.frames.untied(topic, frame) if there is None else ""
        if not frame.strip("/") and topic not in self._unnamed:
            self._unnamed.add(topic)
            _log.warning("%s names no frame; it is taken as one of %s", topic, self.frames.name)
        return there
