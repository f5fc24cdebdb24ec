"""`muster check --server`: tasks that can never be done, found there, told here."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.check import answer, print_checked
from muster.cli.exits import BAD_INPUT, DONE, INCOMPLETE
from muster.cli.options import load_mission
from muster.cli.remote.sending import parcel
from muster.mission.errors import Finding, MissionError
from muster.mission.plan import Reason, Unassigned, json_text

if TYPE_CHECKING:
    from muster.server.client import Client

_NOT_LOOKED_INTO = "whether all others can be done in one plan is not looked into there; without --server it is"


def run(
    control: Client,
    *,
    mission: str,
    robots: Path | None,
    suitability: Path | None,
    salesmen: int | None,
    depot: str | None,
    form: str,
    require_complete: bool,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission, and tell what is wrong with it."""
    try:
        loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
        found = control.missions.check(*parcel(loaded))
        if found["errors"]:
            raise MissionError([Finding(**error) for error in found["errors"]])
    except MissionError as error:
        if form == "json":
            click.echo(json_text(answer(errors=[f.as_dict() for f in error.findings])), nl=False)
        else:
            click.echo(str(error), err=True)
        return BAD_INPUT
    lost = tuple(
        Unassigned(item["task"], tuple(Reason(**reason) for reason in item["reasons"])) for item in found["impossible"]
    )
    if form == "json":
        click.echo(json_text(answer(impossible=found["impossible"], unknown=True)), nl=False)
    else:
        print_checked(loaded, lost)
    if not quiet:
        click.echo(_NOT_LOOKED_INTO, err=True)
    return INCOMPLETE if lost and require_complete else DONE
