"""`--server` and `--token-file`, and the one place that decides whether a verb is done here or there."""

from __future__ import annotations

import importlib
import os
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from functools import wraps
from inspect import signature
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click
from click.core import ParameterSource

from muster.cli.options import MISSION_FLAGS
from muster.mission.errors import ParameterError

if TYPE_CHECKING:
    from muster.client import Client

Verb = Callable[..., Any]
TOKEN_VARIABLE = "MUSTER_TOKEN"  # noqa: S105 - a name
_LONGEST_TOKEN = 1000


def server_option(verb: Verb) -> Verb:
    """Let a verb be done by a server where one is named, by the `run` of the file here that is called as the verb's.

    What `run` takes beside a Client are parameters of the verb; others are refused where they are given.
    """

    @wraps(verb)
    def here_or_there(*, server: str | None, token_file: Path | None, **given: Any) -> Any:
        if server is None:
            _require(token_file is None, "--token-file given; expected it together with --server")
            return verb(**given)
        there = importlib.import_module(f"muster.cli.remote.{verb.__module__.rpartition('.')[2]}")
        _, *takes = signature(there.run).parameters
        _refuse_all_but(takes)
        with _connected(server, token_file) as control:
            return there.run(control, **{name: given[name] for name in takes})

    options = (
        click.option("--server", metavar="URL", help="Let mission control do it: http://HOST:8117 (muster serve)."),
        click.option(
            "--token-file",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help=f"Holds the server's token.  [default: the variable {TOKEN_VARIABLE}]",
        ),
    )
    decorated: Verb = here_or_there
    for option in reversed(options):
        decorated = option(decorated)
    return decorated


@contextmanager
def _connected(server: str, token_file: Path | None) -> Iterator[Client]:
    """A server of our version that takes our token."""
    from muster.client import Client

    with Client(server, _token(token_file)) as control:
        control.about()
        yield control


def _token(file: Path | None) -> str | None:
    where = TOKEN_VARIABLE if file is None else file
    text = os.environ.get(TOKEN_VARIABLE, "") if file is None else file.read_text(encoding="latin-1")
    token = text.strip()
    right = token.isascii() and token.isprintable() and " " not in token and len(token) <= _LONGEST_TOKEN
    _require(right and (bool(token) or file is None), f"{where}: no token; expected one line that holds it")
    return token or None


def _refuse_all_but(takes: Sequence[str]) -> None:
    """Options that a server knows nothing of."""
    context = click.get_current_context()
    for parameter in context.command.params:
        name = str(parameter.name)
        given = context.get_parameter_source(name) is ParameterSource.COMMANDLINE
        if given and name not in (*takes, *MISSION_FLAGS, "server", "token_file"):
            raise ParameterError(f"{parameter.opts[-1]} given; expected it without --server")


def _require(right: bool, otherwise: str) -> None:
    if not right:
        raise ParameterError(otherwise)
