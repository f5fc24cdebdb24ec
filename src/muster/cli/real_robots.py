"""What the verbs for real robots share: options, planning, carrying out, the report."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Sequence
from dataclasses import dataclass, fields
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

import click

from muster.cli.exit_codes import Ending, exit_code_if, note_ending
from muster.cli.live_output import foxglove_option, print_event, require_free_port, shown_live
from muster.cli.options import (
    Finite,
    Verb,
    accept_partial_option,
    format_option,
    load_plan,
    quiet_option,
    require_admissible,
    require_complete_option,
    traffic_option,
)
from muster.cli.outputs import require_drawable, require_writable
from muster.cli.planning_options import planning_options, request_of
from muster.cli.record_output import drawing_options, kept_record, record_option
from muster.cli.report_tables import print_report
from muster.cli.tables import sequence
from muster.mission.counting import counted
from muster.mission.errors import IncompletePlanError, MusterError
from muster.mission.model import Mission
from muster.mission.plan import Plan, json_text
from muster.planning.options import PlanningOptions
from muster.running.wall_time import STARTS, notes_on_start, planned_from, require_time_left
from muster.state.reasons import was_cancelled

if TYPE_CHECKING:
    from muster.bridges.final_state import FinalState
    from muster.bridges.fleet import Fleet
    from muster.execution import Recorder, Report
    from muster.running.wall_time import MissionStart

_FILE = click.Path(path_type=Path)


@dataclass(frozen=True, kw_only=True)
class RealRunOptions:
    """The values of `real_options`: everything but the mission and the options of the bridge."""

    plan: Path | None
    planning: PlanningOptions
    start: Path | None = None
    fixed: Path | None = None
    record: Path | None
    html: Path | None
    plot: Path | None
    gantt: Path | None
    starts: str = "given"
    accept_partial: bool = False
    traffic: str
    foxglove: int | None
    require_complete: bool
    form: str
    quiet: bool
    verbose: bool


def real_options(verb: Verb) -> Verb:
    """The options that the verb gets as `RealRunOptions`."""
    own = [field.name for field in fields(RealRunOptions) if field.name != "planning"]

    @wraps(verb)
    def with_options(*, options: PlanningOptions, **given: Any) -> Any:
        asked = RealRunOptions(planning=options, **{name: given.pop(name) for name in own})
        return verb(options=asked, **given)

    declared = (
        click.option("--plan", type=_FILE, metavar="PLAN", help="The plan.  [default: one that the allocator makes]"),
        planning_options(time_limit_s=2.0, carries_out=True),
        click.option(
            "--starts",
            type=click.Choice(STARTS),
            default="given",
            show_default=True,
            help="given: the mission starts at its starts_at; now: when robots are ready, with all its times shifted.",
        ),
        accept_partial_option,
        traffic_option,
        record_option,
        drawing_options,
        foxglove_option,
        require_complete_option,
        format_option,
        quiet_option,
    )
    decorated: Any = with_options
    for option in reversed(declared):
        decorated = option(decorated)
    return cast("Verb", decorated)


def _namespace(_: click.Context, __: click.Parameter, value: str) -> str:
    """Checks a namespace of ROS: names with slashes between them."""
    if value.strip("/") and not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*(/[A-Za-z][A-Za-z0-9_]*)*", value.strip("/")):
        raise click.BadParameter(f"{value!r}; expected names such as team or lab/team: letters, digits, _")
    return value


def ros_options(verb: Verb) -> Verb:
    """Where robots on ROS are looked for: --namespace, --wait, --known-only."""
    options = (
        click.option(
            "--namespace",
            callback=_namespace,
            default="",
            metavar="NAME",
            help="Namespace that holds those of the robots.  [default: the root]",
        ),
        click.option(
            "--wait",
            "wait_s",
            type=Finite(0.0, 1e6),
            default=10.0,
            show_default=True,
            metavar="S",
            help="Seconds to wait for the mission's robots.",
        ),
        click.option("--known-only", is_flag=True, help="Robots that the mission does not name do not join."),
    )
    for option in reversed(options):
        verb = option(verb)
    return verb


def require_outputs(options: RealRunOptions, inputs: tuple[str | Path | None, ...]) -> None:
    """Refuse, before robots move, files that cannot be written or would replace one that is read."""
    files = (options.record, options.html, options.plot, options.gantt)
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
    plan.require_whole(accept_partial=options.accept_partial)
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

    start = start_of(mission, fleet, options.starts)
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


def carried_out(
    mission: Mission,
    plan: Plan,
    fleet: Fleet,
    options: RealRunOptions,
    halt: threading.Event,
    observers: Sequence[Recorder] = (),
    at_end: Callable[[], None] = lambda: None,
) -> Report:
    """Carry a plan out; its events are printed, recorded and shown as the options say.

    Parameters
    ----------
    at_end
        gives robots their last orders when the plan is done, before pictures are drawn.
    """
    from muster import carry_out

    report = None
    try:
        kept = kept_record(options.record, options.html, options.plot, options.gantt)
        with kept as file, shown_live(mission, options.foxglove, quiet=options.quiet) as viewers:
            report = carry_out(
                mission,
                plan,
                fleet,
                seed=options.planning.seed,
                accept_partial=True,  # or the verb has refused the plan
                planning=options.planning,
                ignore=options.planning.ignore,
                traffic=options.traffic,
                starts=options.starts,
                record=file,
                observers=(*observers, *viewers),
                on_event=None if options.quiet else print_event,
                halt=halt,
            )
            at_end()
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
    lost = [task for task, reason in report.tasks_lost if not was_cancelled(reason)]
    if lost and not halt.is_set():
        click.echo(f"{counted(len(lost), 'task')} lost: {sequence(lost)}", err=True)
    show_final_states(final_states, asks=halt.is_set() or bool(lost))
    return exit_code_if(
        (Ending.STILL_MOVING, any(state.moving for state in final_states)),
        (Ending.INTERRUPTED, halt.is_set()),
        (Ending.TASKS_LOST, lost),
    )


def show_final_states(states: Sequence[FinalState], *, asks: bool) -> None:
    """Print a line for each robot; it concerns safety, so `--quiet` does not silence it.

    Where the mission did not end as planned (`asks`), a line before them says what to do with robots that still move.
    """
    if asks and (moving := [state.robot for state in states if state.moving]):
        todo = "land or stop them by their own controls or a ground station, and disarm them"
        click.echo(f"still flying, driving or armed: {', '.join(moving)}; {todo}", err=True)
    for state in states:
        click.echo(str(state), err=True)


class LastLines:
    """Context manager that prints where robots are if an exception ends it: a refusal, an error, Ctrl-C, a signal.

    Before robots were commanded, only those are printed that fly, drive or are armed all the same; afterwards all. The
    exit code of the command is 4 if any does.

    Attributes
    ----------
    begun : bool
        Whether robots were commanded.
    """

    def __init__(self, final_states: Callable[[], Sequence[FinalState]], *, begun: bool = False) -> None:
        self._final_states, self.begun = final_states, begun

    def __enter__(self) -> LastLines:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, trace: object) -> None:
        if kind is not None:
            self.tell()

    def tell(self) -> None:
        """Print where robots are, and note for the exit code whether any moves."""
        try:
            states = self._final_states()
        except MusterError as unknown:
            click.echo(f"warning: where robots are is not known: {unknown}", err=True)
            return
        moving = [state for state in states if state.moving]
        show_final_states(states if self.begun else moving, asks=True)
        if moving:
            note_ending(Ending.STILL_MOVING)
