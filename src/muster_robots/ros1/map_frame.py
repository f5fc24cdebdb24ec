"""Poses in any frame, as poses of the map, by tf."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from muster.mission.errors import TransformError
from muster_robots.ros1.message_conversion import matrix_of_transform
from muster_robots.ros1.node import hear
from muster_robots.ros1.ros import TFMessage, rospy
from muster_robots.tied_frames import TiedFrames


class MapFrame(TiedFrames):
    """Listens to /tf and /tf_static.

    Parameters
    ----------
    name
        of the mission's frame.
    """

    def __init__(self, name: str) -> None:
        super().__init__(name)
        self._watched: dict[str, Callable[[], None]] = {}
        self._heard = [
            hear("/tf", TFMessage, self._take, callback_args=False, queue_size=100),
            hear("/tf_static", TFMessage, self._take, callback_args=True, queue_size=100),
        ]

    def watch(self, frame: str, do: Callable[[], None]) -> None:
        """Call a function after each transform of /tf that moves a frame."""
        self._watched[frame.strip("/")] = do

    def close(self) -> None:
        """Listen no more."""
        for link in self._heard:
            link.unregister()

    def _take(self, message: Any, static: bool) -> None:
        """What contradicts what tf said before is left out."""
        for one in message.transforms:
            matrix = matrix_of_transform(one.transform)
            if matrix is None:
                continue
            try:
                stamp_s, now_s = one.header.stamp.to_sec(), rospy.get_time()
                self.take(one.header.frame_id, one.child_frame_id, stamp_s, matrix, static=static, now_s=now_s)
            except TransformError as error:
                rospy.logwarn_throttle(10.0, f"tf: {error}")
                continue
            if not static and (do := self._watched.get(one.child_frame_id.strip("/"))) is not None:
                do()
