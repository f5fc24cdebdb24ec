"""`muster verify`: judge a plan from scratch."""

from __future__ import annotations

from pathlib import Path

import click

from muster.cli.backend import Backend, server_option
from muster.cli.exits import DONE, REJECTED
from muster.cli.options.common import (
    MissionFile,
    format_option,
    ignore_option,
    load_plan,
    mission_argument,
    objective_option,
    quiet_option,
)
from muster.mission.plan import json_text


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@objective_option
@ignore_option
@format_option
@quiet_option
@server_option()
def command(
    backend: Backend,
    mission: MissionFile,
    plan: Path,
    objective: str | None,
    ignore: tuple[str, ...],
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Recompute a PLAN of a MISSION from scratch, by code that no allocator uses.

    Exits with 1 if the plan is not admissible or a figure in it is wrong. All rules hold but those to --ignore,
    whatever the plan says of itself.
    """
    from muster.cli.tables.plan import print_verdict

    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    verdict = backend.verify(loaded, given, ignore, objective)
    if form == "json":
        click.echo(json_text(verdict.as_dict()), nl=False)
    else:
        print_verdict(given, verdict)
    return DONE if verdict.valid else REJECTED
