"""Robots of ROS 2 as a fleet: each is given goals, one after the other, and has arrived when its pose says so.

| topic | type | |
|---|---|---|
| `/<robot>/goal_pose` | PoseStamped, frame `map` | published: where it is to go next |
| `/<robot>/pose` | PoseStamped, frame `map` | heard: where it is |
| `/<robot>/odom` | Odometry | heard: how fast it is; where it is, if it has no `pose`, its frame taken as `map` |
"""

from __future__ import annotations

import math
import time
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from muster.bridges.ros2.dds import Participant
from muster.bridges.ros2.messages import Header, Odometry, Point, Pose, PoseStamped, Quaternion, Time
from muster.bridges.ros2.names import ros_names
from muster.mission.clock import Clock, SystemClock
from muster.mission.model import Event, Mission
from muster.motion.frames import angles, flu_to_enu, quaternion_rotation, wrapped
from muster.motion.port import Place, RobotPort, Telemetry, Waypoint

_POLL_S = 0.02
MAP_FRAME = "map"


@dataclass(frozen=True, kw_only=True)
class Arrival:
    """When a robot is where it was sent: so near, metres, and where a heading was wanted, so well turned, radians."""

    near_m: float = 0.25
    turned_rad: float = 0.35


class Ros2Fleet:
    """The robots of a mission in a domain of DDS; see `bridges.fleet.Fleet`.

    Parameters
    ----------
    domain
        None: that of the environment's ROS_DOMAIN_ID.
    arrival
        when a way point is reached.

    Raises
    ------
    MissingExtraError, NetworkError, ParameterError
        as of `Participant`; if two robots have the same name in ROS.
    """

    def __init__(
        self, mission: Mission, *, domain: int | None = None, arrival: Arrival | None = None, clock: Clock | None = None
    ) -> None:
        names = ros_names(robot.id for robot in mission.robots)
        self._clock: Clock = clock or SystemClock()
        self._begin = self._clock.now()
        self._participant = Participant(domain)
        near, planar = arrival or Arrival(), mission.dimensions == 2
        self._ports = {
            robot: Ros2Port(self._participant, robot, name, near, planar=planar) for robot, name in names.items()
        }

    @property
    def ports(self) -> Mapping[str, RobotPort]:
        return self._ports

    @property
    def time_s(self) -> float:
        return self._clock.now() - self._begin

    def advance(self, until_s: float) -> Sequence[Event]:
        """Hear and speak until a time, or until a robot passes a way point."""
        while True:
            passed = [port.hear(self.time_s) for port in self._ports.values()]
            rest = until_s - self.time_s
            if rest <= 0 or any(passed):
                return ()
            time.sleep(min(rest, _POLL_S))

    def stop(self) -> None:
        for port in self._ports.values():
            port.cancel()

    def close(self) -> None:
        self._participant.close()


