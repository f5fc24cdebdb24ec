"""`muster check`: what is wrong with a mission, and which tasks can never be done."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import click

from muster.cli.exits import BAD_INPUT, DONE, INCOMPLETE
from muster.cli.options import (
    format_option,
    ignore_option,
    load_mission,
    mission_argument,
    quiet_option,
    require_complete_option,
)
from muster.mission.errors import MissionError, NotSupportedError
from muster.mission.model import Mission
from muster.mission.plan import Unassigned, json_text


@click.command()
@mission_argument
@ignore_option
@format_option
@require_complete_option
@quiet_option
def command(
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    ignore: tuple[str, ...],
    form: str,
    require_complete: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Find what is wrong with a MISSION, and name every task that can never be done and why."""
    from muster.allocation.feasibility import impossible
    from muster.allocation.problem import Problem

    try:
        loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
        lost = impossible(Problem.compile(loaded, ignored=ignore))
    except (MissionError, NotSupportedError) as error:
        if form == "json":
            click.echo(json_text({"errors": [f.as_dict() for f in error.findings], "impossible": []}), nl=False)
        else:
            click.echo(str(error), err=True)
        return BAD_INPUT
    if form == "json":
        click.echo(json_text({"errors": [], "impossible": [_plain(item) for item in lost]}), nl=False)
    else:
        _print(loaded, lost)
    return INCOMPLETE if lost and require_complete else DONE


def _plain(item: Unassigned) -> dict[str, Any]:
    from dataclasses import asdict

    return asdict(item)


def _print(mission: Mission, lost: tuple[Unassigned, ...]) -> None:
    from muster.cli.tables import print_table

    robots, tasks = len(mission.robots), len(mission.tasks)
    click.echo(f"{mission.name}: {robots} robots, {tasks} tasks; no errors")
    if lost:
        rows = [(item.task, r.robot, r.reason, r.detail) for item in lost for r in item.reasons]
        print_table(("task", "robot", "reason", "detail"), rows, title=f"{len(lost)} tasks that can never be done")
