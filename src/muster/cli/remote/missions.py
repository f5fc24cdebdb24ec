"""`muster missions --server`: the missions of a server."""

from __future__ import annotations

from typing import TYPE_CHECKING

import click

from muster.cli.tables import print_table

if TYPE_CHECKING:
    from muster.client import Client


def run(control: Client, *, form: str, quiet: bool, verbose: bool) -> None:
    """List those that ship with Muster, and those that were made there."""
    entries = control.missions.list()
    if form == "json":
        import json
        from dataclasses import asdict

        click.echo(json.dumps([asdict(entry) for entry in entries], indent=1, default=lambda at: at.isoformat()))
        return
    rows = [
        (
            entry.id,
            str(entry.robots),
            str(entry.tasks),
            str(entry.version or "-"),
            "-" if entry.changed_at is None else f"{entry.changed_at:%Y-%m-%d %H:%M}",
            entry.name if entry.name != entry.id else "",
        )
        for entry in entries
    ]
    columns = ("mission", "robots", "tasks", "version", "changed (UTC)", "name")
    print_table(columns, rows, right=("robots", "tasks", "version"))
