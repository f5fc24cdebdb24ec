"""`muster ros`: the high-level controller of robots on ROS 1 ([tcf-thesis], section 5.2)."""

from __future__ import annotations

import json
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exit_codes import gravest
from muster.cli.exits import DONE, INTERRUPTED
from muster.cli.options.common import (
    MissionFile,
    optional_mission_argument,
    require_none_without_mission,
)
from muster.mission.errors import MusterError, NetworkError, ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.reading.plan_reader import read_plan
from muster.mission.system.interrupts import TO_END, ctrl_c_halts
from muster_robots.cli.going_on import going_on, recovered
from muster_robots.cli.last_lines import LastLines
from muster_robots.cli.real_robots import (
    carried_out,
    from_here,
    read_given_plan,
    real_options,
    reported,
    require_outputs,
    require_whole,
    start_in_time,
)
from muster_robots.cli.ros_targets import TargetOptions, target_options
from muster_robots.cli.run_options import RealRunOptions
from muster_robots.fleet_settings import Ros1Settings

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.execution.final_state import FinalState
    from muster_robots.ros1.controller import Controller
    from muster_robots.ros1.fleet import Ros1Fleet
    from muster_robots.ros1.node_processes import NodeProcesses

_LEFT = "the robots were told to stand"


@click.command()
@optional_mission_argument
@click.option("--markers", is_flag=True, help="Publish tasks, routes and robots for RViz, on /muster/markers.")
@click.option("--on-start", is_flag=True, help="Begin when the service command_interface/start is called.")
@click.option("--stay", is_flag=True, help="After the end wait for the next mission, until Ctrl-C.")
@target_options
@real_options("ros1", Ros1Settings, without=("stay", "until_s", "orders"))
def command(
    mission: MissionFile | None,
    markers: bool,
    on_start: bool,
    stay: bool,
    targets: TargetOptions | None,
    options: RealRunOptions,
) -> int:
    """Carry out a MISSION with robots on ROS 1, in real time; robots that it does not name may join.

    Robot r_0 is at /r_0/odom or /r_0/pose. Without a MISSION the command waits for command_interface/load and start.
    Ctrl-C stops all robots. The exit code is 4 if a robot still flies or drives at the end.
    """
    from muster_robots.ros1.extra import require_rospy

    require_rospy()
    if markers or targets is not None:
        require_rospy(("sensor_msgs", "visualization_msgs"))
    from muster_robots.ros1.node import become_node, leave

    if mission is None:
        require_none_without_mission(plan=options.plan, resume=options.resume, recover=options.request.recover or None)
    _require_one_mission(options, stay)
    require_outputs(options, () if mission is None else mission.files)
    loaded = None if mission is None else mission.load(verbose=options.verbose)
    given = None if loaded is None else read_given_plan(options, loaded)
    if loaded is not None:
        going_on(options, loaded, _claims(options))  # refuses what does not go together, before nodes start

    settings = options.request.settings

    become_node("muster", settings.master)
    try:
        own = ("--planning", json.dumps(_as_data(options)), "--targets", "" if targets is None else targets.as_text())
        where = ("--namespace", settings.namespace, "--frame", settings.frame, "--poses", settings.poses)
        node = (sys.executable, "-m", "muster_robots.cli.ros_node", *where, *own)
        work = _Work(
            given, stay, stay or loaded is None, targets is not None, settings.frame if markers else None, options
        )
        return _with_nodes(loaded, work, node, begins=not on_start)
    finally:
        leave()


def _as_data(options: RealRunOptions) -> dict[str, Any]:
    """The planning options for the node /mission_planner, with the plans of --start and --fixed."""
    plans = {name: file for name in ("start", "fixed") if (file := getattr(options, name)) is not None}
    return options.planning.as_dict() | {name: read_plan(file).as_dict() for name, file in plans.items()}


def _claims(options: RealRunOptions) -> tuple[str, ...]:
    """What tells the robots of a ROS master from those of others."""
    from muster_robots.ros1.node import master_address

    return (f"master {master_address(options.request.settings.master)}",)


def _require_one_mission(options: RealRunOptions, stay: bool) -> None:
    """Refuse output files beside --stay: each holds the results of one mission."""
    for name in ("record", "html", "plot", "gantt"):
        if stay and getattr(options, name) is not None:
            raise ParameterError(f"--{name} given with --stay; expected one of them: a file holds one mission")
    if stay and (options.resume is not None or options.request.recover):
        asked = "--recover" if options.request.recover else "--resume"
        raise ParameterError(f"{asked} given with --stay; expected one of them: it concerns one mission")


