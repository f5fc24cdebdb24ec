"""What the verbs for real robots share: options, planning, carrying out, the report."""

from __future__ import annotations

import threading
from collections.abc import Callable, Mapping, Sequence
from dataclasses import fields, replace
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.exits import INTERRUPTED
from muster.cli.live_output import foxglove_option, print_event, require_free_port, shown_live
from muster.cli.options.common import (
    Verb,
    format_option,
    load_plan,
    quiet_option,
    require_admissible,
    require_complete_option,
)
from muster.cli.options.planning import planning_options, request_of
from muster.cli.options.request import request_options, settings_from
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.record_output import drawing_options, kept_record, map_outputs, record_option, save_map_option
from muster.cli.tables.report import print_report
from muster.cli.tables.table import sequence
from muster.mission.errors import IncompletePlanError, MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster.mission.records import Settings
from muster.mission.texts.counting import counted
from muster.planning.options import PlanningOptions
from muster.running.fleet_registry import FLEETS, settings_class
from muster.running.observed_run import ObservedRun
from muster.running.run_request import REAL, RunRequest
from muster.running.wall_time import notes_on_start, planned_from, require_time_left
from muster.state.reasons import is_no_loss
from muster_robots.cli.going_on import GoingOn, kept_journal, recovered, resume_option
from muster_robots.cli.last_lines import LastLines, show_final_states
from muster_robots.cli.run_options import RealRunOptions

if TYPE_CHECKING:
    from muster.execution import Recorder, Report
    from muster.execution.final_state import FinalState
    from muster.execution.fleet import Fleet
    from muster.running.wall_time import MissionStart

_FILE = click.Path(path_type=Path)


def real_options(
    fleet: str = "", settings: type[Settings] | None = None, without: Sequence[str] = ()
) -> Callable[[Verb], Verb]:
    """The options that the verb gets as `RealRunOptions`.

    Parameters
    ----------
    fleet
        the fleet that carries missions out; empty where the options --fleet and --setting name it and its settings.
    settings
        what the fleet declares: each of its fields is an option.
    without
        fields of the request that have no option.
    """
    own = [field.name for field in fields(RealRunOptions) if field.name not in ("planning", "request")]
    declared = (
        click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that the allocator makes]"),
        planning_options(time_limit_s=2.0, carries_out=True),
        request_options(RunRequest, REAL, without),
        *(() if settings is None else (request_options(settings),)),
        resume_option,
        record_option,
        drawing_options,
        *(() if "unknown" in without else (save_map_option,)),
        foxglove_option,
        require_complete_option,
        format_option,
        quiet_option,
    )

    def decorate(verb: Verb) -> Verb:
        @wraps(verb)
        def with_options(*, options: PlanningOptions, how: Mapping[str, Any], **given: Any) -> Any:
            name, texts = given.pop("fleet", fleet), given.pop("setting", ())
            rules = {"seed": options.seed, "ignore": options.ignore, "planning": options}
            request = replace(_request(name, {**how, **rules}, texts), save_map=given.pop("save_map", None))
            asked = {name: given.pop(name) for name in own}
            return verb(options=RealRunOptions(request=request, planning=options, **asked), **given)

        decorated: Any = with_options
        for option in reversed(declared):
            decorated = option(decorated)
        return cast("Verb", decorated)

    return decorate


def _request(fleet: str, how: Mapping[str, Any], texts: Sequence[str]) -> ObservedRun:
    """The request of a run with a fleet, whose settings stand beside the others, or are texts KEY=VALUE."""
    FLEETS.named(fleet)
    if not texts:
        return ObservedRun.from_settings(fleet, how)
    return ObservedRun(world=fleet, settings=settings_from(settings_class(fleet), texts), **how)


def require_outputs(options: RealRunOptions, inputs: tuple[str | Path | None, ...]) -> None:
    """Refuse, before robots move, files that cannot be written or would replace one that is read."""
    files = (options.record, options.html, options.plot, options.gantt, *map_outputs(options.request.save_map))
    require_writable(None, files, inputs, (options.plan, options.start, options.fixed))
    require_drawable(options.plot, options.gantt)
    require_free_port(options.foxglove)


def read_given_plan(options: RealRunOptions, mission: Mission) -> Plan | None:
    """The plan of --plan, read before robots are searched for; None without --plan.

    Raises
    ------
    PlanError
        if the file is no plan, or the plan breaks a rule of the mission.
    """
    if options.plan is None:
        return None
    ignore = options.planning.ignore
    plan = load_plan(options.plan, mission, ignore, quiet=options.quiet, verbose=options.verbose)
    require_admissible(mission, plan, options.plan, ignore)
    return require_whole(plan, options)


def planned(options: RealRunOptions, mission: Mission, start: MissionStart) -> Plan:
    """A plan made now, as the options say; no robot is available before.

    Raises
    ------
    IncompletePlanError
        if planning was cut short, and that is not accepted, or a task is left out with --require-complete.
    """
    from muster.planning.solving import answer

    there = planned_from(mission, start.seconds())
    return require_whole(answer(request_of(options.planning, there, options.start, options.fixed)).plan, options)


