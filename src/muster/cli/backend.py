"""The backend of verbs: this process, or a server of mission control (`--server URL`).

Backends are entry points of the group `muster.backends`: `local`, and `server`, which `--server` selects.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager
from functools import wraps
from pathlib import Path
from typing import TYPE_CHECKING, Any, Protocol

import click
from click.core import ParameterSource

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.system.plugins import Registry, function_expected

if TYPE_CHECKING:
    from muster.allocation.stop import Progress, Stop
    from muster.cli.local_backend import OnLine
    from muster.execution import Report
    from muster.planning.explaining import Possible
    from muster.planning.explaining.tables import Explanation
    from muster.planning.export_formats import ExportOptions, Files
    from muster.planning.request import Request
    from muster.planning.solving import Solution
    from muster.running.coordination import Coordination
    from muster.running.observed_run import ObservedRun
    from muster.verification import Verdict

Verb = Callable[..., Any]


class Backend(Protocol):
    """The work that verbs ask for; `file` names a plan in messages."""

    def version(self) -> str:
        """Return the version of Muster that does the work."""

    def missions(self) -> tuple[Sequence[Mapping[str, Any]], Sequence[Mapping[str, str]]]:
        """Return the missions that there are: plain data, and the row of each in a table for people, by column."""

    def check(self, mission: Mission, ignore: Sequence[str], time_limit: float) -> Possible:
        """Which tasks can never be done, alone or together."""

    def plan(self, request: Request, on_progress: Callable[[Progress], None] | None, interrupt: Stop) -> Solution:
        """A judged plan. Interrupted once, planning ends with its best plan.

        Raises
        ------
        KeyboardInterrupt
            if there is no plan that can be kept.
        """

    def kept(self, plan: Plan) -> str | None:
        """Return a clause that says where the backend keeps a plan that it made; None where it keeps none."""

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
        self, mission: Mission, plan: Plan | Coordination, request: ObservedRun, on_line: OnLine | None
    ) -> tuple[Report, float | None]:
        """Carry a plan out; its report, and the mission's time at which Ctrl-C ended it, None where nothing did.

        Parameters
        ----------
        on_line
            is called with the time and the line of each event.
        """


Say = Callable[[str], None]
OpenBackend = Callable[[str | None, Path | None, Say, Say], AbstractContextManager[Backend]]
"""Opens a backend: `open(url, token_file, say, note)`; `say` gets messages for the user, `note` those of -v."""

BACKENDS: Registry[OpenBackend] = Registry(
    "backend", "muster.backends", function_expected("a function that opens a backend")
)


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
            with open_backend(server, token_file, verbose=given["verbose"]) as backend:
                return verb(backend=backend, **given)

        token = click.option(
            "--token-file",
            type=click.Path(path_type=Path),
            metavar="FILE",
            help="File with your token for the server.  [default: the variable MUSTER_TOKEN]",
        )
        text = "Let mission control do it: http://HOST:8117 (muster serve)."
        return click.option("--server", metavar="URL", help=text)(token(with_backend))

    return decorate


def open_backend(
    server: str | None, token_file: Path | None, *, verbose: bool = False
) -> AbstractContextManager[Backend]:
    """Open the backend of a verb: this process, or a server that speaks this version of the API and takes the token."""

    def say(line: str) -> None:
        click.echo(line, err=True)

    def note(line: str) -> None:
        if verbose:
            say(line)

    if server is None and token_file is not None:
        raise ParameterError("--token-file given; expected it together with --server")
    return BACKENDS.named("local" if server is None else "server")(server, token_file, say, note)


def _refuse(reasons: Mapping[str, str]) -> None:
    """Refuse options that mean nothing to a server."""
    context = click.get_current_context()
    for parameter in context.command.params:
        given = context.get_parameter_source(str(parameter.name)) is ParameterSource.COMMANDLINE
        if given and parameter.name in reasons:
            why = reasons[parameter.name]
            raise ParameterError(f"{parameter.opts[-1]} given; expected it without --server: {why}")
