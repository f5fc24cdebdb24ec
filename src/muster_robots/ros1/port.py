"""The port of a robot on ROS 1: receives poses, sends goals or velocities ([tcf-thesis], section 5.2, Figure 5.6).

A robot only says where it is: whether it has passed a way point the port itself finds out (`follower`).
"""

from __future__ import annotations

import math
import threading
from collections.abc import Callable, Sequence
from dataclasses import replace
from typing import Any

from muster.mission.model import Robot
from muster.motion.frames import Floats
from muster.motion.port import Place, Telemetry, Waypoint
from muster_robots.custody import CustodyLimits, Holder, Wants
from muster_robots.follower import Follower
from muster_robots.navigation import Ended
from muster_robots.pose_custody import PoseCustody
from muster_robots.pose_port import require_finite
from muster_robots.ros1.clock import MissionClock
from muster_robots.ros1.map_frame import MapFrame
from muster_robots.ros1.message_conversion import place_and_heading, tf_of
from muster_robots.ros1.orders import Course, Drive, orders_for
from muster_robots.ros1.pose_listener import PoseListener
from muster_robots.steering import SteeredRobot, Velocity
from muster_robots.tied_frames import OWN


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
    limits
        those of its custody.
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
        limits: CustodyLimits | None = None,
    ) -> None:
        self.body = robot
        self._frame, self._flat, self._lock = frame, flat, lock
        self._clock, self._on_pass, self._on_pose = clock, on_pass, on_pose
        self._follower = Follower(arrival_m=arrival_m, turned_rad=0.1, flat=flat or robot.kind == "ground")
        self._last_word: Telemetry | None = None
        self._height = 0.0
        self._heard_s = -math.inf
        self._commanded = False  # whether it was ever sent anywhere
        self._refused = ""
        self._orders = orders_for(drive, topics, frame.name, lambda: clock.unpaused_s, lock)
        self.custody = PoseCustody(
            robot.id,
            limits or CustodyLimits(),
            self._orders.expected,
            lambda: self._orders.received,
            lets_go=not self._orders.reports,
        )
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
            order = self._follower.take(waypoints)
            self._refused = ""
            self._commanded = self._commanded or bool(waypoints)
            if not self._commanded or not self.custody.want(self._clock.unpaused_s, goes=bool(waypoints)):
                return order
            if waypoints:
                self._orders.begin(self._clock.unpaused_s)
            else:
                self.stand()
        return order

    def cancel(self) -> int:
        """See `RobotPort`."""
        return self.send(())

    @property
    def missing(self) -> str:
        """What is missing of what it takes to drive it, and what is expected; empty if nothing is."""
        if self._last_word is None:
            return self._listener.untied or f"nothing on {self._listener.expected}"
        return self.custody.missing

    def telemetry(self) -> Telemetry | None:
        """See `RobotPort`."""
        return self.custody.judged(self._last_word)

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
        """Tell the robot what it is to do now."""
        said = self._last_word
        assert said is not None  # or nobody would steer it
        now, follower = self._clock.unpaused_s, self._follower
        if foreign := self._orders.foreign:
            self._leave(foreign)
        under_way = follower.aim is not None and not follower.stays
        place = self._goal(said.position if steered.aim is None else steered.aim.position)
        at = (follower.order, follower.passed)
        aim = None if self.custody.is_taken else steered.aim
        course = Course(now, at, aim, place, velocity, said, follower.aim is None, under_way)
        ended = self._orders.speak(course)
        if ended is not None and under_way:
            self._take_end(ended, said)
        is_done = steered.aim is None or follower.stays or bool(self._refused) or not self._orders.at_rest
        self._tell_again(self.custody.look(now, is_carried_out=is_done))
        for pose in self._orders.poses():
            self._listener.hear_fix(pose)

    def frames(self) -> list[Any]:
        """For tf: where the robot is, and its next way point."""
        said, aim = self._last_word, self._follower.aim
        if said is None:
            return []
        height = self._height if self._flat else said.position[2]
        here = tf_of(self._frame.name, f"{OWN}{self.robot}", (*said.position[:2], height), said.heading)
        if aim is None:
            return [here]
        return [here, tf_of(self._frame.name, f"{OWN}{self.robot}/goal", self._goal(aim.position), aim.heading or 0.0)]

    def stand(self) -> None:
        """Stand where it is, at once, if it was ever sent anywhere, and nobody else has it."""
        with self._lock:
            if self._commanded and not self.custody.is_taken:
                said = self._last_word
                here = (0.0, 0.0, 0.0) if said is None else self._goal(said.position)
                self._orders.stand(self._clock.unpaused_s, here, said)

    def close(self) -> None:
        """Hear and say no more."""
        self._listener.close()
        self._orders.close()

    def _tell_again(self, what: Wants | None) -> None:
        """Tell it once more what it does not do, unless it does what somebody else wants."""
        if what is Wants.ORDER:
            self._orders.repeat()
        elif self._orders.reports and self._orders.at_rest and self.custody.moves_by_others:
            self._leave("it moves by no goal of Muster's")
        elif what is Wants.HOLD:
            self.stand()

    def _leave(self, why: str) -> None:
        """Leave it to somebody else, who has it, and note that again for as long as it is so."""
        is_new = not self.custody.is_taken
        self.custody.take(self._clock.unpaused_s, Holder.STATION, why)
        if is_new:
            self._orders.leave()
            self._on_pass()

    def _take_end(self, ended: Ended, said: Telemetry) -> None:
        """Take in that its navigation has arrived, or why it does not get there."""
        if ended.by_others:
            self._leave(ended.reason)
            return
        self._refused = ended.reason
        if ended.reason:
            self._last_word = replace(said, refused=ended.reason)
            self._on_pass()
        else:
            self._follower.arrive(self._clock.time_s)

    def _goal(self, place: Place) -> Place:
        """In the plane the height is the robot's own affair."""
        x, y, z = place
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
            self.custody.hear(heard_s, place, heading, now)
            told = self._follower
            counted = told.odometry_m, told.order, told.passed
            self._last_word = Telemetry(now, place, heading, velocity, *counted, refused=self._refused)
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
