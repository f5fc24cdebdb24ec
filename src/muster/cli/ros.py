"""`muster ros`: the high-level controller of robots on ROS 1 (TCF thesis, section 5.2)."""

from __future__ import annotations

import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from muster.cli.exits import INTERRUPTED
from muster.cli.halting import ctrl_c_halts
from muster.cli.options import Finite, load_mission, mission_argument
from muster.cli.real import (
    Wishes,
    carried_out,
    planned,
    read_wanted,
    real_options,
    reported,
    require_outputs,
    wait_for_robots,
)
from muster.mission.model import Mission
from muster.mission.plan import Plan

if TYPE_CHECKING:
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.execution import Report


@click.command()
@mission_argument
@click.option("--master", metavar="URI", help="The ROS master.  [default: ROS_MASTER_URI, or localhost]")
@click.option(
    "--drive",
    type=click.Choice(["cmd_vel", "goals"]),
    default="cmd_vel",
    show_default=True,
    help="What robots take: velocities, or goals on WP.",
)
@click.option("--namespace", default="", metavar="NAME", help="In which the robots' own are.  [default: the root]")
@click.option("--frame", default="map", show_default=True, metavar="FRAME", help="The mission's frame, for tf.")
@click.option(
    "--wait",
    "wait_s",
    type=Finite(0.0, 1e6),
    default=10.0,
    show_default=True,
    metavar="S",
    help="For the mission's robots.",
)
@click.option(
    "--arrival", type=Finite(0.001, 100.0), default=0.1, show_default=True, metavar="M", help="From a way point."
)
@click.option("--rate", type=Finite(1.0, 200.0), default=20.0, show_default=True, metavar="HZ", help="Of velocities.")
@click.option("--known-only", is_flag=True, help="Robots that the mission does not name do not join.")
@click.option("--on-start", is_flag=True, help="Begin when the service command_interface/start is called.")
@real_options
def command(
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    master: str | None,
    drive: Literal["cmd_vel", "goals"],
    namespace: str,
    frame: str,
    wait_s: float,
    arrival: float,
    rate: float,
    known_only: bool,
    on_start: bool,
    **asked: Any,
) -> int:
    """Carry out a MISSION with robots on ROS 1, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/odom or /r_0/pose. Ctrl-C stops all robots.
    """
    from muster.bridges.ros1.extra import require_rospy

    require_rospy()
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.bridges.ros1.node import become_node, leave

    wishes = Wishes(**asked)
    require_outputs(wishes, (mission, robots, suitability))
    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=wishes.verbose)
    given = read_wanted(wishes, loaded)
    become_node("muster", master)
    with ctrl_c_halts() as halt:
        fleet = Ros1Fleet(
            loaded,
            drive=drive,
            namespace=namespace,
            frame=frame,
            arrival_m=arrival,
            rate_hz=rate,
            joins=not known_only,
        )
        try:
            report = _carried_out(loaded, given, fleet, halt, wait_s, on_start, wishes)
        finally:
            fleet.stop()
            fleet.close()
            leave()
    if report is None:
        click.echo("interrupted; the robots were told to stand", err=True)
        return INTERRUPTED
    return reported(loaded, report, wishes, halt, "the robots were told to stand")


def _carried_out(
    mission: Mission,
    given: Plan | None,
    fleet: Ros1Fleet,
    halt: threading.Event,
    wait_s: float,
    on_start: bool,
    wishes: Wishes,
) -> Report | None:
    """Wait for robots, plan, and carry the plan out; None if it was halted before it began."""
    from muster._live import from_where_they_stand
    from muster.bridges.ros1.station import Station

    started = threading.Event()
    station = Station(mission, fleet, halt=halt, started=started)
    try:
        wait_for_robots(fleet, halt, wait_s)
        while on_start and not (started.is_set() or halt.is_set()):
            time.sleep(0.05)
        if halt.is_set():
            return None
        there = from_where_they_stand(mission, fleet)
        plan = given or planned(wishes, there)
        station.become("carrying-out")
        report = carried_out(there, plan, fleet, wishes, halt, [station])
        station.become("ended")
        return report
    finally:
        station.close()
