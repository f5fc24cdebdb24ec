"""`muster missions`: the missions that come with Muster, or those of a server."""

from __future__ import annotations

import click

from muster.cli.backend import Backend, server_option
from muster.cli.options.common import format_option, quiet_option


@click.command()
@format_option
@quiet_option
@server_option()
def command(backend: Backend, form: str, quiet: bool, verbose: bool) -> None:
    """List the missions that come with Muster.

    Each can stand wherever a MISSION is asked for.
    """
    data, rows = backend.missions()
    if form == "json":
        import json

        click.echo(json.dumps(data, indent=1))
    else:
        from muster.cli.tables.table import print_table

        print_table(tuple(rows[0]), [tuple(row.values()) for row in rows], right=("robots", "tasks", "version"))
