"""The one rule of both versions of ROS on frames: a pose counts on the map only if its frame is tied to the map.

A frame is tied if it is the map's, has no name, or if tf leads from the map to it. Poses of other frames are passed
over: where odometry begins nobody knows but who ties it.
"""

from __future__ import annotations

import threading

from muster.mission.errors import TransformError
from muster.motion.frames import Floats
from muster.motion.transform_tree import TransformTree

OWN = "muster/"
"""Prefix of the frames that Muster publishes itself."""


class TiedFrames:
    """The frames that tf ties to the map; threads may share it.

    Parameters
    ----------
    name : str
        Name of the map's frame.
    """

    def __init__(self, name: str) -> None:
        self.name = name.strip("/")
        self._tree = TransformTree()
        self._static: dict[str, tuple[str, Floats]] = {}  # by the child's name: they are said once
        self._heard_s = 0.0
        self._lock = threading.Lock()

    def to_map(self, frame: str, matrix: Floats) -> Floats | None:
        """Return a pose (4, 4) of a frame as one of the map; None if nothing ties the frame to the map."""
        frame = frame.strip("/")
        if frame in ("", self.name):
            return matrix
        try:
            with self._lock:
                return self._tree.lookup(self.name, frame) @ matrix
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

    def untied(self, frame: str) -> str:
        """Return in words that poses of a frame do not count."""
        return f"its poses are in frame {frame}, which tf does not tie to {self.name}"

    def _forget_if_time_went_back(self, now_s: float) -> None:
        """Forget all but static transforms when time goes back, as tf2 does: after a restart of a simulator."""
        if now_s < self._heard_s:
            self._tree = TransformTree()
            for child, (parent, matrix) in self._static.items():
                self._tree.set_transform(parent, child, 0.0, matrix, static=True)
        self._heard_s = now_s
