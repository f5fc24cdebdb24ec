"""`muster verify --server`: judged there, shown here."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE, REJECTED
from muster.cli.options import MissionFile, load_plan
from muster.cli.plan_tables import print_verdict
from muster.cli.remote.uploads import kept_plan
from muster.mission.plan import json_text
from muster.verification import Verdict
from muster.verification.verdict import RouteFigures, Violation, Visit

if TYPE_CHECKING:
    from muster.client import Client

_NOT_OF_VERDICTS = ("valid", "ignored", "objective", "waiting_s", "lines", "violations", "routes")
_NOT_PRINTED = ("waiting_s", "lines", "routes")


def run(
    control: Client,
    *,
    mission: MissionFile,
    plan: Path,
    objective: str | None,
    ignore: tuple[str, ...],
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission and the plan, and show what the judge there says."""
    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    said = control.plans.verdict(kept_plan(control, loaded, given, verbose=verbose).id, ignore, objective)
    if form == "json":
        click.echo(json_text({key: value for key, value in said.items() if key not in _NOT_PRINTED}), nl=False)
    else:
        print_verdict(given, _verdict(said))
    return DONE if said["valid"] else REJECTED


def _verdict(said: Mapping[str, Any]) -> Verdict:
    """A verdict from plain data."""
    figures = {key: value for key, value in said.items() if key not in _NOT_OF_VERDICTS}
    return Verdict(
        violations=tuple(Violation(**violation) for violation in said["violations"]),
        ignored=tuple(said["ignored"]),
        routes=tuple(_route(route) for route in said["routes"]),
        **figures,
    )


def _route(said: Mapping[str, Any]) -> RouteFigures:
    visits = tuple(Visit(**visit) for visit in said["visits"])
    return RouteFigures(**{**said, "tasks": tuple(said["tasks"]), "visits": visits})
