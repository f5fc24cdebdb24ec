"""The node uav_camera of [tcf-thesis], section 5.3.2, on ROS 2: a robot's images and its camera's intrinsics.

Topics `<robot>/camera/image_raw` (sensor_msgs/Image) and `<robot>/camera/camera_info` (sensor_msgs/CameraInfo).
"""

from __future__ import annotations

import time
from collections.abc import Callable, Iterator

from muster.motion.frames import Floats
from muster.perception.camera import Intrinsics
from muster.perception.cameras import images
from muster_robots.ros2.body_poses import BodyPoses
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.sensor_conversion import camera_info_of, image_message
from muster_robots.ros2.sensor_message_types import CameraInfo, Image

Taken = tuple[float | None, images.Image]
"""An image and the time at which it was taken, seconds; None: now."""


class Ros2Camera:
    """The camera of one robot.

    Parameters
    ----------
    topics
        the robot's namespace, such as `/r_0`.
    """

    def __init__(self, middleware: Middleware, topics: str, intrinsics: Intrinsics, *, rate_hz: float) -> None:
        self._middleware, self._intrinsics, self._period_s = middleware, intrinsics, 1 / rate_hz
        self._frame = f"{topics.strip('/')}/camera"
        self._images = middleware.writer(f"{topics}/camera/image_raw", Image)
        self._infos = middleware.writer(f"{topics}/camera/camera_info", CameraInfo)

    def run(self, taken: Iterator[Taken | None]) -> None:
        """Publish what is taken, at the camera's rate, until no image is left."""
        for one in taken:
            if one is not None:
                stamp_s = time.time() if one[0] is None else one[0]
                self._infos.write(camera_info_of(self._intrinsics, self._frame, stamp_s))
                self._images.write(image_message(one[1], self._frame, stamp_s))
            self._middleware.wait(self._period_s)


def seen_from_poses(
    middleware: Middleware, topics: str, picture: Callable[[Floats], images.Image]
) -> Iterator[Taken | None]:
    """Images from where a robot says that it is, each with the stamp of its pose; None while no new pose has come.

    Parameters
    ----------
    picture
        draws what is seen from a body's pose (4, 4) in the map.
    """
    poses = BodyPoses(middleware, topics)
    while True:
        last = poses.take()[-1:]
        yield (last[0][0], picture(last[0][1])) if last else None