class Ros2Port:
    """One robot."""

    def __init__(self, participant: Participant, robot: str, name: str, arrival: Arrival, *, planar: bool) -> None:
        self.robot = robot
        self._arrival, self._planar = arrival, planar
        self._goals = participant.writer(f"/{name}/goal_pose", PoseStamped)
        self._poses = participant.reader(f"/{name}/pose", PoseStamped)
        self._odometry = participant.reader(f"/{name}/odom", Odometry)
        self._said: Telemetry | None = None
        self._has_pose = False
        self._waiting: list[Waypoint] = []
        self._order = self._passed = self._listeners = 0
        self._leaves_s: float | None = None

    def send(self, waypoints: Sequence[Waypoint]) -> int:
        self._order, self._passed, self._leaves_s = self._order + 1, 0, None
        self._waiting = list(waypoints)
        self._speak()
        return self._order

    def cancel(self) -> int:
        """Its goal becomes where it is. One whose pose is not known keeps the goal that it has."""
        order = self.send(())
        if self._said is not None:
            self._publish(self._said.position, self._said.heading)
        return order

    def telemetry(self) -> Telemetry | None:
        if self._said is None:
            return None
        return _with(self._said, self._order, self._passed)

    def hear(self, now: float) -> bool:
        """Take in what has come, and give the next goal where one is reached; returns whether one was passed."""
        for odometry in self._odometry.take():
            self._take_odometry(odometry, now)
        for pose in self._poses.take():
            if pose.header.frame_id.lstrip("/") == MAP_FRAME:
                self._has_pose = True
                self._is_at(pose.pose, now, None)
        passed = self._pass(now)
        if passed or self._goals.listeners > self._listeners:  # who begins to listen late is told, too
            self._speak()
        self._listeners = self._goals.listeners
        return passed

    def _take_odometry(self, odometry: Odometry, now: float) -> None:
        linear = odometry.twist.twist.linear
        yaw = _yaw(odometry.pose.pose.orientation)
        if not self._has_pose:
            x, y, z = flu_to_enu([linear.x, linear.y, linear.z], yaw).tolist()
            self._is_at(odometry.pose.pose, now, (x, y, z))

    def _is_at(self, pose: Pose, now: float, velocity: Place | None) -> None:
        at, before = pose.position, self._said
        place = (at.x, at.y, 0.0 if self._planar else at.z)
        if not all(map(math.isfinite, place)):
            return
        travelled, speed = 0.0, velocity or (0.0, 0.0, 0.0)
        if before is not None:
            travelled = before.odometry_m + math.dist(before.position, place)
            if velocity is None:
                speed = _velocity(before, place, now)
        self._said = Telemetry(now, place, _yaw(pose.orientation), speed, travelled, self._order, self._passed)

    def _pass(self, now: float) -> bool:
        if not self._waiting or self._said is None:
            return False
        if self._leaves_s is None and self._is_there(self._said, self._waiting[0]):
            self._leaves_s = now + self._waiting[0].hold_s
        if self._leaves_s is None or now < self._leaves_s:
            return False
        del self._waiting[0]
        self._passed, self._leaves_s = self._passed + 1, None
        return True

    def _is_there(self, said: Telemetry, goal: Waypoint) -> bool:
        near = math.dist(said.position, goal.position) <= self._arrival.near_m
        off = 0.0 if goal.heading is None else abs(float(wrapped(said.heading - goal.heading)))
        return near and off <= self._arrival.turned_rad

    def _speak(self) -> None:
        """Publish the way point to which it is to go; its heading, where none is wanted, is that of the way there."""
        if not self._waiting:
            return
        goal = self._waiting[0]
        heading = goal.heading
        if heading is None:
            here = goal.position if self._said is None else self._said.position
            heading = math.atan2(goal.position[1] - here[1], goal.position[0] - here[0])
        self._publish(goal.position, heading)

    def _publish(self, place: Place, heading: float) -> None:
        turn = Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))
        header = Header(stamp=Time.of(time.time()), frame_id=MAP_FRAME)
        self._goals.write(PoseStamped(header, Pose(Point(*map(float, place)), turn)))


def _with(said: Telemetry, order: int, passed: int) -> Telemetry:
    where = (said.time_s, said.position, said.heading, said.velocity, said.odometry_m)
    return Telemetry(*where, order=order, passed=passed)


def _velocity(before: Telemetry, place: Place, now: float) -> Place:
    """By the pose before; that of before, where both came at once."""
    seconds = now - before.time_s
    if seconds < _POLL_S / 2:
        return before.velocity
    x, y, z = ((new - old) / seconds for new, old in zip(place, before.position, strict=True))
    return (x, y, z)


def _yaw(turn: Quaternion) -> float:
    values = np.array([turn.x, turn.y, turn.z, turn.w])
    return float(angles(quaternion_rotation(values))[2]) if np.linalg.norm(values) > 0 else 0.0
