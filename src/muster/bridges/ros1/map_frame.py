"""Poses in any frame, as poses of the map, by tf."""

from __future__ import annotations

import threading
from typing import Any

from muster.bridges.ros1.message_conversion import matrix_of_transform
from muster.bridges.ros1.node import hear
from muster.bridges.ros1.ros import TFMessage, rospy
from muster.mission.errors import TransformError
from muster.motion.frames import Floats
from muster.motion.transform_tree import TransformTree

OWN = "muster/"
"""Prefix of the frames that Muster publishes itself."""


class MapFrame:
    """Listens to /tf and /tf_static.

    Parameters
    ----------
    name
        of the mission's frame.
    """

    def __init__(self, name: str) -> None:
        self.name = name.strip("/")
        self._tree = TransformTree()
        self._static: dict[str, tuple[str, Floats]] = {}  # by the child's name: they are said once
        self._heard_s = 0.0
        self._lock = threading.Lock()
        self._heard = [
            hear("/tf", TFMessage, self._take, callback_args=False, queue_size=100),
            hear("/tf_static", TFMessage, self._take, callback_args=True, queue_size=100),
        ]

    def to_map(self, frame: str, matrix: Floats) -> Floats | None:
        """A pose of a frame as one of the map; None if nothing ties the frame to the map. No name means the map."""
        frame = frame.strip("/")
        if frame in ("", self.name):
            return matrix
        try:
            with self._lock:
                return self._tree.lookup(self.name, frame) @ matrix
        except TransformError:
            return None

    def close(self) -> None:
        """Listen no more."""
        for link in self._heard:
            link.unregister()

    def _take(self, message: Any, static: bool) -> None:
        """What contradicts what tf said before is left out, as tf2 does."""
        for one in message.transforms:
            parent, child = one.header.frame_id.strip("/"), one.child_frame_id.strip("/")
            if child.startswith(OWN):
                continue
            matrix = matrix_of_transform(one.transform)
            if matrix is None:
                continue
            try:
                with self._lock:
                    self._forget_if_time_went_back()
                    self._tree.set_transform(parent, child, one.header.stamp.to_sec(), matrix, static=static)
                    if static:
                        self._static[child] = (parent, matrix)
            except TransformError as error:
                rospy.logwarn_throttle(10.0, f"tf: {error}")

    def _forget_if_time_went_back(self) -> None:
        """Forget all but static transforms when time goes back, as tf2 does: after a restart of a simulator."""
        now = rospy.get_time()
        if now < self._heard_s:
            self._tree = TransformTree()
            for child, (parent, matrix) in self._static.items():
                self._tree.set_transform(parent, child, 0.0, matrix, static=True)
        self._heard_s = now
