"""`muster explain`: why a task is done by this robot, not by another, or left out."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.backend import Backend, server_option
from muster.cli.options import MissionFile, format_option, ignore_option, mission_argument, quiet_option, say_of_plan
from muster.mission.plan import json_text
from muster.mission.reading.plan_reader import read_plan

if TYPE_CHECKING:
    from muster.planning.explaining.tables import Explanation


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option("--task", metavar="T", help="Only this task, which may also be one that is done.")
@ignore_option
@format_option
@click.option(
    "--time-limit",
    type=click.FloatRange(min=0),
    default=10.0,
    show_default=True,
    metavar="S",
    help="Seconds after which nothing more is looked for.",
)
@quiet_option
@server_option(time_limit="a server has its own limit")
def command(
    backend: Backend,
    mission: MissionFile,
    plan: Path,
    task: str | None,
    ignore: tuple[str, ...],
    form: str,
    time_limit: float,
    quiet: bool,
    verbose: bool,
) -> None:
    """Say why tasks are left out of a PLAN; with --task, why a task is done by this robot and not by another."""
    loaded = mission.load(verbose=verbose)
    given = read_plan(plan, loaded)
    found = backend.explain(loaded, given, task, ignore, str(plan), time_limit)
    say_of_plan(given, plan, loaded, ignore, quiet=quiet, verbose=verbose)
    _print(form, found)


def _print(form: str, found: Explanation) -> None:
    """The data for programs, or the lines and tables for people."""
    from muster.cli.tables import print_table

    if form == "json":
        click.echo(json_text(found.data), nl=False)
        return
    for part in found.parts:
        if isinstance(part, str):
            click.echo(part)
        else:
            print_table(part.columns, part.rows, title=part.title)
