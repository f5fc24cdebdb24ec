"""The backend of verbs: this process, or a server of mission control (`--server URL`)."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import contextmanager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import click
from click.core import ParameterSource

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan

if TYPE_CHECKING:
    from muster.allocation.stop import Progress, Stop
    from muster.cli.local_backend import OnLine
    from muster.exchange.mission_control import MissionEntry
    from muster.execution import Report
    from muster.library import MissionSummary
    from muster.planning.explaining import Possible
    from muster.planning.explaining.tables import Explanation
    from muster.planning.export_formats import ExportOptions, Files
    from muster.planning.request import Request
    from muster.planning.solving import Solution
    from muster.running.negotiated.simulation import Negotiation
    from muster.running.observed_run import ObservedRun
    from muster.verification import Verdict

Verb = Callable[..., Any]
TOKEN_VARIABLE = "MUSTER_TOKEN"  # noqa: S105 - a name
_LONGEST_TOKEN = 1000


class Backend(Protocol):
    """The work that verbs ask for; `file` names a plan in messages."""

    def missions(self) -> Sequence[MissionSummary | MissionEntry]:
        """The missions that there are."""

    def check(self, mission: Mission, ignore: Sequence[str], time_limit: float) -> Possible:
        """Which tasks can never be done, alone or together."""

    def plan(self, request: Request, on_progress: Callable[[Progress], None] | None, interrupt: Stop) -> Solution:
        """A judged plan. Interrupted once, planning ends with its best plan.

        Raises
        ------
        KeyboardInterrupt
            if there is no plan that can be kept.
        """

    def verify(self, mission: Mission, plan: Plan, ignore: Sequence[str], objective: str | None) -> Verdict:
        """What the judge says."""

    def explain(
        self, mission: Mission, plan: Plan, task: str | None, ignore: Sequence[str], file: str, time_limit: float
    ) -> Explanation:
        """Why tasks are left out, or why one task is done by this robot."""

    def export(
        self, mission: Mission, plan: Plan, form: str, ignore: Sequence[str], options: ExportOptions, file: str
    ) -> Files:
        """An admissible plan as files of other tools."""

    def simulate(
        self, mission: Mission, plan: Plan | Negotiation, request: ObservedRun, on_line: OnLine | None
    ) -> tuple[Report, float | None]:
        """Carry a plan out; its report, and the mission's time at which Ctrl-C ended it, None where nothing did.

        Parameters
        ----------
        on_line
            is called with the time and the line of each event.
        """


def server_option(**in_this_process: str) -> Callable[[Verb], Verb]:
    """--server and --token-file; the verb gets a `backend`.

    Parameters
    ----------
    in_this_process
        parameters of the verb that mean nothing to a server, and why: they are refused beside --server.
    """

    def decorate(verb: Verb) -> Verb:
        @wraps(verb)
        def with_backend(*, server: str | None, token_file: Path | None, **given: Any) -> Any:
            if server is not None:
                _refuse(in_this_process)
            with _backend(server, token_file, verbose=given["verbose"]) as backend:
                return verb(backend=backend, **given)

        token = click.option(
            "--token-file",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help=f"File with your token for the server.  [default: the variable {TOKEN_VARIABLE}]",
        )
        text = "Let mission control do it: http://HOST:8117 (muster serve)."
        return click.option("--server", metavar="URL", help=text)(token(with_backend))

    return decorate


@contextmanager
def _backend(server: str | None, token_file: Path | None, *, verbose: bool) -> Iterator[Backend]:
    """The backend of a verb: this process, or a server that speaks this version of the API and takes the token."""

    def say(line: str) -> None:
        click.echo(line, err=True)

    def note(line: str) -> None:
        if verbose:
            say(line)

    if server is None:
        if token_file is not None:
            raise ParameterError("--token-file given; expected it together with --server")
        from muster.cli.local_backend import LocalBackend

        yield LocalBackend(note)
        return
    from muster.client import Client
    from muster.client.backend import ServerBackend

    with Client(server, token_from(token_file)) as client:
        client.about()
        yield ServerBackend(client, say, note)


def token_from(file: Path | None) -> str | None:
    where = TOKEN_VARIABLE if file is None else file
    text = os.environ.get(TOKEN_VARIABLE, "") if file is None else file.read_text(encoding="latin-1")
    token = text.strip()
    right = token.isascii() and token.isprintable() and " " not in token and len(token) <= _LONGEST_TOKEN
    if not right or (not token and file is not None):
        raise ParameterError(f"{where}: no token; expected one line that holds it")
    return token or None


def _refuse(reasons: Mapping[str, str]) -> None:
    """Refuse options that mean nothing to a server."""
    context = click.get_current_context()
    for parameter in context.command.params:
        given = context.get_parameter_source(str(parameter.name)) is ParameterSource.COMMANDLINE
        if given and parameter.name in reasons:
            why = reasons[parameter.name]
            raise ParameterError(f"{parameter.opts[-1]} given; expected it without --server: {why}")
