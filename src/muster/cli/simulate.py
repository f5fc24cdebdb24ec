"""`muster simulate`: carry a plan out in a simulated world; the report compares it with the plan."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from muster.cli.auction_options import method_options
from muster.cli.backend import Backend, server_option
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.film_options import draw_footage, footage_of, require_filmable
from muster.cli.live_output import foxglove_option, print_event_line, shown_live
from muster.cli.options import (
    Finite,
    MissionFile,
    format_option,
    load_plan,
    mission_argument,
    quiet_option,
    require_complete_option,
)
from muster.cli.outputs import require_drawable, require_folder, require_writable
from muster.cli.planning_options import ctrl_c_interrupts, planning_options, request_of
from muster.cli.record_output import drawing_options, kept_record, record_option
from muster.cli.report_tables import print_report
from muster.cli.request_options import request_options
from muster.cli.whole_work import whole_work
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster.planning.options import PlanningOptions
from muster.planning.request import Request
from muster.running.observed_run import ObservedRun
from muster.running.run_request import SIMULATED, RunRequest

if TYPE_CHECKING:
    from muster import Negotiation
    from muster.report.camera_pictures import CameraPictures
    from muster.running.localisation import Localise

_FILE = click.Path(path_type=Path)
_OF_A_PLAN = (
    *("plan", "ignore", "time_limit", "iterations", "allocator", "objective", "threads", "ray"),
    *("bound", "start", "fixed", "rewire", "stay", "until_s", "orders"),
)
_OF_A_NEGOTIATION = ("method", "transport")
_PROCESSES = "the robots' processes run on this machine"
_PICTURES = "it keeps no pictures of cameras"
_BODIES = "it keeps where bodies are, and not how they look"
_IN_THIS_PROCESS = {
    "method": _PROCESSES,
    "transport": _PROCESSES,
    "negotiate": _PROCESSES,
    "ray": "a server uses no cluster",
    "found": _PICTURES,
    "cameras": _PICTURES,
    "film": _BODIES,
    "film_speed": _BODIES,
    "still": _BODIES,
    "foxglove": "the port is one of this machine",
}


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """The options of the verb that are no part of a request."""

    plan: Path | None
    start: Path | None
    fixed: Path | None
    negotiate: bool
    record: Path | None
    html: Path | None
    plot: Path | None
    gantt: Path | None
    found: Path | None
    cameras: Path | None
    film: Path | None
    film_speed: float | None
    still: Path | None
    method: str
    transport: str
    foxglove: int | None
    require_complete: bool
    form: str
    quiet: bool
    verbose: bool


@click.command()
@mission_argument
@click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that the allocator makes]")
@planning_options(time_limit_s=2.0, carries_out=True)
@click.option("--negotiate", is_flag=True, help="No plan: each robot is a process, and they agree among themselves.")
@request_options(RunRequest, SIMULATED)
@record_option
@drawing_options
@click.option("--found", type=_FILE, metavar="FILE", help="Draw what cameras found (.png, .svg, .pdf).")
@click.option(
    "--cameras", type=_FILE, metavar="DIR", help="Write what cameras saw of each tag, largest; with --world physics."
)
@click.option("--film", type=_FILE, metavar="FILE", help="Film it, in the physics world (.mp4, .gif).")
@click.option(
    "--film-speed", type=Finite(0.01, 1e6), metavar="X", help="X times real time.  [default: a film of at most 24 s]"
)
@click.option("--still", type=_FILE, metavar="FILE", help="Draw how it ended from above, in the physics world (.png).")
@foxglove_option
@method_options
@require_complete_option
@format_option
@quiet_option
@server_option(**_IN_THIS_PROCESS)
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
    _check_together(asked.negotiate)
    request = _request(asked, options, how)
    _require_outputs(asked, mission, request.world)
    loaded = mission.load(verbose=asked.verbose)
    if request.localise is not None:
        _require_possible(request.localise, loaded)
    looks = _looks(loaded, request.world, asked.found, asked.cameras)
    planned = _planned(backend, asked, loaded, options)
    if isinstance(planned, Plan):
        planned.require_whole(accept_partial=request.accept_partial)
    footage = footage_of(loaded) if asked.film is not None or asked.still is not None else None
    with (
        kept_record(asked.record, asked.html, asked.plot, asked.gantt) as file,
        shown_live(loaded, asked.foxglove, quiet=asked.quiet) as observers,
    ):
        request = replace(request, record=file, observers=observers, film=footage, on_look=looks)
        on_line = print_event_line if request.speed is not None and not asked.quiet else None
        report, interrupted_s = backend.simulate(loaded, planned, request, on_line)
    if asked.found is not None and looks is not None:
        looks.plot(loaded, asked.found)
    if asked.form == "json":
        click.echo(json_text(report.as_dict()), nl=False)
    else:
        print_report(report.as_dict(), loaded, with_tasks=asked.verbose)
    if footage is not None:
        draw_footage(footage, asked.film, asked.film_speed, asked.still, quiet=asked.quiet)
    if interrupted_s is not None:
        click.echo(f"interrupted at {interrupted_s:.1f} s of the mission", err=True)
    return exit_code_if(
        (Ending.INTERRUPTED, interrupted_s is not None), (Ending.LEFT_OUT, asked.require_complete and report.tasks_lost)
    )


def _request(asked: _Asked, options: PlanningOptions, how: Mapping[str, Any]) -> ObservedRun:
    """The request of the run; what is wrong with it is said before anything is read."""
    if "speed" not in how and (asked.negotiate or asked.foxglove is not None):
        how = {**how, "speed": 1.0}
    rules: dict[str, Any] = {} if asked.negotiate else {"ignore": options.ignore, "planning": options}
    return ObservedRun(**how, seed=options.seed, **rules)


def _require_outputs(asked: _Asked, mission: MissionFile, world: str) -> None:
    """Refuse files that cannot be written, or would replace one that is read."""
    files = (asked.record, asked.html, asked.plot, asked.gantt, asked.film, asked.still, asked.found)
    require_writable(None, files, mission.files, (asked.plan, asked.start, asked.fixed))
    require_drawable(asked.plot, asked.gantt, asked.found)
    require_filmable(world, asked.film, asked.film_speed, asked.still)


def _planned(backend: Backend, asked: _Asked, mission: Mission, options: PlanningOptions) -> Plan | Negotiation:
    """What is carried out: the plan of --plan, one that is made now, or a negotiation."""
    if asked.negotiate:
        return _negotiation(mission, asked.method, asked.transport, options)
    if asked.plan is None:
        return _plan(backend, request_of(options, mission, asked.start, asked.fixed), quiet=asked.quiet)
    plan = load_plan(asked.plan, mission, options.ignore, quiet=asked.quiet, verbose=asked.verbose)
    return _judged(mission, plan, asked.plan, options.ignore, quiet=asked.quiet)


def _check_together(negotiate: bool) -> None:
    """Refuse options that go only with --negotiate, or only without it."""
    context = click.get_current_context()
    wrong = _OF_A_PLAN if negotiate else _OF_A_NEGOTIATION
    for option in sorted(context.command.params, key=lambda option: str(option.name)):
        given = context.get_parameter_source(str(option.name)) is ParameterSource.COMMANDLINE
        if given and option.name in wrong:
            how = "without" if negotiate else "together with"
            raise ParameterError(f"{option.opts[-1]} given; expected it {how} --negotiate")


def _require_possible(localise: Localise, mission: Mission) -> None:
    """Refuse sensors before anything is planned."""
    from muster.running.localisation import require_possible, sensors_of

    require_possible(sensors_of(localise), mission)


def _looks(mission: Mission, world: str, found: Path | None, cameras: Path | None) -> CameraPictures | None:
    """What collects the pictures of cameras; None where no option asks for them."""
    if found is None and cameras is None:
        return None
    from muster.report.camera_pictures import CameraPictures

    option = "--found" if cameras is None else "--cameras"
    if not mission.tags:
        raise ParameterError(
            f"{option}: {mission.name} has no tags; expected a mission in which there is something to find"
        )
    if cameras is not None and world != "physics":
        raise ParameterError(f"--cameras: no pictures in the {world} world; expected --world physics")
    require_folder(cameras, "--cameras")
    return CameraPictures(cameras)


def _negotiation(mission: Mission, method: str, transport: str, options: PlanningOptions) -> Negotiation:
    """How robots agree; a mission on which they cannot is refused before any file is opened."""
    from muster import Negotiation
    from muster.allocation.allocator import make_parameters
    from muster.negotiation.capabilities import refuse_mission
    from muster.negotiation.methods import method_named

    chosen = method_named(method)
    refuse_mission(mission, chosen.can)
    terms = make_parameters(chosen.allocator, dict(options.parameters))
    return Negotiation(method=method, transport=transport, params=terms)


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
