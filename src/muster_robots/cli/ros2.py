"""`muster ros2`: a plan carried out by robots on ROS 2, by DDS alone or by rclpy."""

from __future__ import annotations

from contextlib import closing

import click

from muster.cli.options.common import MissionFile, mission_argument
from muster.mission.system.interrupts import TO_END, ctrl_c_halts
from muster_robots.cli.going_on import going_on
from muster_robots.cli.real_robots import (
    carried_out_from_here,
    read_given_plan,
    real_options,
    require_outputs,
)
from muster_robots.cli.ros_targets import TargetOptions, target_options
from muster_robots.cli.run_options import RealRunOptions
from muster_robots.fleet_settings import Ros2Settings


@click.command()
@mission_argument
@target_options
@real_options("ros2", Ros2Settings)
def command(mission: MissionFile, targets: TargetOptions | None, options: RealRunOptions) -> int:
    """Carry out a MISSION with robots on ROS 2, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/pose or /r_0/odom. Ctrl-C lets robots stay where they are. The exit code is 4 if a robot
    still flies or drives at the end.
    """
    from muster.running.claim_locks import robots_claimed
    from muster.running.live import wait_for_robots
    from muster.running.robot_claims import claims_of_request
    from muster_robots.opening import NEEDED
    from muster_robots.ros2.fleet import Ros2Fleet

    require_outputs(options, mission.files)
    loaded = mission.load(verbose=options.verbose)
    given, settings, how = read_given_plan(options, loaded), options.request.settings, going_on(options, loaded)
    with ctrl_c_halts(TO_END) as halt, robots_claimed(claims_of_request(options.request)):
        fleet = Ros2Fleet(loaded, settings, targets=None if targets is None else targets.settings())
        with closing(fleet):
            wait_for_robots(fleet, halt, settings.wait_s, NEEDED[settings.give], some=how.again)
            return carried_out_from_here(fleet, given, how, options, halt)