def require_whole(plan: Plan, options: RealRunOptions) -> Plan:
    """Return a plan; raise `IncompletePlanError` if it was cut short or is not complete, and that is not accepted."""
    plan.require_whole(accept_partial=options.request.accept_partial)
    if options.require_complete and not plan.complete:
        raise IncompletePlanError(f"{plan.planned_line}; nothing was started; expected all (--require-complete)")
    return plan


def start_in_time(mission: Mission, fleet: Fleet, options: RealRunOptions) -> MissionStart:
    """Return when the mission starts, and print what that means for it.

    Raises
    ------
    ParameterError
        if the mission's time is over.
    """
    from muster.running.fleet_clock import start_of

    start = start_of(mission, fleet, options.request.starts)
    require_time_left(mission, start.seconds())
    for line in notes_on_start(mission, start.seconds()):
        click.echo(line, err=True)
    return start


def from_here(mission: Mission, fleet: Fleet) -> Mission:
    """The mission with robots at their measured positions; robots that the mission has elsewhere are printed."""
    from muster.running.live import elsewhere, with_reported_starts

    there = with_reported_starts(mission, fleet)
    for line in elsewhere(mission, there):
        click.echo(line, err=True)
    return there


def carried_out_from_here(
    fleet: Fleet,
    given: Plan | None,
    how: GoingOn,
    options: RealRunOptions,
    halt: threading.Event,
    at_end: Callable[[], None] = lambda: None,
) -> int:
    """Carry a mission out with robots that are ready, from where they stand; returns the exit code.

    Parameters
    ----------
    given
        the plan; None: one is made now.
    how
        the mission, and how this call relates to a run before it.
    at_end
        see `carried_out`.
    """
    from muster.execution.final_state import final_states_of

    mission = there = how.mission

    def states() -> Sequence[FinalState]:
        return how.judged(final_states_of(fleet, there))

    if how.recovers and not halt.is_set():
        return recovered(how, fleet, options, halt, at_end)
    if how.interrupted is not None:
        with LastLines(states):
            how.require_nobody_left(states())
    if not how.resumes and not halt.is_set():
        start = start_in_time(mission, fleet, options)
        there = from_here(mission, fleet)
        given = given or planned(options, there, start)
    if halt.is_set():
        click.echo("interrupted; nothing was sent", err=True)
        return INTERRUPTED
    with LastLines(states, begun=True):
        report = carried_out(there, given, fleet, how, options, halt, states, at_end=at_end)
        left = "the robots were told to stay where they are"
        return reported(there, report, options, halt, left, states())


def carried_out(
    mission: Mission,
    plan: Plan | None,
    fleet: Fleet,
    how: GoingOn,
    options: RealRunOptions,
    halt: threading.Event,
    final_states: Callable[[], Sequence[FinalState]],
    observers: Sequence[Recorder] = (),
    at_end: Callable[[], None] = lambda: None,
) -> Report:
    """Carry a plan out, or go on with a run; its events are printed, recorded and shown as the options say.

    Parameters
    ----------
    plan
        the plan of a run that begins; one that goes on has that of its journal.
    how
        how this call relates to a run before it.
    final_states
        gives the state of each robot.
    at_end
        gives robots their last orders when the plan is done, before pictures are drawn.
    """
    from muster.running.carry_out import carried_out as carry_out

    report = None
    resumed = how.before.plan if how.before is not None and how.resumes else None
    plan = resumed or replace(plan or Plan(routes=()), ignored=options.request.ignore)
    try:
        kept = kept_record(options.record, options.html, options.plot, options.gantt)
        with (
            kept as file,
            shown_live(mission, options.foxglove, quiet=options.quiet) as viewers,
            kept_journal(how, plan, options) as journal,
        ):
            request = replace(
                options.request,
                accept_partial=True,  # or the verb has refused the plan
                ignore=plan.ignored,
                journal=journal,
                record=file,
                observers=(*observers, *viewers),
                on_event=None if options.quiet else print_event,
                halt=halt,
            )
            report = carry_out(mission, plan, fleet, request)
            at_end()
            journal.end(final_states())
    except (OSError, MusterError) as error:
        if report is None:
            raise
        click.echo(f"warning: {error}", err=True)  # what is drawn counts less than the report
    return report


def reported(
    mission: Mission,
    report: Report,
    options: RealRunOptions,
    halt: threading.Event,
    left: str,
    final_states: Sequence[FinalState],
) -> int:
    """Print the report and the final state of each robot; returns the exit code.

    Parameters
    ----------
    left
        what robots do after an interruption: "the robots were told to stand".
    """
    figures: dict[str, Any] = report.as_dict()
    if options.form == "json":
        click.echo(json_text(figures), nl=False)
    else:
        print_report(figures, mission, with_tasks=options.verbose)
    if halt.is_set():
        click.echo(f"interrupted at {report.mission_time_s:.1f} s of the mission; {left}", err=True)
    lost = [task for task, reason in report.tasks_lost if not is_no_loss(reason)]
    if lost and not halt.is_set():
        click.echo(f"{counted(len(lost), 'task')} lost: {sequence(lost)}", err=True)
    show_final_states(final_states, asks=halt.is_set() or bool(lost))
    return exit_code_if(
        (Ending.STILL_MOVING, any(state.moving for state in final_states)),
        (Ending.INTERRUPTED, halt.is_set()),
        (Ending.TASKS_LOST, lost or any(state.crashed for state in final_states)),
    )
