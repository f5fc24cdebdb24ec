"""The node uav_camera of [tcf-thesis], section 5.3.2: publishes a robot's images and its camera's intrinsics.

Topics `<robot>/camera/image_raw` (sensor_msgs/Image) and `<robot>/camera/camera_info` (sensor_msgs/CameraInfo). The
frame of the images is `<robot>/camera`: x to the right of the picture, y down, z ahead. Where the mount is known the
frame is in /tf_static, under `<robot>/base_link`.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Iterator

from muster.motion.frames import Floats
from muster.perception.camera import Intrinsics
from muster.perception.cameras import images
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import stamped_transform
from muster_robots.ros1.node import publish
from muster_robots.ros1.pose_listener import PoseListener
from muster_robots.ros1.ros import TFMessage, rospy
from muster_robots.ros1.sensor_conversion import camera_info_of, image_message, stamp_of
from muster_robots.ros1.sensor_messages import CameraInfo, Image

_WAIT_S = 0.01

Taken = tuple[float | None, images.Image]
"""An image and the time at which it was taken, seconds of ROS; None: now."""


class UavCamera:
    """The camera of one robot; this process is a node by then.

    Parameters
    ----------
    topics
        the robot's namespace, such as `/r_0`.
    mount
        (4, 4) from body to image; None: not known.
    """

    def __init__(self, topics: str, intrinsics: Intrinsics, *, rate_hz: float, mount: Floats | None = None) -> None:
        name = topics.strip("/")
        self._frame, self._period_s = f"{name}/camera", 1 / rate_hz
        self._info = camera_info_of(intrinsics)
        self._images = rospy.Publisher(f"{topics}/camera/image_raw", Image, queue_size=1)
        self._infos = rospy.Publisher(f"{topics}/camera/camera_info", CameraInfo, queue_size=1)
        self._static = rospy.Publisher("/tf_static", TFMessage, queue_size=10, latch=True)
        if mount is not None:
            publish(self._static, TFMessage([stamped_transform(f"{name}/base_link", self._frame, mount)]))

    def run(self, taken: Iterator[Taken | None]) -> None:
        """Publish what is taken, at the camera's rate, until the node is shut down or no image is left."""
        due_s = time.monotonic()
        while not rospy.is_shutdown():
            if time.monotonic() < due_s:
                time.sleep(_WAIT_S)
                continue
            due_s = max(due_s + self._period_s, time.monotonic())
            try:
                one = next(taken)
            except StopIteration:
                return
            if one is not None:
                self._publish(*one)

    def _publish(self, stamp_s: float | None, image: images.Image) -> None:
        stamp = rospy.Time.now() if stamp_s is None else rospy.Time.from_sec(stamp_s)
        message = image_message(image, self._frame, stamp)
        self._info.header = message.header
        publish(self._infos, self._info)
        publish(self._images, message)


def seen_from_poses(topics: str, frame: MapFrame, picture: Callable[[Floats], images.Image]) -> Iterator[Taken | None]:
    """Images from where a robot says that it is, each with the stamp of its pose; None while no new pose is heard.

    Parameters
    ----------
    picture
        draws what is seen from a body's pose (4, 4) in the map.
    """
    lock, heard = threading.Lock(), list[tuple[float, Floats]]()

    def hear(message: object, pose: Floats, _: object) -> None:
        with lock:
            heard[:] = [(stamp_of(message), pose)]

    listener = PoseListener(topics, frame, hear)
    try:
        while True:
            with lock:
                last, heard[:] = heard[-1:], []
            yield (last[0][0], picture(last[0][1])) if last else None
    finally:
        listener.close()
