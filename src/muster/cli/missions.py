"""`muster missions`: the missions that come with Muster, or those of a server."""

from __future__ import annotations

from dataclasses import asdict
from typing import TYPE_CHECKING

import click

from muster.cli.backend import Backend, server_option
from muster.cli.options import format_option, quiet_option
from muster.server.contract import MissionEntry

if TYPE_CHECKING:
    from muster.library import MissionSummary


@click.command()
@format_option
@quiet_option
@server_option()
def command(backend: Backend, form: str, quiet: bool, verbose: bool) -> None:
    """List the missions that come with Muster.

    Each can stand wherever a MISSION is asked for.
    """
    from muster.cli.tables import print_table

    entries = backend.missions()
    if form == "json":
        import json

        click.echo(json.dumps([asdict(entry) for entry in entries], indent=1, default=lambda at: at.isoformat()))
    elif any(isinstance(entry, MissionEntry) for entry in entries):
        columns = ("mission", "robots", "tasks", "version", "changed (UTC)", "name")
        rows = [_row_at_server(entry) for entry in entries if isinstance(entry, MissionEntry)]
        print_table(columns, rows, right=("robots", "tasks", "version"))
    else:
        rows = [_row(entry) for entry in entries if not isinstance(entry, MissionEntry)]
        print_table(("mission", "robots", "tasks", "what it is"), rows, right=("robots", "tasks"))


def _row(entry: MissionSummary) -> tuple[str, ...]:
    return entry.name, "-" if entry.robots is None else str(entry.robots), str(entry.tasks), entry.description


def _row_at_server(entry: MissionEntry) -> tuple[str, ...]:
    changed = "-" if entry.changed_at is None else f"{entry.changed_at:%Y-%m-%d %H:%M}"
    name = entry.name if entry.name != entry.id else ""
    return entry.id, str(entry.robots), str(entry.tasks), str(entry.version or "-"), changed, name
