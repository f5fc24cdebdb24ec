"""A mission shown while it is carried out: events on standard error, and a server for Foxglove."""

from __future__ import annotations

import socket
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any

import click

from muster.mission.errors import NetworkError
from muster.mission.model import Mission

if TYPE_CHECKING:
    from muster.execution import ExecutionEvent

foxglove_option = click.option(
    "--foxglove",
    type=click.IntRange(min=0, max=65535),
    metavar="PORT",
    help="Show it live to Foxglove on this computer (ws://127.0.0.1:PORT); 0: any free port.",
)


def require_free_port(port: int | None) -> None:
    """Refuse, before robots move, a port that cannot be used.

    Raises
    ------
    NetworkError
        if it is in use, or reserved.
    """
    if port is None:
        return
    try:
        socket.create_server(("127.0.0.1", port)).close()
    except OSError as error:
        raise NetworkError(
            f"--foxglove: 127.0.0.1:{port}: {error.strerror}; expected a free port of this computer"
        ) from None


@contextmanager
def shown_live(mission: Mission, port: int | None, *, quiet: bool) -> Iterator[Sequence[Any]]:
    """The observers that show the mission on a port: none without a port."""
    if port is None:
        yield ()
        return
    from muster.report.live import FoxgloveServer

    with FoxgloveServer(mission, port) as server:
        if not quiet:
            click.echo(f"foxglove: {server.address}", err=True)
        yield (server,)


def print_event(event: ExecutionEvent) -> None:
    """Print an event on standard error as it happens, unless it is for programs alone."""
    from muster.state.words import DETAIL

    if event.mark != DETAIL:
        print_event_line(event.time_s, event.line)


def print_event_line(time_s: float, line: str) -> None:
    """Print the line of an event on standard error, with its time."""
    click.echo(f"{time_s:9.1f} s  {line}", err=True)
