"""`muster ros`: the high-level controller of robots on ROS 1 (TCF thesis, section 5.2)."""

from __future__ import annotations

import sys
import threading
import time
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.halting import ctrl_c_halts
from muster.cli.options import (
    Finite,
    format_option,
    load_mission,
    mission_argument,
    quiet_option,
    require_complete_option,
    say_of_plan,
)
from muster.cli.report_tables import print_report
from muster.mission.errors import NetworkError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.execution.executor import Happening
    from muster.execution.report import Report

_FILE = click.Path(path_type=Path)


@click.command()
@mission_argument
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one from where the robots stand]")
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
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of planning.")
@click.option(
    "--time-limit", type=click.FloatRange(min=0), default=2.0, show_default=True, metavar="S", help="Of planning."
)
@require_complete_option
@format_option
@quiet_option
def command(
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    plan: Path | None,
    master: str | None,
    drive: Literal["cmd_vel", "goals"],
    namespace: str,
    frame: str,
    wait_s: float,
    arrival: float,
    rate: float,
    known_only: bool,
    on_start: bool,
    seed: int,
    time_limit: float,
    require_complete: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Carry out a MISSION with robots on ROS 1, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/odom or /r_0/pose. Ctrl-C stops all robots.
    """
    from muster.bridges.ros1.extra import require_rospy

    require_rospy()
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.bridges.ros1.node import become_node, leave

    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    planned = None if plan is None else read_plan(plan)
    if plan is not None and planned is not None:
        say_of_plan(planned, plan, loaded, quiet=quiet, verbose=verbose)
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
            report = _carried_out(loaded, planned, fleet, halt, wait_s, on_start, seed, time_limit, quiet)
        finally:
            fleet.stop()
            fleet.close()
            leave()
    if report is not None and form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    elif report is not None:
        print_report(report.as_dict(), loaded, with_tasks=verbose)
    if halt.is_set():
        click.echo("interrupted; the robots were told to stand", err=True)
        return INTERRUPTED
    return INCOMPLETE if require_complete and report is not None and report.tasks_lost else DONE


def _carried_out(
    mission: Mission,
    plan: Plan | None,
    fleet: Ros1Fleet,
    halt: threading.Event,
    wait_s: float,
    on_start: bool,
    seed: int,
    time_limit: float,
    quiet: bool,
) -> Report | None:
    """Wait for robots, plan, and carry the plan out; None if it was halted before it began."""
    from muster import solve
    from muster._live import carry_out_live
    from muster.bridges.ros1.station import Station
    from muster.bridges.starts import from_where_they_stand

    started = threading.Event()
    station = Station(mission, fleet, halt=halt, started=started)
    try:
        _wait_for_robots(fleet, halt, wait_s)
        while on_start and not (started.is_set() or halt.is_set()):
            time.sleep(0.05)
        if halt.is_set():
            return None
        there, remarks = from_where_they_stand(mission, fleet.ports)
        for remark in remarks:
            click.echo(remark, err=True)
        planned = solve(there, seed=seed, time_limit=time_limit) if plan is None else plan
        station.become("carrying-out")
        tell = None if quiet else _tell
        report = carry_out_live(there, planned, fleet, seed=seed, observer=station, on_happening=tell, halt=halt)
        station.become("ended")
        return report
    finally:
        station.close()


def _wait_for_robots(fleet: Ros1Fleet, halt: threading.Event, wait_s: float) -> None:
    """Until each robot of the mission has said where it is."""
    until = time.monotonic() + wait_s
    while fleet.unheard() and not halt.is_set():
        if time.monotonic() > until:
            robot, why = next(iter(fleet.unheard().items()))
            others = len(fleet.unheard()) - 1
            more = f" (and {others} more)" if others else ""
            raise NetworkError(f"robot {robot}: {why} within {wait_s:g} s{more}; expected its pose")
        time.sleep(0.05)


def _tell(happening: Happening) -> None:
    from muster.report.record.messages import event_line

    line: Any = event_line(happening.kind, happening.data)
    print(f"{happening.at_s:9.1f} s  {line}", file=sys.stderr, flush=True)  # noqa: T201
