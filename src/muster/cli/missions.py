"""`muster missions`: what comes with Muster."""

from __future__ import annotations

import click

from muster.cli.options import format_option, quiet_option
from muster.cli.remote.server_option import server_option


@click.command()
@format_option
@quiet_option
@server_option
def command(form: str, quiet: bool, verbose: bool) -> None:
    """List the missions that come with Muster.

    Each can stand wherever a MISSION is asked for.
    """
    from muster.cli.tables import print_table
    from muster.library import mission_names, mission_path, mission_summary

    summaries = [mission_summary(name) for name in mission_names()]
    if verbose:
        folders = sorted({str(path.parent) for name in mission_names() if (path := mission_path(name))})
        click.echo(f"{len(summaries)} missions in {', '.join(folders)}", err=True)
    if form == "json":
        import json
        from dataclasses import asdict

        click.echo(json.dumps([asdict(summary) for summary in summaries], indent=1))
        return
    rows = [(s.name, "-" if s.robots is None else str(s.robots), str(s.tasks), s.description) for s in summaries]
    print_table(("mission", "robots", "tasks", "what it is"), rows, right=("robots", "tasks"))
