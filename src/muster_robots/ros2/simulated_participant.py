"""A participant that behaves like a real robot: `python -m muster_robots.ros2.simulated_participant r_0 --at 0 0`.

It moves exactly by its kinematics to `<robot>/goal_pose`, or as `<robot>/cmd_vel` says (until that stops for half a
second); it says `<robot>/odom`, and once a second on `<robot>/muster` what it can do. With `--maps` it maps obstacles
with a lidar, and tells its map on `<robot>/map`.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from typing import Any

import click

from muster.motion.frames import enu_to_flu
from muster.motion.grid import Floats
from muster_robots.ros2.map_frame import MAP_FRAME
from muster_robots.ros2.map_message_types import MapMetaData, OccupancyGrid
from muster_robots.ros2.message_types import (
    Header,
    Odometry,
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    String,
    Time,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from muster_robots.ros2.middleware import Middleware
from muster_robots.ros2.names import ros_name
from muster_robots.ros2.open_middleware import open_middleware
from muster_robots.ros2.port import yaw_of
from muster_robots.simulated_body import SimulatedBody
from muster_robots.simulated_mapping import SimulatedMapping
from muster_robots.simulated_program import Wanted, robot_options, run, wanted

_SAYS_S = 1.0


class SimulatedRobot:
    """One robot on a middleware."""

    _mapping: SimulatedMapping | None = None

    def __init__(self, it: Wanted, middleware: Middleware) -> None:
        topics = it.topics(ros_name(it.robot.id))
        self._frame, self._middleware = f"{topics.strip('/')}/base_link", middleware
        self._rate_hz, self._body = it.rate_hz, SimulatedBody(it.robot, it.rate_hz)
        self._goals = middleware.reader(f"{topics}/goal_pose", PoseStamped)
        self._velocities = middleware.reader(f"{topics}/cmd_vel", Twist)
        self._poses = middleware.writer(f"{topics}/odom", Odometry)
        self._words = middleware.writer(f"{topics}/muster", String)
        if it.maps is not None:
            self._mapping = SimulatedMapping(it.maps, it.robot)
            self._maps = middleware.writer(f"{topics}/map", OccupancyGrid)
        self._says, self._said_s = String(json.dumps(it.says)), -math.inf

    def run(self) -> None:
        """Move and say so, for ever."""
        last = time.monotonic()
        while True:
            self._middleware.wait(1 / self._rate_hz)
            now = time.monotonic()
            self.step(now, now - last)
            last = now

    def step(self, now: float, by_s: float) -> None:
        """Take in what has come, move for so many seconds, and say where it is."""
        self._hear(now)
        self._say(now, self._body.step(now, by_s))

    def _hear(self, now: float) -> None:
        for goal in self._goals.take()[-1:]:
            at = goal.pose.position
            heading = yaw_of(goal.pose.orientation)
            if all(map(math.isfinite, (at.x, at.y, at.z, heading))):
                self._body.go_to((at.x, at.y, at.z), heading)
        for twist in self._velocities.take()[-1:]:
            linear = twist.linear
            self._body.drive((linear.x, linear.y, linear.z, twist.angular.z), now)

    def _say(self, now: float, rates: Floats) -> None:
        place, heading = self._body.pose
        turn = Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))
        ahead, left, up = map(float, enu_to_flu(rates[:3], heading))
        moves = Twist(Vector3(ahead, left, up), Vector3(0.0, 0.0, float(rates[3])))
        header = Header(stamp=Time.of(time.time()), frame_id=MAP_FRAME)
        pose = PoseWithCovariance(Pose(Point(*place), turn))
        self._poses.write(Odometry(header, self._frame, pose, TwistWithCovariance(moves)))
        if self._mapping is not None and self._mapping.look(now, place, heading):
            self._maps.write(_map_message(header, self._mapping))
        if now - self._said_s >= _SAYS_S:
            self._said_s = now
            self._words.write(self._says)


def _map_message(header: Header, mapping: SimulatedMapping) -> OccupancyGrid:
    (rows, columns), (x, y, yaw) = mapping.frame.shape, mapping.frame.origin
    corner = Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(yaw / 2), math.cos(yaw / 2)))
    info = MapMetaData(header.stamp, mapping.frame.resolution_m, columns, rows, corner)
    return OccupancyGrid(header, info, mapping.per_cent().tobytes())


@click.command()
@click.option("--domain", type=int, metavar="N", help="Of ROS 2.  [default: ROS_DOMAIN_ID, or 0]")
@click.option("--by", type=click.Choice(["dds", "rclpy"]), help="[default: rclpy where it can be imported, or dds]")
@robot_options
def command(domain: int | None, by: Any, **asked: Any) -> None:
    """Let a simulated ROBOT take part on ROS 2, until Ctrl-C."""
    SimulatedRobot(wanted(**asked), open_middleware(by, domain)).run()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run it; an expected failure is a line and exit code 2."""
    run(command, "muster_robots.ros2.simulated_participant", arguments)


if __name__ == "__main__":
    main()
