"""`muster serve`: mission control in the browser."""

from __future__ import annotations

import gc
import os
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE
from muster.cli.options.common import quiet_option
from muster.mission.errors import MissingExtraError, ParameterError, PluginError
from muster.mission.system.platforms import require_posix
from muster.mission.texts.near_matches import did_you_mean

if TYPE_CHECKING:
    from fastapi import FastAPI

    from muster_control.settings import Settings

_FILE = click.Path(path_type=Path)
_LOCAL = "local"


@click.command()
@click.argument("mission", required=False)
@click.option(
    "--host", default="127.0.0.1", show_default=True, metavar="NAME", help="Address on which the server listens."
)
@click.option(
    "--port", type=click.IntRange(0, 65535), default=8117, show_default=True, metavar="PORT", help="0: any free one."
)
@click.option(
    "--db",
    "database",
    envvar="MUSTER_DB",
    metavar="URL",
    help="sqlite:///FILE or postgresql://USER@HOST/NAME; also MUSTER_DB.  [default: a file of yours]",
)
@click.option(
    "--workers",
    type=click.IntRange(1, 256),
    metavar="N",
    help="Workers that plan at the same time.  [default: one a core]",
)
@click.option(
    "--memory",
    "memory_mb",
    type=click.IntRange(min=256),
    default=2048,
    show_default=True,
    metavar="MB",
    help="Memory of each worker, and of each simulated run.",
)
@click.option(
    "--runs", type=click.IntRange(1, 1000), default=8, show_default=True, metavar="N", help="Runs at the same time."
)
@click.option(
    "--bridge",
    "bridges",
    callback=lambda *a: _known_bridges(*a),
    multiple=True,
    metavar="NAME",
    help="To real robots: ros1, ros2, mavlink, or a fleet of an installed package; may be given again.",
)
@click.option("--tokens", type=_FILE, metavar="FILE", help="Who may watch or command, a line each: ROLE NAME DIGEST.")
@click.option("--new-token", metavar="NAME", help="Print a fresh token and its line, and end; with --tokens add it.")
@click.option("--role", type=click.Choice(["watch", "command"]), help="Role of the new token.  [default: watch]")
@click.option("--user-header", metavar="NAME", help="Header in which a reverse proxy names the user.")
@click.option(
    "--trusted-proxy",
    "trusted_proxies",
    multiple=True,
    metavar="ADDRESS",
    help="Address of the proxy whose headers are trusted.",
)
@click.option(
    "--proxy-secret",
    type=_FILE,
    metavar="FILE",
    help="Secret that the proxy sends in X-Muster-Proxy-Secret; with --user-header.",
)
@click.option("--tls-cert", "certificate", type=_FILE, metavar="PEM", help="Serve HTTPS with this certificate.")
@click.option("--tls-key", "key", type=_FILE, metavar="PEM", help="Key of the certificate.")
@click.option("--insecure-http", is_flag=True, help="Listen beyond this machine without TLS.")
@click.option(
    "--public-origin", "public_origins", multiple=True, metavar="URL", help="Origin that browsers use through a proxy."
)
@click.option("--tiles", type=_FILE, metavar="FOLDER", help="Map tiles Z/X/Y.png for missions on the earth.")
@click.option(
    "--log-format",
    type=click.Choice(["text", "json"]),
    default="text",
    show_default=True,
    help="Format of the log on standard error.",
)
@click.option("--open", "opens", is_flag=True, help="Show it in the browser.")
@quiet_option
def command(
    mission: str | None,
    database: str | None,
    workers: int | None,
    new_token: str | None,
    role: str | None,
    opens: bool,
    quiet: bool,
    verbose: bool,
    **asked: Any,
) -> int:
    """Open mission control: plan, watch and steer missions in the browser.

    With a MISSION its page is the first. Ctrl-C ends the server; missions under way go on when it is started again.
    """
    require_posix("mission control")
    _require_extra()
    if new_token is not None:
        return _print_token(new_token, role or "watch", asked["tokens"])
    if role is not None:
        raise ParameterError(f"--role {role} given without --new-token NAME; expected both")
    from muster_control.settings import Settings

    given: dict[str, Any] = {"database": database, "workers": workers}
    settings = Settings(**asked, **{name: value for name, value in given.items() if value is not None})
    _require_usable(settings)
    _warn_of_password(database)
    return _served(settings, mission, opens=opens, quiet=quiet, verbose=verbose)


def _warn_of_password(database: str | None) -> None:
    from click.core import ParameterSource

    from muster_control.store.urls import database_url

    given = click.get_current_context().get_parameter_source("database") is ParameterSource.COMMANDLINE
    if given and database is not None and database_url(database).password:
        click.echo("--db has a password, which others on this machine see; expected PGPASSWORD or ~/.pgpass", err=True)


def _require_extra() -> None:
    """Name the extra to install where a library is missing, without importing those that are installed."""
    from importlib.util import find_spec

    if any(find_spec(name) is None for name in ("alembic", "fastapi", "nicegui", "prometheus_client", "sqlalchemy")):
        raise MissingExtraError("web", "mission control")


