"""`muster explain --server`: found out there, said here."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.options import load_mission, load_plan
from muster.cli.remote.sending import kept_plan
from muster.mission.plan import json_text

if TYPE_CHECKING:
    from muster.server.client import Client


def run(
    control: Client,
    *,
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
    """Send the mission and the plan; print the same JSON, or for people the server's sentences in place of tables."""
    loaded = load_mission(mission, robots, suitability, salesmen, depot, verbose=verbose)
    given = load_plan(plan, loaded, quiet=quiet, verbose=verbose)
    found = control.plans.explain(kept_plan(control, loaded, given, verbose=verbose).id, task)
    sentences = found.pop("words")
    if form == "json":
        click.echo(json_text(found), nl=False)
        return
    for sentence in sentences:
        click.echo(sentence)
