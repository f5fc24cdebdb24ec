"""`muster explain --server`: found out there, said here."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

from muster.cli.explain import print_explained
from muster.cli.options import MissionFile, load_plan
from muster.cli.remote.uploads import kept_plan
from muster.planning.explaining.tables import Part, Table

if TYPE_CHECKING:
    from muster.client import Client


def run(
    control: Client,
    *,
    mission: MissionFile,
    plan: Path,
    task: str | None,
    ignore: tuple[str, ...],
    form: str,
    quiet: bool,
    verbose: bool,
) -> None:
    """Send the mission and the plan; print what comes back as it is printed here."""
    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    found = control.plans.explain(kept_plan(control, loaded, given, verbose=verbose).id, task, ignore)
    found.pop("words")
    print_explained(form, found, [_part(part) for part in found.pop("tables")])


def _part(said: str | dict[str, Any]) -> Part:
    return said if isinstance(said, str) else Table(**said)
