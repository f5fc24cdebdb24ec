"""`muster simulate`: carry a plan out in a simulated world; the report compares it with the plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from muster.cli.backend import Backend, server_option
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.live_output import foxglove_option, print_event_line, shown_live
from muster.cli.options.common import (
    MissionFile,
    format_option,
    load_plan,
    mission_argument,
    quiet_option,
    require_complete_option,
)
from muster.cli.options.coordination import coordination_options, coordination_parameters
from muster.cli.options.planning import ctrl_c_interrupts, planning_options, request_of
from muster.cli.options.request import request_options
from muster.cli.options.run_outputs import AskedOutputs, not_at_server, run_output_options
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.record_output import drawing_options, kept_record, map_outputs, record_option, save_map_option
from muster.cli.tables.report import print_report
from muster.cli.whole_work import whole_work
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster.planning.options import PlanningOptions
from muster.planning.request import Request
from muster.running.coordination import COORDINATIONS, Coordination
from muster.running.observed_run import ObservedRun
from muster.running.run_outputs import BegunOutput
from muster.running.run_request import SIMULATED, RunRequest
from muster.state.reasons import has_stand_in

if TYPE_CHECKING:
    from muster.running.localisation import Localise

_FILE = click.Path(path_type=Path)
_OF_A_PLAN = (
    *("plan", "ignore", "time_limit", "iterations", "allocator", "objective", "threads", "ray"),
    *("bound", "start", "fixed", "rewire", "stay", "until_s", "orders"),
)
_PROCESSES = "the robots' processes run on this machine"
_IN_THIS_PROCESS = {
    **dict.fromkeys(coordination_parameters(), _PROCESSES),
    "ray": "a server uses no cluster",
    "found": "it keeps no pictures of cameras",
    "save_map": "the record that it keeps has the map",
    "foxglove": "the port is one of this machine",
}


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """The options of the verb that are no part of a request."""

    plan: Path | None
    start: Path | None
    fixed: Path | None
    coordination: tuple[str, Mapping[str, Any]] | None
    record: Path | None
    html: Path | None
    plot: Path | None
    gantt: Path | None
    found: Path | None
    save_map: Path | None
    outputs: AskedOutputs
    foxglove: int | None
    require_complete: bool
    form: str
    quiet: bool
    verbose: bool


@click.command()
@mission_argument
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that the allocator makes]")
@coordination_options
@planning_options(time_limit_s=2.0, carries_out=True)
@request_options(RunRequest, SIMULATED)
@record_option
@drawing_options
@click.option("--found", type=_FILE, metavar="FILE", help="Draw what cameras found (.png, .svg, .pdf).")
@save_map_option
@run_output_options
@foxglove_option
@require_complete_option
@format_option
@quiet_option
@server_option(**_IN_THIS_PROCESS, **not_at_server())
def command(
    backend: Backend, mission: MissionFile, options: PlanningOptions, how: Mapping[str, Any], **given: Any
) -> int:
    """Carry out a plan of a MISSION in a simulated world, in virtual time, and report its cost.

    Robots keep their speeds and avoid each other. The mission's events happen, and the tasks left are planned again.

    With --stay a fleet stays on duty when its tasks are done, for orders that come: see docs/standing-fleets.md.

    With --negotiate there is no plan and no centre: robots agree as in `muster auction`, over the same network, and
    each decides for itself what to do next. They exchange messages in real time.
    """
    asked = _Asked(**given)
    if asked.coordination is not None:
        _refuse_options_of_plans(asked.coordination[0])
    request = _request(asked, options, how)
    _require_outputs(asked, mission, request.world)
    loaded = mission.load(verbose=asked.verbose)
    if request.localise is not None:
        _require_possible(request.localise, loaded)
    outputs = [*asked.outputs.begin(loaded, request.world), *_found(loaded, asked.found)]
    planned = _planned(backend, asked, loaded, options)
    if isinstance(planned, Plan):
        planned.require_whole(accept_partial=request.accept_partial)
    with (
        kept_record(asked.record, asked.html, asked.plot, asked.gantt) as file,
        shown_live(loaded, asked.foxglove, quiet=asked.quiet) as observers,
    ):
        request = replace(request, record=file, observers=observers).observed_by(outputs)
        on_line = print_event_line if request.speed is not None and not asked.quiet else None
        report, interrupted_s = backend.simulate(loaded, planned, request, on_line)
    if asked.form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    else:
        print_report(report.as_dict(), loaded, with_tasks=asked.verbose)
    for output in outputs:
        output.write(lambda line: None if asked.quiet else click.echo(line, err=True))
    if interrupted_s is not None:
        click.echo(f"interrupted at {interrupted_s:.1f} s of the mission", err=True)
    return exit_code_if(
        (Ending.INTERRUPTED, interrupted_s is not None),
        (Ending.LEFT_OUT, asked.require_complete and not all(has_stand_in(reason) for _, reason in report.tasks_lost)),
    )


def _request(asked: _Asked, options: PlanningOptions, how: Mapping[str, Any]) -> ObservedRun:
    """The request of the run; what is wrong with it is said before anything is read."""
    if "speed" not in how and (asked.coordination or asked.foxglove is not None):
        how = {**how, "speed": 1.0}
    rules: dict[str, Any] = {} if asked.coordination else {"ignore": options.ignore, "planning": options}
    return ObservedRun(**how, seed=options.seed, save_map=asked.save_map, **rules)


def _require_outputs(asked: _Asked, mission: MissionFile, world: str) -> None:
    """Refuse files that cannot be written, or would replace one that is read."""
    files = (asked.record, asked.html, asked.plot, asked.gantt, *asked.outputs.files, asked.found)
    files += map_outputs(asked.save_map)
    require_writable(None, files, mission.files, (asked.plan, asked.start, asked.fixed))
    require_drawable(asked.plot, asked.gantt, asked.found)
    asked.outputs.require_possible(world)


def _planned(backend: Backend, asked: _Asked, mission: Mission, options: PlanningOptions) -> Plan | Coordination:
    """What is carried out: the plan of --plan, one that is made now, or a coordination."""
    if asked.coordination is not None:
        return _coordination(mission, *asked.coordination, options)
    if asked.plan is None:
        return _plan(backend, request_of(options, mission, asked.start, asked.fixed), quiet=asked.quiet)
    plan = load_plan(asked.plan, mission, options.ignore, quiet=asked.quiet, verbose=asked.verbose)
    return _judged(mission, plan, asked.plan, options.ignore, quiet=asked.quiet)


def _refuse_options_of_plans(coordination: str) -> None:
    """Refuse options that count only where a plan is carried out."""
    context = click.get_current_context()
    for option in sorted(context.command.params, key=lambda option: str(option.name)):
        given = context.get_parameter_source(str(option.name)) is ParameterSource.COMMANDLINE
        if given and option.name in _OF_A_PLAN:
            raise ParameterError(f"{option.opts[-1]} given; expected it without --{coordination}")


def _require_possible(localise: Localise, mission: Mission) -> None:
    """Refuse sensors before anything is planned."""
    from muster.running.localisation import require_possible, sensors_of

    require_possible(sensors_of(localise), mission)


def _found(mission: Mission, file: Path | None) -> list[BegunOutput]:
    """The picture of what cameras find, if it is asked for."""
    if file is None:
        return []
    from muster.report.found import FoundByCameras
    from muster.running.camera_search import require_tags

    require_tags(mission, "--found")
    found = FoundByCameras()
    return [BegunOutput(on_look=found, write=lambda say: found.plot(mission, file))]


def _coordination(mission: Mission, name: str, how: Mapping[str, Any], options: PlanningOptions) -> Coordination:
    """How robots decide without a plan; a mission on which they cannot is refused before any file is opened."""
    coordination = COORDINATIONS[name](**how, params=options.parameters)
    coordination.refuse_mission(mission)
    return coordination


def _judged(mission: Mission, plan: Plan, file: Path, ignore: tuple[str, ...], *, quiet: bool) -> Plan:
    """The plan with the judge's objective. A plan that breaks rules is simulated after a warning that names them."""
    from muster.verification import verify

    verdict = verify(mission, plan, ignore, plan.objective)
    if not verdict.valid and not quiet:
        click.echo(f"warning: {file}: the judge rejects this plan: {verdict.first_violations}", err=True)
    return replace(plan, objective=verdict.objective_name, objective_value=verdict.value())


def _plan(backend: Backend, request: Request, *, quiet: bool) -> Plan:
    """A plan as requested.

    Raises
    ------
    KeyboardInterrupt
        if Ctrl-C ended planning: nothing is carried out then.
    """
    from muster.cli.progress import progress_bar

    interrupt = whole_work()
    with ctrl_c_interrupts(interrupt), progress_bar(not quiet, request.mission) as on_progress:
        plan = backend.plan(request, on_progress, interrupt).plan
    if interrupt.interrupted:
        click.echo("interrupted: " + "; ".join(filter(None, (backend.kept(plan), "nothing was started"))), err=True)
        raise KeyboardInterrupt
    return plan
