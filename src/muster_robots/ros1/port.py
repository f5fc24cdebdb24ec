"""The port of a robot on ROS 1: receives poses, sends goals or velocities ([tcf-thesis], section 5.2, Figure 5.6).

A robot only says where it is: whether it has passed a way point the port itself finds out (`follower`).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from typing import Any, Literal

from muster.mission.model import Robot
from muster.motion.frames import Floats
from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.follower import Follower
from muster_robots.pose_port import goal_heading, require_finite
from muster_robots.ros1.clock import MissionClock
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import place_and_heading, pose_stamped, tf_of, twist_of
from muster_robots.ros1.node import publish
from muster_robots.ros1.pose_listener import PoseListener
from muster_robots.ros1.ros import PoseStamped, Twist, rospy
from muster_robots.steering import STILL, SteeredRobot, Velocity
from muster_robots.tied_frames import OWN

Drive = Literal["cmd_vel", "goals"]
_TOLD_STILL_S = 1.0
"""Seconds for which a robot without way points gets zero velocities; after that a person may drive it."""
_AGAIN_S = 1.0
"""After which a goal is given again, for those that did not hear it."""


class Ros1Port:
    """One robot: a `RobotPort`. Before its first way points it gets no commands: somebody else may drive it.

    Parameters
    ----------
    robot
        who it is, with its limits.
    topics
        its namespace, such as `/r_0`.
    flat
        whether the mission is in the plane: heights are then what the robot says.
    lock
        held wherever what the port knows is read or changed: ROS calls from threads of its own.
    clock
        the mission's; how long ago something was is told by it too, in pauses as well.
    pose_topic
        see `PoseListener`.
    on_pass
        called when a way point is passed.
    on_pose
        called with the robot and each message that gave a pose.
    """

    def __init__(
        self,
        robot: Robot,
        topics: str,
        *,
        drive: Drive,
        frame: MapFrame,
        flat: bool,
        arrival_m: float,
        lock: threading.RLock,
        clock: MissionClock,
        pose_topic: str | None = None,
        on_pass: Callable[[], None],
        on_pose: Callable[[str, Any], None] | None = None,
    ) -> None:
        self.body = robot
        self._drive, self._frame, self._flat, self._lock = drive, frame, flat, lock
        self._clock, self._on_pass, self._on_pose = clock, on_pass, on_pose
        self._follower = Follower(arrival_m=arrival_m, turned_rad=0.1, flat=flat or robot.kind == "ground")
        self._last_word: Telemetry | None = None
        self._height = 0.0
        self._heard_s, self._stood_s, self._given_s = -math.inf, -math.inf, -math.inf
        self._commanded = False  # whether it was ever sent anywhere
        self._given: tuple[int, int] | None = None
        self._facing = 0.0  # of the goal that was given, where its way point asks for no heading
        self._goals = rospy.Publisher(f"{topics}/WP", PoseStamped, queue_size=1, latch=True)
        self._velocities = rospy.Publisher(f"{topics}/cmd_vel", Twist, queue_size=1)
        self._listener = PoseListener(topics, frame, self._hear, pose_topic=pose_topic)

    @property
    def robot(self) -> str:
        return self.body.id

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        """See `RobotPort`.

        Raises
        ------
        ParameterError
            if a number of a way point is not finite.
        """
        require_finite(self.robot, waypoints)
        with self._lock:
            self._stood_s = self._clock.unpaused_s if waypoints else self._stood_s
            order = self._follower.take(waypoints)
            self._commanded = self._commanded or bool(waypoints)
            if not waypoints:
                self.stand()
        return order

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    @property
    def untied(self) -> str:
        """A frame in which it gives poses that nothing ties to the map."""
        return self._listener.untied

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self._last_word

    def steered(self, *, within_s: float, paused: bool) -> SteeredRobot | None:
        """How it is to be steered; None if nothing is known of it. A robot that is silent for a while stands."""
        said = self._last_word
        if said is None:
            return None
        stands = paused or self._clock.unpaused_s - self._heard_s > within_s
        aim = None if stands else self._follower.aim
        arrived = aim is not None and self._follower.is_at(said.position, aim)
        waits = self._follower.waits and not stands
        return SteeredRobot(self.body, said.position, said.heading, said.velocity, aim, arrived, waits)

    def speak(self, steered: SteeredRobot, velocity: Velocity) -> None:
        """Tell the robot what it is to do now, and others where it goes."""
        now = self._clock.unpaused_s
        if steered.aim is not None:
            self._stood_s = now
        if self._drive == "cmd_vel":
            if now - self._stood_s <= _TOLD_STILL_S:
                publish(self._velocities, twist_of(velocity))
        elif steered.aim is None:
            if self._given is not None and (self._follower.aim is not None or self._given == self._next):
                self._stand_still()  # paused, or not heard; or it has made room, and is back
        elif self._given != self._next or now - self._given_s > _AGAIN_S:
            self._give(steered.aim, now)

    def frames(self) -> list[Any]:
        """For tf: where the robot is, and its next way point."""
        said, aim = self._last_word, self._follower.aim
        if said is None:
            return []
        height = self._height if self._flat else said.position[2]
        here = tf_of(self._frame.name, f"{OWN}{self.robot}", (*said.position[:2], height), said.heading)
        if aim is None:
            return [here]
        return [here, tf_of(self._frame.name, f"{OWN}{self.robot}/goal", self._goal(aim), aim.heading or 0.0)]

    def stand(self) -> None:
        """Stand where it is, at once, if it was ever sent anywhere."""
        with self._lock:
            if self._commanded:
                self._stood_s = self._clock.unpaused_s
                self._stand_still()

    def close(self) -> None:
        """Hear and say no more."""
        self._listener.close()
        for link in (self._goals, self._velocities):
            link.unregister()

    def _give(self, aim: Waypoint, now: float) -> None:
        if self._given != self._next:
            self._facing = goal_heading(aim, self._last_word)
        heading = self._facing if aim.heading is None else aim.heading
        publish(self._goals, pose_stamped(self._frame.name, self._goal(aim), heading))
        self._given, self._given_s = self._next, now

    @property
    def _next(self) -> tuple[int, int]:
        """The way point that is next, by its order and its number there."""
        return self._follower.order, self._follower.passed

    def _stand_still(self) -> None:
        """A zero velocity, or where it is as its goal."""
        self._given = None
        if self._drive == "cmd_vel":
            publish(self._velocities, twist_of(STILL))
        elif self._last_word is not None:
            here = Waypoint(self._last_word.position)
            publish(self._goals, pose_stamped(self._frame.name, self._goal(here), self._last_word.heading))

    def _goal(self, aim: Waypoint) -> Place:
        """In the plane the height is the robot's own affair."""
        x, y, z = aim.position
        return (x, y, self._height if self._flat else z)

    def _hear(self, message: Any, matrix: Floats, ahead: Place | None) -> None:
        """A pose, and the body's velocity if that is known; by way of the pose before, if not."""
        place, heading = place_and_heading(matrix)
        with self._lock:
            self._height = place[2]
            place = (*place[:2], 0.0) if self._flat else place
            heard_s = self._clock.unpaused_s
            velocity = self._gone(place, heard_s) if ahead is None else _turned(ahead, matrix)
            self._heard_s = heard_s
            now = self._clock.time_s
            passed = self._follower.hear(now, place, heading)
            told = self._follower
            self._last_word = Telemetry(now, place, heading, velocity, told.odometry_m, told.order, told.passed)
        if passed:
            self._on_pass()
        if self._on_pose is not None:
            self._on_pose(self.robot, message)

    def _gone(self, place: Place, heard_s: float) -> Place:
        took = heard_s - self._heard_s
        if self._last_word is None or not 0 < took < 1:
            return (0.0, 0.0, 0.0)
        x, y, z = ((b - a) / took for a, b in zip(self._last_word.position, place, strict=True))
        return (x, y, z)


def _turned(ahead: Place, pose: Floats) -> Place:
    """A body's velocity as one of the map."""
    x, y, z = map(float, pose[:3, :3] @ ahead)
    return (x, y, z)
