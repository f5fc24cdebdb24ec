"""A node that looks like a real robot: `python -m muster.bridges.ros1.simulated r_0 --at 0 0`.

It moves exactly by its kinematics, takes `<robot>/cmd_vel` (stands if that stops for half a second) and, where nobody
tells it velocities, `<robot>/WP`; it says `<robot>/odom`, tf `map` -> `<robot>/base_link`, and on the parameter server
(`<robot>/muster`) what it can do. Where `/use_sim_time` is set it moves by /clock.
"""

from __future__ import annotations

import math
import threading
import time
from collections.abc import Sequence
from typing import Any

import click
import numpy as np

from muster.bridges.ros1.follower import Follower
from muster.bridges.ros1.messages import fill_pose, matrix_of, place_and_heading, tf_of, velocity_of
from muster.bridges.ros1.node import become_node, time_of_ros
from muster.bridges.ros1.ros import Odometry, PoseStamped, TFMessage, Twist, rospy
from muster.bridges.ros1.steering import STILL, Driven, Steering, Velocity
from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.motion.frames import enu_to_flu, flu_to_enu, wrapped
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import KINEMATICS, kinematics_named, limits_of
from muster.motion.port import Place, Waypoint

_DEAF_S = 0.5
"""A robot that is told nothing for longer stands."""
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
        self.robot, self._rate_hz, self._now = robot, rate_hz, time_of_ros()
        x, y, z = (*map(float, robot.position), 0.0)[:3]
        self._state: Floats = np.array([[x, y, z, math.radians(robot.heading_deg)]])
        self._kinematics, self._limits = kinematics_named(robot.kinematics), limits_of(robot)
        self._steering = Steering(interval_s=1 / rate_hz, space=True)
        self._follower = Follower(arrival_m=0.05, turned_rad=0.05, flat=robot.kind == "ground")
        self._lock = threading.Lock()
        self._told: Velocity = STILL
        self._told_s = -math.inf
        self._inputs: Floats | None = None
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
                rates = self._step(now, now - last)
            last = now
            self._say(rates)

    def _step(self, now: float, dt: float) -> Floats:
        place, heading = self._pose
        velocity = self._told if now - self._told_s <= _DEAF_S else self._towards_goal(now, place, heading)
        inputs = self._kinematics.limited(self._as_inputs(velocity, heading), self._limits, self._inputs, dt)
        rates: Floats = self._kinematics.velocities(self._state, inputs)[0]
        self._state = self._kinematics.step(self._state, inputs, dt)
        self._inputs = inputs
        return rates

    @property
    def _pose(self) -> tuple[Place, float]:
        x, y, z, heading = map(float, self._state[0])
        return (x, y, z), float(wrapped(heading))

    def _towards_goal(self, now: float, place: Place, heading: float) -> Velocity:
        self._follower.hear(now, place, heading)
        aim = self._follower.aim
        arrived = aim is not None and self._follower.is_at(place, aim)
        driven = Driven(self.robot, place, heading, (0.0, 0.0, 0.0), aim, arrived)
        return self._steering.velocities([driven])[self.robot.id]

    def _as_inputs(self, velocity: Velocity, heading: float) -> Floats:
        ahead, left, up, turning = velocity
        if len(self._kinematics.input_names) == 2:
            return np.array([[ahead, turning]])
        if self._kinematics.input_names[0] == "ahead_mps":
            return np.array([[ahead, left, up, turning]])
        return np.array([[*flu_to_enu((ahead, left, up), heading), turning]])

    def _say(self, rates: Floats) -> None:
        place, heading = self._pose
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
        velocity = velocity_of(message)
        if all(map(math.isfinite, velocity)):
            with self._lock:
                self._told, self._told_s = velocity, self._now()
                self._follower.take(())

    def _take_goal(self, message: Any) -> None:
        matrix = matrix_of(message.pose)
        if matrix is not None:
            place, heading = place_and_heading(matrix)
            with self._lock:
                self._follower.take([Waypoint(place, heading)])


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
