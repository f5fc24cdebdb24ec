"""`muster ros`: the high-level controller of robots on ROS 1 (TCF thesis, section 5.2)."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.halting import ctrl_c_halts
from muster.cli.options import (
    Finite,
    format_option,
    load_mission,
    optional_mission_argument,
    quiet_option,
    require_complete_option,
    say_of_plan,
)
from muster.cli.report_tables import print_report
from muster.mission.errors import MusterError, NetworkError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text, read_plan

if TYPE_CHECKING:
    from muster.bridges.ros1.children import Children
    from muster.bridges.ros1.controller import Controller
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.execution.executor import Happening
    from muster.execution.report import Report

_FILE = click.Path(path_type=Path)


@click.command()
@optional_mission_argument
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
@click.option("--stay", is_flag=True, help="After the end wait for the next mission, until Ctrl-C.")
@click.option("--seed", type=click.IntRange(min=0), default=0, show_default=True, help="Of planning.")
@click.option(
    "--time-limit", type=click.FloatRange(min=0), default=2.0, show_default=True, metavar="S", help="Of planning."
)
@require_complete_option
@format_option
@quiet_option
def command(
    mission: str | None,
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
    stay: bool,
    seed: int,
    time_limit: float,
    require_complete: bool,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Carry out a MISSION with robots on ROS 1, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/odom or /r_0/pose. Without a MISSION, command_interface/load and start give one. Ctrl-C stops
    all robots.
    """
    from muster.bridges.ros1.extra import require_rospy

    require_rospy()
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.bridges.ros1.node import become_node, leave

    if mission is None and (given := [value for value in (robots, suitability, salesmen, depot, plan) if value]):
        raise ParameterError(f"{given[0]} given without a MISSION; expected both")
    loaded = None if mission is None else load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    planned = None if plan is None else read_plan(plan)
    if plan is not None and planned is not None and loaded is not None:
        say_of_plan(planned, plan, loaded, quiet=quiet, verbose=verbose)

    def fleet_of(its: Mission) -> Ros1Fleet:
        return Ros1Fleet(
            its,
            drive=drive,
            namespace=namespace,
            frame=frame,
            arrival_m=arrival,
            rate_hz=rate,
            joins=not known_only,
        )

    def show(report: Report, its: Mission) -> None:
        if form == "json":
            click.echo(json_text(report.as_dict()), nl=False)
        else:
            print_report(report.as_dict(), its, with_tasks=verbose)

    become_node("muster", master)
    try:
        work = _Work(fleet_of, show, planned, wait_s, seed, time_limit, stay, quiet)
        own = ("--namespace", namespace, "--frame", frame, "--seed", str(seed), "--time-limit", str(time_limit))
        report, interrupted = _carried_out(loaded, work, own, master, begin=not on_start)
    finally:
        leave()
    if interrupted:
        click.echo("interrupted; the robots were told to stand", err=True)
        return INTERRUPTED
    return INCOMPLETE if require_complete and report is not None and report.tasks_lost else DONE


@dataclass(frozen=True)
class _Work:
    """How missions are carried out, whichever they are."""

    fleet_of: Callable[[Mission], Ros1Fleet]
    show: Callable[[Report, Mission], None]
    plan: Plan | None
    wait_s: float
    seed: int
    time_limit: float
    stay: bool
    quiet: bool


def _carried_out(
    mission: Mission | None, work: _Work, own: tuple[str, ...], master: str | None, *, begin: bool
) -> tuple[Report | None, bool]:
    """The last mission's report, and whether it was cut short; with all nodes beside this one.

    Parameters
    ----------
    own
        options of the nodes.
    begin
        whether the mission begins before anybody calls `start`.
    """
    from muster.bridges.ros1.children import Children
    from muster.bridges.ros1.controller import Controller
    from muster.bridges.ros1.node import master_address

    controller = Controller()
    if mission is not None:
        controller.load(mission)
        if begin:
            controller.start()
    elif not work.quiet:
        click.echo("waits for command_interface/load and start", err=True)
    node = (sys.executable, "-m", "muster.cli.ros_node", *own)
    with (
        ctrl_c_halts() as interrupted,
        Children(node, master_address(master), asked_to_end=interrupted.is_set, on_end=controller.end_all) as children,
    ):
        return _one_after_the_other(controller, work, children)


def _one_after_the_other(controller: Controller, work: _Work, children: Children) -> tuple[Report | None, bool]:
    """Missions as they are asked for: one, or with --stay all until the end."""
    while True:
        mission = controller.await_start()
        report, reason = None, ""
        try:
            if mission is not None:
                report = _through(mission, controller, work, children)
        except MusterError as error:
            if children.fault or not work.stay:
                raise NetworkError(children.fault) if children.fault else error from None
            reason = str(error)
            click.echo(reason, err=True)
        if children.fault:
            raise NetworkError(children.fault)
        if report is not None and mission is not None:
            work.show(report, mission)
        halted = controller.halt.is_set()
        controller.end("cancelled" if halted else reason)
        if not work.stay or controller.ending.is_set():
            return report, halted


def _through(mission: Mission, controller: Controller, work: _Work, children: Children) -> Report | None:
    """Wait for robots, plan, and carry the plan out; None if it was halted before it began."""
    from muster._live import carry_out_live

    fleet = work.fleet_of(mission)
    try:
        _wait_for_robots(fleet, controller, work.wait_s)
        there = mission if controller.halt.is_set() else _from_where_they_stand(mission, fleet)
        plan = work.plan or controller.plan(there, seed=work.seed, time_limit=work.time_limit)
        if plan is None or controller.halt.is_set():
            return None
        controller.carry_out(fleet)
        tell = None if work.quiet else _tell
        return carry_out_live(
            there, plan, fleet, seed=work.seed, observer=controller.board, on_happening=tell, halt=controller.halt
        )
    finally:
        fleet.stop()
        if children.fault:
            time.sleep(_ARRIVES_S)  # a master that hangs is not told of the end
        else:
            fleet.close()


_ARRIVES_S = 0.3
"""In which what robots were told last arrives."""


def _wait_for_robots(fleet: Ros1Fleet, controller: Controller, wait_s: float) -> None:
    """Until each robot of the mission has said where it is."""
    until = time.monotonic() + wait_s
    while fleet.unheard() and not controller.halt.is_set():
        if time.monotonic() > until:
            robot, why = next(iter(fleet.unheard().items()))
            others = len(fleet.unheard()) - 1
            more = f" (and {others} more)" if others else ""
            raise NetworkError(f"robot {robot}: {why} within {wait_s:g} s{more}; expected its pose")
        time.sleep(0.05)


def _from_where_they_stand(mission: Mission, fleet: Ros1Fleet) -> Mission:
    """The mission with the robots' own poses for its starts."""
    robots = []
    for robot in mission.robots:
        said = fleet.ports[robot.id].telemetry()
        assert said is not None
        robots.append(replace(robot, position=said.position[: mission.dimensions]))
    return replace(mission, robots=tuple(robots))


def _tell(happening: Happening) -> None:
    from muster.report.record.messages import event_line

    line: Any = event_line(happening.kind, happening.data)
    print(f"{happening.at_s:9.1f} s  {line}", file=sys.stderr, flush=True)  # noqa: T201
