"""The node `/target_localization` of [tcf-thesis], section 5.3.2, for all robots of a team.

It hears images, intrinsics, laser scans and poses of robots. Tags that it sees become points of interest, and by the
mission's rules `found` tasks, which it gives to the controller. It publishes JSON in std_msgs/String:
`/target_localization/points`, latched: all points found; `<robot>/tags`: what each image shows; `<robot>/obstacles`:
what each scan shows. All positions are in the map.
"""

from __future__ import annotations

import json
import threading
from collections.abc import Callable
from functools import partial
from typing import Any

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.model import Event, Mission
from muster.mission.yaml_writer import plain
from muster.motion.frames import Floats
from muster.perception.detection import TagDetector
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import text_of
from muster_robots.ros1.mission_transfer import unpacked
from muster_robots.ros1.node import hear, publish
from muster_robots.ros1.pose_listener import PoseListener
from muster_robots.ros1.requests import COMMANDS, RequestClient
from muster_robots.ros1.ros import String, rospy
from muster_robots.ros1.sensor_conversion import image_from, intrinsics_from, scan_from, stamp_of
from muster_robots.ros1.sensor_messages import CameraInfo, Image, LaserScan
from muster_robots.target_search import SearchSettings, TargetSearch

_ANSWERS_WITHIN_S = 5.0
_AGAIN_S = 10.0
"""Seconds after which a remark is repeated."""
_IMAGE_BYTES = 2**23


class TargetLocalization:
    """Searches from when it is made; this process is a node by then.

    Parameters
    ----------
    topics
        the namespace of a robot's topics.
    frame
        of the mission, in tf's words.
    poses
        topic of a robot's pose, where others publish it; None: `<robot>/pose`.

    Raises
    ------
    MissingExtraError
        if the extra `physics`, of which the detector is, is not installed.
    """

    def __init__(
        self,
        *,
        topics: Callable[[str], str],
        frame: str,
        settings: SearchSettings,
        poses: Callable[[str], str | None] = lambda robot: None,
    ) -> None:
        self._topics, self._settings, self._poses = topics, settings, poses
        self._frame, self._detector = MapFrame(frame), TagDetector()
        self._one_at_a_time = threading.Lock()  # images: a detector is not for two threads
        self._search: TargetSearch | None = None
        self._state = ""
        self._links: list[Any] = []
        self._publishers: dict[str, Any] = {}
        self._controller = RequestClient(COMMANDS)
        self._points = rospy.Publisher("/target_localization/points", String, queue_size=10, latch=True)
        self._subscribers = [
            hear("/muster/mission", String, self._hear_mission, queue_size=10),
            hear("/muster/status", String, self._hear_status, queue_size=10),
        ]

    def _hear_status(self, message: Any) -> None:
        self._state = json.loads(message.data)["state"]

    def _hear_mission(self, message: Any) -> None:
        """A new mission: nothing is found yet."""
        mission = unpacked(json.loads(message.data))
        with self._one_at_a_time:
            for link in self._links:
                (link.close if isinstance(link, PoseListener) else link.unregister)()
            self._search = search = TargetSearch(mission, self._detector, self._settings)
            self._links = [link for robot in mission.robots for link in self._linked(robot.id, search, mission)]
        publish(self._points, text_of([]))

    def _linked(self, robot: str, search: TargetSearch, mission: Mission) -> list[Any]:
        own = self._topics(robot)
        poses = PoseListener(
            own,
            self._frame,
            lambda said, pose, _: search.hear_pose(robot, stamp_of(said), pose),
            pose_topic=self._poses(robot),
        )
        scans = hear(f"{own}/scan", LaserScan, partial(self._hear_scan, robot, search), queue_size=1)
        if robot not in search.cameras:
            return [poses, scans]
        infos = hear(f"{own}/camera/camera_info", CameraInfo, partial(self._hear_info, robot, search), queue_size=1)
        pictures = hear(
            f"{own}/camera/image_raw",
            Image,
            partial(self._hear_image, robot, search),
            queue_size=1,
            buff_size=_IMAGE_BYTES,
        )
        return [poses, scans, infos, pictures]

    def _hear_info(self, robot: str, search: TargetSearch, message: Any) -> None:
        try:
            search.hear_intrinsics(robot, intrinsics_from(message))
        except ParameterError as error:
            rospy.logwarn_throttle(_AGAIN_S, f"{robot}: camera_info: {error}")

    def _hear_image(self, robot: str, search: TargetSearch, message: Any) -> None:
        if self._state != "carrying-out":
            return
        with self._one_at_a_time:
            if search is not self._search:
                return
            try:
                result = search.hear_image(robot, stamp_of(message), image_from(message))
            except ParameterError as error:
                rospy.logwarn_throttle(_AGAIN_S, f"{robot}: image: {error}")
                return
            for remark in result.remarks:
                rospy.logwarn_throttle(_AGAIN_S, remark)
            for _, event in result.finds:
                self._report(search, event)
            if result.finds:
                publish(self._points, text_of(search.points))
        if len(result.estimates):
            self._say(f"{self._topics(robot)}/tags", result.rows)

    def _hear_scan(self, robot: str, search: TargetSearch, message: Any) -> None:
        scanner = self._scanner(robot, search, message)
        if scanner is None:
            return
        try:
            seen = search.hear_scan(robot, scanner, *scan_from(message))
        except ParameterError as error:
            rospy.logwarn_throttle(_AGAIN_S, f"{robot}: scan: {error}")
            return
        self._say(f"{self._topics(robot)}/obstacles", {"stamp_s": stamp_of(message), **seen})

    def _scanner(self, robot: str, search: TargetSearch, message: Any) -> Floats | None:
        """The scanner's pose in the map by tf; where tf does not tie it to the map, that of the robot's body."""
        tied = self._frame.to_map(message.header.frame_id, np.eye(4)) if message.header.frame_id.strip("/") else None
        return search.pose_at(robot, stamp_of(message)) if tied is None else tied

    def _report(self, search: TargetSearch, event: Event | None) -> None:
        """A task that was found, or one that is elsewhere, for the controller."""
        if event is None:
            return
        if event.new_task is not None:
            task, asked = event.new_task.id, {"verb": "add_task", "task": json.dumps(plain(event.new_task))}
        else:
            assert event.move_task is not None
            task, asked = event.move_task.task, {"verb": "move_task", "move": plain(event.move_task)}
        answer = self._controller.ask(asked, wait_s=_ANSWERS_WITHIN_S, halted=rospy.is_shutdown)
        if answer is None or not answer["success"]:
            rospy.logwarn(f"task {task}: {'no answer of /muster' if answer is None else answer['message']}")
            if event.new_task is not None:
                search.refused(task)

    def _say(self, topic: str, data: Any) -> None:
        if topic not in self._publishers:
            self._publishers[topic] = rospy.Publisher(topic, String, queue_size=10)
        publish(self._publishers[topic], text_of(data))
