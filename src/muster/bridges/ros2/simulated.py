"""A participant that looks like a real robot: `python -m muster.bridges.ros2.simulated r_0 --at 0 0`.

It moves exactly by its kinematics to `<robot>/goal_pose`, or as `<robot>/cmd_vel` says (until that stops for half a
second); it says `<robot>/odom`, and once a second on `<robot>/muster` what it can do.
"""

from __future__ import annotations

import json
import math
import time
from collections.abc import Sequence
from dataclasses import replace
from typing import Any

import click

from muster.bridges.ros2.messages import (
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
from muster.bridges.ros2.names import ros_name
from muster.bridges.ros2.port import MAP_FRAME, yaw_of
from muster.bridges.ros2.wire import Wire, open_wire
from muster.bridges.simulated_body import Body
from muster.mission.errors import MusterError
from muster.mission.model import Robot
from muster.motion.frames import enu_to_flu
from muster.motion.grid import Floats
from muster.motion.kinematics.registry import KINEMATICS

_SAYS_S = 1.0


class SimulatedRobot:
    """One robot on a wire.

    Parameters
    ----------
    robot
        who it is, where it starts, and its limits.
    rate_hz
        of its steps and its poses.
    says
        of itself, as in a mission file.
    """

    def __init__(self, robot: Robot, wire: Wire, rate_hz: float, says: dict[str, Any]) -> None:
        name = ros_name(robot.id)
        self._name, self._wire, self._rate_hz, self._body = name, wire, rate_hz, Body(robot, rate_hz)
        self._goals = wire.reader(f"/{name}/goal_pose", PoseStamped)
        self._velocities = wire.reader(f"/{name}/cmd_vel", Twist)
        self._poses = wire.writer(f"/{name}/odom", Odometry)
        self._words = wire.writer(f"/{name}/muster", String)
        self._says, self._said_s = String(json.dumps(says)), -math.inf

    def run(self) -> None:
        """Move and say so, for ever."""
        last = time.monotonic()
        while True:
            self._wire.wait(1 / self._rate_hz)
            now = time.monotonic()
            self._hear(now)
            self._say(now, self._body.step(now, now - last))
            last = now

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
        self._poses.write(Odometry(header, f"{self._name}/base_link", pose, TwistWithCovariance(moves)))
        if now - self._said_s >= _SAYS_S:
            self._said_s = now
            self._words.write(self._says)


@click.command()
@click.argument("robot")
@click.option("--domain", type=int, metavar="N", help="Of ROS 2.  [default: ROS_DOMAIN_ID, or 0]")
@click.option("--by", type=click.Choice(["dds", "rclpy"]), help="[default: rclpy where it can be imported, or dds]")
@click.option("--at", type=float, nargs=2, default=(0.0, 0.0), metavar="X Y", help="Where it starts, in metres.")
@click.option("--height", type=float, default=0.0, metavar="Z", help="How high.")
@click.option("--heading", type=float, default=0.0, metavar="DEG", help="From east, anticlockwise.")
@click.option("--kind", type=click.Choice(["ground", "air"]), default="ground", show_default=True)
@click.option("--kinematics", type=click.Choice(list(KINEMATICS)), default="differential-drive", show_default=True)
@click.option(
    "--speed", "speed_mps", type=click.FloatRange(0, min_open=True), default=1.0, show_default=True, help="m/s."
)
@click.option(
    "--yaw-rate",
    "yaw_rate_radps",
    type=click.FloatRange(0, min_open=True),
    default=1.5,
    show_default=True,
    help="rad/s.",
)
@click.option("--radius", "radius_m", type=click.FloatRange(0), default=0.2, show_default=True, help="Metres.")
@click.option("--type", metavar="TYPE", help="Its row of a mission's suitability table.")
@click.option("--rate", type=click.FloatRange(1, 200), default=20.0, show_default=True, help="Poses a second.")
def command(
    robot: str,
    domain: int | None,
    by: Any,
    at: tuple[float, float],
    height: float,
    heading: float,
    rate: float,
    **body: Any,
) -> None:
    """Let a simulated ROBOT take part on ROS 2, until Ctrl-C."""
    says = {name: value for name, value in body.items() if value is not None}
    it = replace(Robot(id=robot, position=(*at, height), heading_deg=heading), **says)
    SimulatedRobot(it, open_wire(by, domain), rate, says).run()


def main(arguments: Sequence[str] | None = None) -> None:
    """Run it; an expected failure is a line and exit code 2."""
    try:
        command.main(args=arguments, prog_name="python -m muster.bridges.ros2.simulated", standalone_mode=False)
    except click.ClickException as error:
        error.show()
        raise SystemExit(2) from None
    except MusterError as error:
        click.echo(str(error), err=True)
        raise SystemExit(2) from None
    except (KeyboardInterrupt, click.Abort):
        raise SystemExit(130) from None


if __name__ == "__main__":
    main()
