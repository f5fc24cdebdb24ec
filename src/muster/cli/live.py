"""A mission shown while it is carried out, to those who connect with Foxglove."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import Any

import click

from muster.mission.model import Mission

foxglove_option = click.option(
    "--foxglove",
    type=click.IntRange(min=0, max=65535),
    metavar="PORT",
    help="Show it live to Foxglove on this computer (ws://127.0.0.1:PORT); 0: any free port.",
)


@contextmanager
def shown_live(mission: Mission, port: int | None, *, quiet: bool) -> Iterator[Sequence[Any]]:
    """Who is to be told of the mission so that it is shown on a port; nobody where there is none."""
    if port is None:
        yield ()
        return
    from muster.report.live import FoxgloveServer

    with FoxgloveServer(mission, port) as server:
        if not quiet:
            click.echo(f"foxglove: {server.address}", err=True)
        yield (server,)
