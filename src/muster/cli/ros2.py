"""`muster ros2`: a plan carried out by robots on ROS 2, by DDS alone or by rclpy."""

from __future__ import annotations

from contextlib import closing
from typing import TYPE_CHECKING, Literal

import click

from muster.cli.exits import INTERRUPTED
from muster.cli.options import Finite, MissionFile, mission_argument
from muster.cli.real_robots import (
    LastLines,
    RealRunOptions,
    carried_out,
    from_here,
    planned,
    read_given_plan,
    real_options,
    reported,
    require_outputs,
    ros_options,
    start_in_time,
)
from muster.cli.ros_targets import TargetOptions, target_options
from muster.mission.interrupts import TO_END, ctrl_c_halts

if TYPE_CHECKING:
    from muster.bridges.final_state import FinalState

_NEEDED = {"goals": "its pose", "nav2": "its pose, and Nav2"}


@click.command()
@mission_argument
@click.option("--domain", type=int, metavar="N", help="Domain of ROS 2, 0 to 232.  [default: ROS_DOMAIN_ID, or 0]")
@click.option(
    "--give",
    type=click.Choice(["goals", "nav2"]),
    default="goals",
    show_default=True,
    help="How goals are sent: goal_pose, or Nav2's navigate_to_pose.",
)
@click.option(
    "--by",
    type=click.Choice(["dds", "rclpy"]),
    help="The middleware.  [default: rclpy if it can be imported, or dds]",
)
@click.option(
    "--arrival",
    type=Finite(0.001, 100.0),
    default=0.25,
    show_default=True,
    metavar="M",
    help="Distance to a way point at which it counts as reached.",
)
@target_options
@ros_options
@real_options
def command(
    mission: MissionFile,
    domain: int | None,
    namespace: str,
    give: Literal["goals", "nav2"],
    by: Literal["dds", "rclpy"] | None,
    wait_s: float,
    arrival: float,
    known_only: bool,
    targets: TargetOptions | None,
    options: RealRunOptions,
) -> int:
    """Carry out a MISSION with robots on ROS 2, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/pose or /r_0/odom. Ctrl-C lets robots stay where they are. The exit code is 4 if a robot
    still flies or drives at the end.
    """
    from muster.bridges.final_state import final_states_by_telemetry
    from muster.bridges.ros2.fleet import Ros2Fleet
    from muster.bridges.ros2.middleware import domain_or_own
    from muster.bridges.ros2.open_middleware import open_middleware
    from muster.bridges.ros2.port import Arrival
    from muster.running.claim_locks import robots_claimed
    from muster.running.live import wait_for_robots
    from muster.running.robot_claims import claims_of

    require_outputs(options, mission.files)
    loaded = mission.load(verbose=options.verbose)
    given = read_given_plan(options, loaded)
    claims = claims_of("ros2", {"namespace": namespace, "domain": domain_or_own(domain)})
    with ctrl_c_halts(TO_END) as halt, robots_claimed(claims):
        fleet = Ros2Fleet(
            loaded,
            middleware=open_middleware(by, domain),
            give=give,
            namespace=namespace,
            arrival=Arrival(near_m=arrival),
            targets=None if targets is None else targets.settings(),
            joins=not known_only,
        )
        with closing(fleet):
            start = start_in_time(loaded, fleet, options)
            wait_for_robots(fleet, halt, wait_s, _NEEDED[give])
            there = from_here(loaded, fleet)
            plan = given or planned(options, there, start)
            if halt.is_set():
                click.echo("interrupted; nothing was sent", err=True)
                return INTERRUPTED

            def states() -> list[FinalState]:
                return final_states_by_telemetry(fleet, there, fleet.not_told)

            with LastLines(states, begun=True):
                report = carried_out(there, plan, fleet, options, halt)
                return reported(there, report, options, halt, "the robots were told to stay where they are", states())
