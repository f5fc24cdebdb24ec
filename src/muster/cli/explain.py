"""`muster explain`: why this robot, why not that one, why left out."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options import MissionFile, format_option, ignore_option, mission_argument, quiet_option, say_of_plan
from muster.cli.remote.server_option import server_option
from muster.mission.plan import json_text, read_plan

if TYPE_CHECKING:
    from muster.planning.explaining.tables import Part


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--task", metavar="T", help="Only this task, which may also be one that is done.")
@ignore_option
@format_option
@quiet_option
@server_option
def command(
    mission: MissionFile,
    plan: Path,
    task: str | None,
    ignore: tuple[str, ...],
    form: str,
    quiet: bool,
    verbose: bool,
) -> None:
    """Say why tasks are left out of a PLAN; with --task, why a task is done by this robot and not by another."""
    from muster.planning.explaining import left_out, one_task, require_fit
    from muster.planning.explaining.tables import tables_on_left_out, tables_on_task

    loaded = mission.load(verbose=verbose)
    given = read_plan(plan)
    require_fit(loaded, given, str(plan), ignore)
    say_of_plan(given, plan, loaded, ignore, quiet=quiet, verbose=verbose)
    if task is None:
        missing = left_out(loaded, given, ignore)
        print_explained(form, missing.as_dict(), tables_on_left_out(missing))
    else:
        found = one_task(loaded, given, task, ignore)
        print_explained(form, found.as_dict(), tables_on_task(found))


def print_explained(form: str, data: Mapping[str, Any], parts: Iterable[Part]) -> None:
    """Print an explanation: its data for programs, its lines and tables for people."""
    from muster.cli.tables import print_table

    if form == "json":
        click.echo(json_text(data), nl=False)
        return
    for part in parts:
        if isinstance(part, str):
            click.echo(part)
        else:
            print_table(part.columns, part.rows, title=part.title)
