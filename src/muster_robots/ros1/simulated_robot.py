"""A node that behaves like a real robot: `python -m muster_robots.ros1.simulated_robot r_0 --at 0 0`.

It moves exactly by its kinematics, takes `<robot>/cmd_vel` (stands if that stops for half a second) and, where nobody
tells it velocities, `<robot>/WP`; it says `<robot>/odom`, tf `map` -> `<robot>/base_link`, and on the parameter server
(`<robot>/muster`) what it can do. With `--maps` it maps obstacles with a lidar, and tells its map on `<robot>/map`.
Where `/use_sim_time` is set it moves by /clock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import Any

import click

from muster.motion.frames import enu_to_flu
from muster.motion.grid import Floats
from muster_robots.ros1.message_conversion import fill_pose, matrix_of, place_and_heading, tf_of, velocity_of
from muster_robots.ros1.node import become_node, hear, publish, time_of_ros
from muster_robots.ros1.ros import OccupancyGrid, Odometry, PoseStamped, TFMessage, Twist, rospy
from muster_robots.simulated_body import SimulatedBody
from muster_robots.simulated_mapping import SimulatedMapping
from muster_robots.simulated_program import Wanted, robot_options, run, wanted

_TICK_S = 0.005
"""Real time between two looks at the clock."""


class SimulatedRobot:
    """One robot in the world of ROS; this process is a node by then."""

    _mapping: SimulatedMapping | None = None

    def __init__(self, it: Wanted) -> None:
        topics = it.topics(it.robot.id)
        self._frame, self._rate_hz, self._body = (
            f"{topics.strip('/')}/base_link",
            it.rate_hz,
            SimulatedBody(it.robot, it.rate_hz),
        )
        self._now = time_of_ros()
        self._lock = threading.Lock()
        self._poses = rospy.Publisher(f"{topics}/odom", Odometry, queue_size=1)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        if it.maps is not None:
            self._mapping = SimulatedMapping(it.maps, it.robot)
            self._maps = rospy.Publisher(f"{topics}/map", OccupancyGrid, queue_size=1, latch=True)
        self._heard = [
            hear(f"{topics}/cmd_vel", Twist, self._take_velocity, queue_size=1, tcp_nodelay=True),
            hear(f"{topics}/WP", PoseStamped, self._take_goal, queue_size=1),
        ]

    def run(self) -> None:
        """Move and say so, until the node is shut down."""
        last = self._now()
        while not rospy.is_shutdown():
            time.sleep(_TICK_S)
            now = self._now()
            if now - last < 1 / self._rate_hz:
                continue
            with self._lock:
                rates = self._body.step(now, now - last)
            last = now
            self._say(rates)

    def _say(self, rates: Floats) -> None:
        place, heading = self._body.pose
        message = Odometry()
        message.header.frame_id, message.header.stamp = "map", rospy.Time.now()
        message.child_frame_id = self._frame
        fill_pose(message.pose.pose, place, heading)
        twist = message.twist.twist
        twist.linear.x, twist.linear.y, twist.linear.z = map(float, enu_to_flu(rates[:3], heading))
        twist.angular.z = float(rates[3])
        publish(self._poses, message)
        publish(self._tf, TFMessage([tf_of("map", message.child_frame_id, place, heading)]))
        if self._mapping is not None and self._mapping.look(self._now(), place, heading):
            publish(self._maps, _map_message(self._mapping))

    def _take_velocity(self, message: Any) -> None:
        with self._lock:
            self._body.drive(velocity_of(message), self._now())

    def _take_goal(self, message: Any) -> None:
        matrix = matrix_of(message.pose)
        if matrix is not None:
            with self._lock:
                self._body.go_to(*place_and_heading(matrix))


def _map_message(mapping: SimulatedMapping) -> Any:
    (rows, columns), (x, y, yaw) = mapping.frame.shape, mapping.frame.origin
    message = OccupancyGrid()
    message.header.frame_id, message.header.stamp = "map", rospy.Time.now()
    message.info.resolution, message.info.width, message.info.height = mapping.frame.resolution_m, columns, rows
    fill_pose(message.info.origin, (x, y, 0.0), yaw)
    message.data = mapping.per_cent().tolist()
    return message


@click.command()
@click.option("--master", metavar="URI", help="The ROS master.  [default: ROS_MASTER_URI]")
@robot_options
def command(master: str | None, **asked: Any) -> None:
    """Let a simulated ROBOT take part on ROS 1, until Ctrl-C."""
    it = wanted(**asked)
    topics = it.topics(it.robot.id)
    become_node(f"muster_simulated{topics.replace('/', '_')}", master)
    rospy.set_param(f"{topics}/muster", it.says)
    SimulatedRobot(it).run()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the node; an expected failure is a line and exit code 2."""
    run(command, "muster_robots.ros1.simulated_robot", arguments)


if __name__ == "__main__":
    main()