def _print_token(name: str, role: Any, file: Path | None) -> int:
    from muster_control.security.tokens import line_of, new_token, read_holders

    token = new_token()
    line = line_of(name, role, token)
    if file is None:
        click.echo(f"token: {token}\nline:  {line}")
        return DONE
    is_new = not file.exists()
    if not is_new and any(holder.name == name for holder in read_holders(file)):
        raise ParameterError(f"{file}: {name} has a token; expected another name, or that the line is deleted first")
    _add_line(file, line, is_new=is_new)
    click.echo(f"token: {token}")
    click.echo(f"added to {file}: {role} {name}", err=True)
    return DONE


def _add_line(file: Path, line: str, *, is_new: bool) -> None:
    """Append a line of tokens in one write, so that two writers do not mix their lines."""
    descriptor = os.open(
        file, os.O_RDWR | os.O_APPEND | os.O_CREAT, 0o644
    )  # no secret: a service that runs as somebody else reads it
    with os.fdopen(descriptor, "ab") as stream:
        if is_new:
            os.fchmod(descriptor, 0o644)  # whatever the umask
        end = os.fstat(descriptor).st_size
        ended = end == 0 or os.pread(descriptor, 1, end - 1) == b"\n"
        stream.write(f"{line}\n".encode() if ended else f"\n{line}\n".encode())


def _known_bridges(_: click.Context, __: click.Parameter, names: tuple[str, ...]) -> tuple[str, ...]:
    from muster.running.fleet_registry import FLEETS

    for name in names:
        if name not in FLEETS:
            hint = did_you_mean(name, FLEETS)
            raise click.BadParameter(f"{name!r} is not one of {', '.join(FLEETS)}{hint}", param_hint="'--bridge'")
    return names


def _require_usable(settings: Settings) -> None:
    """Refuse options that exclude each other, before anything is opened."""
    from muster.running.fleet_registry import FLEETS
    from muster_control.security.serving_rules import require_safe
    from muster_control.serving import require_certificate

    require_safe(settings)
    if settings.certificate is not None and settings.key is not None:
        require_certificate(settings.certificate, settings.key)
    for bridge in settings.bridges:
        with suppress(PluginError):  # a run with it is refused; the others go on
            FLEETS.named(bridge).require_installed()
    if settings.tiles is not None and not settings.tiles.is_dir():
        raise ParameterError(f"--tiles {settings.tiles}: no folder; expected one with Z/X/Y.png in it")


def _served(settings: Settings, mission: str | None, *, opens: bool, quiet: bool, verbose: bool) -> int:
    """Serve until interrupted; returns the exit code."""
    from muster_control.logs import begin_logs
    from muster_control.serving import listening, serve

    begin_logs(settings.log_format, quiet=quiet, verbose=verbose)
    with listening(settings.host, settings.port) as at, _collecting_later() as begin_collecting:
        from muster_control.app import make_app  # takes a second: what can be wrong is known before

        app = make_app(settings)
        address = _address(settings, at.getsockname()[1])

        async def on_ready() -> None:
            page = f"{address}/" if mission is None else f"{address}/plan/{await _mission_page(app, mission)}"
            click.echo(f"mission control: {page}")
            begin_collecting()
            if opens:
                import webbrowser

                webbrowser.open(page)

        serve(app, settings, at, on_ready)
    if not quiet:
        click.echo(_farewell(app.state.left), err=True)
    return DONE


@contextmanager
def _collecting_later() -> Iterator[Callable[[], None]]:
    """Switch the garbage collector off for the start, which makes little garbage; returns what switches it on."""

    def begin() -> None:
        gc.freeze()  # what was made so far stays: it need not be looked at again and again
        gc.enable()

    gc.disable()
    try:
        yield begin
    finally:
        gc.enable()


async def _mission_page(app: FastAPI, mission: str) -> str:
    """The id of the mission's page: of one that ships, or of a file, which is uploaded unless it is there already."""
    from muster.mission.texts.near_matches import did_you_mean
    from muster_control.contract import MOST_ROWS, NotFoundError, User

    missions, who, file = app.state.services.missions, User("local", "command"), Path(mission)
    with suppress(NotFoundError):
        return str((await missions.get(mission)).mission)
    if not file.is_file():
        known = [entry.id for entry in await missions.list(MOST_ROWS)]
        raise NotFoundError(f"{mission}: no file, and no mission of that name{did_you_mean(mission, known)}")
    there = await missions.with_text(file.read_text(encoding="utf-8", errors="replace"))
    return there or str((await missions.upload(who, file.name, file.read_bytes())).mission)


def _address(settings: Settings, port: int) -> str:
    """The address of the server for a browser."""
    scheme = "http" if settings.certificate is None else "https"
    host = {"0.0.0.0": "127.0.0.1", "::": "[::1]"}.get(settings.host, settings.host)  # noqa: S104
    host = f"[{host}]" if ":" in host and not host.startswith("[") else host
    return f"{scheme}://{host}:{port}"


def _farewell(runs: int) -> str:
    if not runs:
        return "ended"
    return f"ended; {runs} {'run goes' if runs == 1 else 'runs go'} on when the server is started again"
