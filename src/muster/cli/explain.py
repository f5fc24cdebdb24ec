"""`muster explain`: why this robot, why not that one, why left out."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.options import format_option, load_mission, mission_argument, quiet_option, say_of_plan
from muster.cli.remote.option import server_option
from muster.mission.plan import json_text, read_plan

if TYPE_CHECKING:
    from muster._explaining import LeftOut, OneTask
    from muster.allocation.problem import Problem
    from muster.allocation.remedy import Remedy


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--task", metavar="T", help="Only this task, which may also be one that is done.")
@format_option
@quiet_option
@server_option
def command(
    mission: str,
    plan: Path,
    task: str | None,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    form: str,
    quiet: bool,
    verbose: bool,
) -> None:
    """Say why tasks are left out of a PLAN; with --task, why a task is done by this robot and not by another."""
    from muster._explaining import LeftOut, left_out, one_task, require_fit

    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    given = read_plan(plan)
    require_fit(loaded, given, str(plan))
    say_of_plan(given, plan, loaded, quiet=quiet, verbose=verbose)
    found = left_out(loaded, given) if task is None else one_task(loaded, given, task)
    if form == "json":
        click.echo(json_text(found.as_dict()), nl=False)
    elif isinstance(found, LeftOut):
        _print_left_out(found)
    else:
        _print_one_task(found)


def _print_left_out(found: LeftOut) -> None:
    from muster.cli.tables import counted, print_table

    left_out, changes = found.unassigned, found.changes
    if not left_out:
        click.echo("no task is left out; --task T explains a task that is done")
        return
    rows = [(item.task, r.robot, r.reason, r.detail) for item in left_out for r in item.reasons]
    print_table(("task", "robot", "reason", "detail"), rows, title=f"{counted(len(left_out), 'task')} left out")
    _print_smallest(found.problem, changes)
    if len(left_out) > len(changes):
        click.echo(f"and {len(left_out) - len(changes)} more: --task T looks for the changes for one task")


def _print_one_task(found: OneTask) -> None:
    from muster._explaining.phrases import award_text, place

    for line in place(found):
        click.echo(line)
    if found.plan.book is not None and found.award is not None:
        click.echo(award_text(found.problem, found.plan.book, found.award))
    _print_alternatives(found)
    _print_remedies(found)


def _print_alternatives(found: OneTask) -> None:
    from muster._explaining.phrases import what_then
    from muster.cli.tables import print_table

    rows = []
    for other in found.alternatives:
        robot = other.robot + ("  (now)" if other.robot == found.robot else "")
        if other.reason is not None:
            rows.append((robot, "no", f"{other.reason.reason}: {other.reason.detail}"))
        else:
            rows.append((robot, "yes", what_then(found, other)))
    print_table(("robot", "could", "why, and what then"), rows, title="each robot, the rest of the plan as it is")


def _print_smallest(problem: Problem, changes: Mapping[str, Remedy | None]) -> None:
    from muster._explaining.phrases import short
    from muster.cli.tables import print_table

    rows = [
        (
            (task, "-", "none was found; --task T looks further")
            if remedy is None
            else (task, remedy.robot, short(problem, remedy))
        )
        for task, remedy in changes.items()
    ]
    print_table(("task", "robot", "change"), rows, title="smallest changes, the rest as it is")


def _print_remedies(found: OneTask) -> None:
    from muster._explaining.phrases import lines, reserve, smallest_change
    from muster.cli.tables import print_table

    problem = found.problem
    rows = [
        (r.robot + ("  (now)" if r.robot == found.robot else ""), "\n".join(lines(problem, r))) for r in found.remedies
    ]
    print_table(("robot", "would need"), rows, title=f"to do {found.task} beside all else that the plan does")
    if found.robot is None and (change := smallest_change(problem, found.remedies)):
        click.echo(change)
    if note := reserve(problem):
        click.echo(note)
