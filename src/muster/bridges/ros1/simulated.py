"""A node that looks like a real robot: `python -m muster.bridges.ros1.simulated r_0 --at 0 0`.

It moves exactly by its kinematics, takes `<robot>/cmd_vel` (stands if that stops for half a second) and, where nobody
tells it velocities, `<robot>/WP`; it says `<robot>/odom`, tf `map` -> `<robot>/base_link`, and on the parameter server
(`<robot>/muster`) what it can do. Where `/use_sim_time` is set it moves by /clock.
"""

from __future__ import annotations

import threading
import time
from collections.abc import Sequence
from typing import Any

import click

from muster.bridges.ros1.messages import fill_pose, matrix_of, place_and_heading, tf_of, velocity_of
from muster.bridges.ros1.node import become_node, time_of_ros
from muster.bridges.ros1.ros import Odometry, PoseStamped, TFMessage, Twist, rospy
from muster.bridges.simulated_body import Body
from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.motion.frames import enu_to_flu
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import KINEMATICS

_TICK_S = 0.005
"""Real time between two looks at the clock."""


class SimulatedRobot:
    """One robot in the world of ROS; this process is a node by then.

    Parameters
    ----------
    robot
        who it is, where it starts, and its limits.
    rate_hz
        of its steps and its poses.
    """

    def __init__(self, robot: Robot, rate_hz: float) -> None:
        self.robot, self._rate_hz, self._body = robot, rate_hz, Body(robot, rate_hz)
        self._now = time_of_ros()
        self._lock = threading.Lock()
        self._poses = rospy.Publisher(f"/{robot.id}/odom", Odometry, queue_size=1)
        self._tf = rospy.Publisher("/tf", TFMessage, queue_size=10)
        self._heard = [
            rospy.Subscriber(f"/{robot.id}/cmd_vel", Twist, self._take_velocity, queue_size=1, tcp_nodelay=True),
            rospy.Subscriber(f"/{robot.id}/WP", PoseStamped, self._take_goal, queue_size=1),
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
        message.child_frame_id = f"{self.robot.id}/base_link"
        fill_pose(message.pose.pose, place, heading)
        twist = message.twist.twist
        twist.linear.x, twist.linear.y, twist.linear.z = map(float, enu_to_flu(rates[:3], heading))
        twist.angular.z = float(rates[3])
        self._poses.publish(message)
        self._tf.publish(TFMessage([tf_of("map", message.child_frame_id, place, heading)]))

    def _take_velocity(self, message: Any) -> None:
        with self._lock:
            self._body.drive(velocity_of(message), self._now())

    def _take_goal(self, message: Any) -> None:
        matrix = matrix_of(message.pose)
        if matrix is not None:
            with self._lock:
                self._body.go_to(*place_and_heading(matrix))


@click.command()
@click.argument("robot")
@click.option("--master", metavar="URI", help="The ROS master.  [default: ROS_MASTER_URI]")
@click.option("--at", type=float, nargs=2, default=(0.0, 0.0), metavar="X Y", help="Where it starts, in metres.")
@click.option("--height", type=float, default=0.0, metavar="Z", help="How high.")
@click.option("--heading", type=float, default=0.0, metavar="DEG", help="From east, anticlockwise.")
@click.option("--kind", type=click.Choice(["ground", "air"]), default="ground", show_default=True)
@click.option("--kinematics", type=click.Choice(list(KINEMATICS)), default="differential-drive", show_default=True)
@click.option("--speed", type=click.FloatRange(min=0, min_open=True), default=1.0, show_default=True, help="m/s.")
@click.option("--yaw-rate", type=click.FloatRange(min=0, min_open=True), default=1.5, show_default=True, help="rad/s.")
@click.option("--radius", type=click.FloatRange(min=0), default=0.2, show_default=True, help="Metres.")
@click.option("--type", "row", metavar="TYPE", help="Its row of a mission's suitability table.")
@click.option("--rate", type=click.FloatRange(1, 200), default=20.0, show_default=True, help="Poses a second.")
def command(
    robot: str,
    master: str | None,
    at: tuple[float, float],
    height: float,
    heading: float,
    kind: str,
    kinematics: str,
    speed: float,
    yaw_rate: float,
    radius: float,
    row: str | None,
    rate: float,
) -> None:
    """Let a simulated ROBOT take part on ROS 1, until Ctrl-C."""
    said = {
        "kind": kind,
        "kinematics": kinematics,
        "speed_mps": speed,
        "yaw_rate_radps": yaw_rate,
        "radius_m": radius,
        **({} if row is None else {"type": row}),
    }
    it = Robot(id=robot, position=(*at, height), heading_deg=heading, **said)  # type: ignore[arg-type]
    become_node(f"muster_simulated_{robot}", master)
    rospy.set_param(f"/{robot}/muster", said)
    SimulatedRobot(it, rate).run()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the node; an expected failure is a line and exit code 2."""
    try:
        command.main(args=arguments, prog_name="python -m muster.bridges.ros1.simulated", standalone_mode=True)
    except MusterError as error:
        click.echo(str(error), err=True)
        raise SystemExit(2) from None
    except KeyboardInterrupt:
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