@dataclass(frozen=True)
class _Work:
    """What is the same for every mission that is carried out."""

    plan: Plan | None
    stay: bool
    loads: bool  # whether users load missions: what they start begins anew
    finds_targets: bool
    marked_in: str | None  # the frame of markers for RViz, where they are asked for
    options: RealRunOptions


def _with_nodes(mission: Mission | None, work: _Work, node: tuple[str, ...], *, begins: bool) -> int:
    """Carry missions out while the other nodes run; returns the exit code.

    Parameters
    ----------
    node
        the command that runs such a node.
    begins
        whether the mission begins without a call of `start`.
    """
    from muster_robots.ros1.controller import Controller
    from muster_robots.ros1.node import master_address
    from muster_robots.ros1.node_processes import DUTIES, NodeProcesses

    controller = Controller()
    if mission is not None:
        controller.load(mission)
        if begins:
            controller.start()
    elif not work.options.quiet:
        click.echo("waits for command_interface/load and start", err=True)
    with ctrl_c_halts(TO_END) as asked:
        children = NodeProcesses(
            node,
            master_address(work.options.request.settings.master),
            asked_to_end=asked.is_set,
            on_end=controller.end_all,
            duties=(*DUTIES, "target_localization") if work.finds_targets else DUTIES,
        )
        with children:
            code = _one(controller, work, children)
            while work.stay and not controller.ending.is_set():
                code = _one(controller, work, children)
        if children.fault:
            raise NetworkError(children.fault)
        return gravest(code, INTERRUPTED) if controller.ending.is_set() else code


def _one(controller: Controller, work: _Work, children: NodeProcesses) -> int:
    """Wait for one mission and carry it out; returns the exit code.

    Raises
    ------
    MusterError
        if that fails; with --stay the message is published, and the next mission may be loaded.
    """
    mission, code, reason = controller.await_start(), DONE, ""
    try:
        outcome = None if mission is None else _through(mission, controller, work, children)
        if isinstance(outcome, int):
            code = outcome
        elif mission is not None and outcome is not None and not children.fault:
            report, states = outcome
            code = reported(mission, report, work.options, controller.halt, _LEFT, states)
        elif not children.fault and controller.halt.is_set():
            click.echo("interrupted" if mission is None else f"interrupted; {_LEFT}", err=True)
            code = INTERRUPTED
    except MusterError as error:
        if not work.stay and not children.fault:
            raise
        reason = "" if children.fault else str(error)
        click.echo(reason, err=True, nl=bool(reason))
    controller.end("cancelled" if controller.halt.is_set() else reason)
    return code


def _through(
    mission: Mission, controller: Controller, work: _Work, children: NodeProcesses
) -> tuple[Report, list[FinalState]] | int | None:
    """Open the fleet, carry the mission out, and close the fleet; None if halted before the beginning.

    Where robots are brought home only, the exit code is returned.
    """
    from muster_robots.ros1.fleet import Ros1Fleet

    fleet = Ros1Fleet(mission, work.options.request.settings)
    try:
        return _carried_out(mission, controller, work, fleet, children)
    finally:
        fleet.stop()
        if children.fault:
            fleet.fall_silent()  # a master that hangs is not told of the end
        else:
            fleet.close()


def _carried_out(
    mission: Mission, controller: Controller, work: _Work, fleet: Ros1Fleet, children: NodeProcesses
) -> tuple[Report, list[FinalState]] | int | None:
    """Wait for robots, plan, and carry the plan out; see `_through`."""
    from muster.execution.final_state import final_states_by_telemetry
    from muster.running.live import wait_for_robots
    from muster.running.wall_time import planned_from

    options, there, plan = work.options, mission, work.plan
    how = going_on(options, mission, _claims(options))
    start = None if how.again else start_in_time(mission, fleet, options)
    wait_for_robots(fleet, controller.halt, options.request.settings.wait_s, some=how.again)
    if controller.halt.is_set():
        return None
    if not work.loads:
        how.require_nobody_left(final_states_by_telemetry(fleet, mission))
    if start is not None:
        there = from_here(mission, fleet)
        plan = plan or controller.plan(planned_from(there, start.seconds()), _as_data(options))
        if plan is None or controller.halt.is_set():
            return None
        require_whole(plan, options)
    controller.carry_out(fleet)
    if how.recovers:
        return recovered(how, fleet, options, controller.halt, lambda: None)
    observers: list[Recorder] = [controller.mission_topics]
    if work.marked_in is not None:
        from muster_robots.ros1.markers import Markers

        observers.append(Markers(there, work.marked_in))

    def states() -> list[FinalState]:
        return [] if children.fault else how.judged(final_states_by_telemetry(fleet, there))

    with LastLines(states, begun=True):
        report = carried_out(there, plan, fleet, how, options, controller.halt, states, observers)
        return report, states()
