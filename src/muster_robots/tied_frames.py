"""The one rule of both versions of ROS on frames: a pose counts on the map only if its frame is tied to the map.

A frame is tied if it is the map's, has no name, or if tf leads from the map to it. Poses of other frames are passed
over: where odometry begins nobody knows but who ties it. A robot may have a tf of its own (`<robot>/tf`, as Nav2 gives
to robots in namespaces), whose frames come before those that all share.
"""

from __future__ import annotations

import math
import threading

from muster.mission.errors import TransformError
from muster.mission.model import Robot
from muster.motion.frames import Floats, body_in_global
from muster.motion.transform_tree import TransformTree

OWN = "muster/"
"""Prefix of the frames that Muster publishes itself."""


def start_frame(topics: str) -> str:
    """Return the frame in which a robot's odometry begins, by the namespace of its topics."""
    return f"{topics.strip('/')}/odom"


def start_pose(robot: Robot) -> Floats:
    """Return where a robot starts in its mission (4, 4): the initialisation frame of [tcf-thesis] (4.2)-(4.4)."""
    x, y, z = (*robot.position, 0.0)[:3]
    return body_in_global((x, y, z, 0.0, 0.0, math.radians(robot.heading_deg)), [0.0] * 6)


class TiedFrames:
    """The frames that tf ties to the map; threads may share it.

    Parameters
    ----------
    name : str
        Name of the map's frame.
    shared : TiedFrames, optional
        The frames that all robots share, where these are those of one robot.
    """

    def __init__(self, name: str, shared: TiedFrames | None = None) -> None:
        self.name, self._shared = name.strip("/"), shared
        self._tree = TransformTree()
        self._static: dict[str, tuple[str, Floats]] = {}  # by the child's name: they are said once
        self._heard_s = 0.0
        self._lock = threading.Lock()

    def to_map(self, frame: str, matrix: Floats) -> Floats | None:
        """Return a pose (4, 4) of a frame as one of the map; None if nothing ties the frame to the map."""
        frame = frame.strip("/")
        if frame in ("", self.name):
            return matrix
        there = self.of_body(frame)
        if there is not None:
            return there @ matrix
        return None if self._shared is None else self._shared.to_map(frame, matrix)

    def of_body(self, frame: str) -> Floats | None:
        """Return where a frame of this tf is on the map (4, 4); None if nothing ties it to the map."""
        try:
            with self._lock:
                return self._tree.lookup(self.name, frame.strip("/"))
        except TransformError:
            return None

    def take(self, parent: str, child: str, stamp_s: float, matrix: Floats, *, static: bool, now_s: float) -> None:
        """Add a transform (4, 4) of tf.

        Raises
        ------
        TransformError
            If it contradicts what tf said before; it is left out then, as by tf2.
        """
        parent, child = parent.strip("/"), child.strip("/")
        if child.startswith(OWN):
            return
        with self._lock:
            self._forget_if_time_went_back(now_s)
            self._tree.set_transform(parent, child, stamp_s, matrix, static=static)
            if static:
                self._static[child] = (parent, matrix)

    def fix(self, child: str, matrix: Floats) -> None:
        """Tie a frame to the map for good, as a static transform of tf does."""
        self.take(self.name, child, 0.0, matrix, static=True, now_s=self._heard_s)

    def untied(self, topic: str, frame: str) -> str:
        """Return in words that what a topic says in a frame does not count, and what is expected."""
        started = ", or --odometry start" if topic.endswith("/odom") else ""
        ways = f"tf from {self.name} to {frame}, or a pose in {self.name}{started}"
        return f"{topic} is in frame {frame}, which tf does not tie to {self.name}; expected {ways}"

    def _forget_if_time_went_back(self, now_s: float) -> None:
        """Forget all but static transforms when time goes back, as tf2 does: after a restart of a simulator."""
        if now_s < self._heard_s:
            self._tree = TransformTree()
            for child, (parent, matrix) in self._static.items():
                self._tree.set_transform(parent, child, 0.0, matrix, static=True)
        self._heard_s = now_s
