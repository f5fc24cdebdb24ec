"""`muster check`: what is wrong with a mission, and which tasks can never be done, alone or together."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import click

from muster.cli.backend import Backend, server_option
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.exits import BAD_INPUT
from muster.cli.options.common import (
    MissionFile,
    format_option,
    ignore_option,
    mission_argument,
    quiet_option,
    require_complete_option,
)
from muster.cli.tables.table import sequence
from muster.mission.errors import Finding, MissionError, NotSupportedError
from muster.mission.ignorable_rules import ignored_rules
from muster.mission.model import Mission, Robot
from muster.mission.plan import json_text
from muster.mission.texts.counting import counted

if TYPE_CHECKING:
    from collections.abc import Collection, Sequence

    from muster.allocation.remedies.conflicts import Together
    from muster.mission.plan import Unassigned
    from muster.motion.actions.unseen_places import Unseen
    from muster.planning.explaining import Possible
    from muster.planning.explaining.crossings import BlockedWay
    from muster.planning.mission_readers import Noted

_MINIMAL = "without any one of them a plan was found that does the others"
_NOT_MINIMAL = "some of them may already be too many: not without each of them a plan for the others was found"


@click.command()
@mission_argument
@ignore_option
@format_option
@require_complete_option
@click.option(
    "--time-limit",
    type=click.FloatRange(min=0),
    default=2.0,
    show_default=True,
    metavar="S",
    help="Seconds after which it is not looked at any more whether one plan can do all tasks.",
)
@quiet_option
@server_option()
def command(
    backend: Backend,
    mission: MissionFile,
    ignore: tuple[str, ...],
    form: str,
    require_complete: bool,
    time_limit: float,
    quiet: bool,
    verbose: bool,
) -> int:
    """Find what is wrong with a MISSION, and name every task that can never be done and why.

    Where no plan can do all the others, name a smallest set of tasks of which one must be left out.
    """
    try:
        noted = mission.load_noted(verbose=verbose)
        found = backend.check(noted.mission, ignore, time_limit)
    except (MissionError, NotSupportedError) as error:
        return _refused(form, error)
    return _checked(form, noted, found, ignore, require_complete=require_complete)


def _refused(form: str, error: MissionError | NotSupportedError) -> int:
    """Print what is wrong with a mission; returns the exit code."""
    from muster.planning.explaining import Possible

    if form == "json":
        errors = [finding.as_dict() for finding in error.findings]
        click.echo(json_text({"errors": errors, **Possible().as_dict()}), nl=False)
    else:
        click.echo(str(error), err=True)
    return BAD_INPUT


def _checked(form: str, noted: Noted, found: Possible, ignore: Collection[str], *, require_complete: bool) -> int:
    """Print which tasks can be done; returns the exit code."""
    from muster.planning.explaining import unseen_findings

    mission, lost, all_others = noted.mission, found.impossible, found.together
    errors = unseen_findings(mission, found.unseen)
    if form == "json":
        told = {"errors": [error.as_dict() for error in errors], **found.as_dict()}
        told |= {"ledger": noted.ledger.as_dict()} if noted.ledger.rows else {}
        click.echo(json_text(told), nl=False)
    else:
        _print_checked(mission, found, len(errors))
        _print_never_used(mission, ignored_rules(ignore))
        _print_touching(mission)
        for one in found.cut_off:
            click.echo(f"warning: station {one.station}: no robot gets there: {one.detail}", err=True)
        _print_unseen(found.unseen, errors)
        _print_blocked(found.blocked)
        if len(lost) < len(mission.tasks):
            _print_together(all_others, "all other tasks" if lost else "all tasks")
    incomplete = lost or all_others.proven or found.blocked
    return exit_code_if(
        (Ending.REFUSED, errors),
        (Ending.IMPOSSIBLE, _for_ever(mission, lost)),
        (Ending.LEFT_OUT, incomplete and require_complete),
    )


def _for_ever(mission: Mission, lost: Sequence[Unassigned]) -> list[Unassigned]:
    """Return the tasks that stay impossible whatever doors events open."""
    if not any(event.door_opens for event in mission.events):
        return list(lost)
    return [item for item in lost if all(reason.reason != "unreachable" for reason in item.reasons)]


def _print_checked(mission: Mission, found: Possible, errors: int) -> None:
    from muster.cli.tables.impossible import print_impossible
    from muster.planning.explaining.phrases import shortfall_lines

    lost = found.impossible
    robots, tasks = counted(len(mission.robots), "robot"), counted(len(mission.tasks), "task")
    stations = f", {counted(len(mission.stations), 'station')}" if mission.stations else ""
    wrong = [counted(errors, "error")] if errors else []
    wrong += [f"{len(lost)} of {counted(len(mission.tasks), 'task')} can never be done"] if lost else []
    click.echo(f"{mission.name}: {robots}, {tasks}{stations}; {', '.join(wrong) or 'no errors'}")
    for line in shortfall_lines(found.together.shortfalls, found.together.remedies):
        click.echo(line)
    if lost:
        print_impossible(lost)
        if opened := sorted({event.door_opens for event in mission.events if event.door_opens}):
            click.echo(f"with doors as they are at first; events open {', '.join(opened)}")


def _print_blocked(blocked: tuple[BlockedWay, ...]) -> None:
    """Print what traffic cannot get done."""
    from muster.cli.tables.table import print_table

    if blocked:
        rows = [(way.task or "-", ", ".join(way.robots), way.detail) for way in blocked]
        print_table(("task", "robots", "detail"), rows, title="No traffic can get these done (proven on the roadmap)")


def _print_unseen(unseen: tuple[Unseen, ...], errors: Sequence[Finding]) -> None:
    """Print on standard error the searches that no robot sees all of, and those that some robots do not."""
    for error in errors:
        click.echo(str(error), err=True)
    for one in unseen:
        if not one.never_seen:
            click.echo(f"warning: task {one.task}: {one.detail}", err=True)


def _print_never_used(mission: Mission, ignored: Collection[str]) -> None:
    """Print on standard error the robots that a rule keeps from doing anything."""
    from muster.model.rules import all_rules

    for rule in all_rules():
        for robot in mission.robots if rule.word not in ignored else ():
            if (why := rule.never_used(mission, robot)) is not None:
                click.echo(f"warning: robot {robot.id}: {why}: it does none", err=True)


def _print_touching(mission: Mission) -> None:
    """Print on standard error that robots of one kind touch where they start."""
    touching = _touching(mission.robots)
    if touching:
        (a, b), more = touching[0], len(touching) - 1
        where = f"start {math.dist(a.position, b.position):g} m apart, and touch below {a.radius_m + b.radius_m:g} m"
        others = f"; so do {counted(more, 'more pair')}" if more else ""
        click.echo(f"warning: robots {a.id} and {b.id} {where}{others}", err=True)


def _touching(robots: Sequence[Robot]) -> list[tuple[Robot, Robot]]:
    """The pairs of robots of one kind that touch where they start, in mission order; found along the first axis."""
    along = sorted(range(len(robots)), key=lambda k: robots[k].position[0])
    widest = 2 * max(robot.radius_m for robot in robots)
    found = []
    for at, k in enumerate(along):
        for other in along[at + 1 :]:
            a, b = (robots[n] for n in sorted((k, other)))
            if abs(b.position[0] - a.position[0]) >= widest:
                break
            if a.kind == b.kind and math.dist(a.position, b.position) < a.radius_m + b.radius_m:
                found.append(tuple(sorted((k, other))))
    return [(robots[a], robots[b]) for a, b in sorted(found)]


def _print_together(found: Together, tasks: str) -> None:
    if found.unknown:
        click.echo(f"no plan for {tasks} was found; none was proven impossible")
        return
    if found.conflict is None and found.shortfalls:
        click.echo(f"no plan can do {tasks} (proven): there is too much work")
        return
    if found.conflict is None:
        click.echo(f"a plan for {tasks} was found")
        return
    conflict = found.conflict
    names = sequence(conflict.tasks)
    before = f", with {sequence(conflict.prerequisites)} before" if conflict.prerequisites else ""
    if len(conflict.tasks) == 1:
        click.echo(f"no plan can do task {names}{before} (proven)")
    else:
        click.echo(f"no plan can do all of these {len(conflict.tasks)} tasks (proven): {names}{before}")
    click.echo(f"  {conflict.detail}")
    if len(conflict.tasks) > 1:
        click.echo(f"  {_MINIMAL if conflict.minimal else _NOT_MINIMAL}")
