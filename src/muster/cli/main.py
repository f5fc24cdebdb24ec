"""The command's entry: finds the verb, and turns every expected failure into a line and an exit code.

`muster.cli.exit_codes` has the table of exit codes.
"""

from __future__ import annotations

import errno
import os
import sys
from collections.abc import Mapping
from io import TextIOWrapper
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exit_codes import Ending, Invocation, exit_code
from muster.mission.errors import IncompletePlanError, MusterError
from muster.mission.value_types import shown

if TYPE_CHECKING:
    from importlib.metadata import EntryPoint

VERB_GROUP = "muster.verbs"


class _OutputClosedError(Exception):
    pass


class _Verbs(click.Group):
    """The verbs of all packages; one is imported when it is called, or its summary is shown."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        return [*verbs()]

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command | None:
        found = verbs().get(cmd_name)
        return None if found is None else _loaded(found)

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        with formatter.section("Verbs"):
            formatter.write_dl([(name, _summary(found)) for name, found in verbs().items()])

    def invoke(self, ctx: click.Context) -> Any:
        try:
            return super().invoke(ctx)
        except BrokenPipeError:  # which click would turn into the exit code of a rejected plan
            raise _OutputClosedError from None

    def resolve_command(
        self, ctx: click.Context, args: list[str]
    ) -> tuple[str | None, click.Command | None, list[str]]:
        from muster.mission.texts.near_matches import did_you_mean

        if args and args[0] not in verbs() and not args[0].startswith("-"):
            raise click.UsageError(f"no verb '{args[0]}'{did_you_mean(args[0], verbs())}", ctx)
        return super().resolve_command(ctx, args)


def verbs() -> Mapping[str, EntryPoint]:
    """The verbs of this distribution in the order of `--help`, then those of others; none of these replaces one."""
    from muster.mission.system.plugins import declared, is_shipped

    found = declared(VERB_GROUP)
    shipped = {verb.name: verb for verb in found if is_shipped(verb)}
    return shipped | {verb.name: verb for verb in sorted(found, key=lambda verb: verb.name) if verb.name not in shipped}


def _loaded(found: EntryPoint) -> click.Command:
    """The click command that an entry point names.

    Raises
    ------
    MusterError
        if it cannot be imported, or is no click command.
    """
    place = f"verb {found.name}: {found.value}"
    try:
        command = found.load()
    except MusterError:
        raise
    except Exception as error:  # the code of another package may raise anything
        raise MusterError(f"{place}: {type(error).__name__}: {error}; expected a click command") from error
    if not isinstance(command, click.Command):
        raise MusterError(f"{place}: {shown(command)}; expected a click command")
    return command


def _summary(found: EntryPoint) -> str:
    """The first sentence of a verb's help; why it is missing, where the verb cannot be loaded."""
    try:
        return _loaded(found).get_short_help_str(limit=200)
    except MusterError as error:
        return f"cannot be loaded: {error}"


def _print_version(ctx: click.Context, _: click.Parameter, asked: bool) -> None:
    if asked and not ctx.resilient_parsing:
        from muster.mission.system.installation import version_line

        click.echo(version_line())
        ctx.exit()


_HELP = """Plan missions of robot teams: who does what, in which order.

A MISSION is a file (YAML, CSV, GeoJSON, KML, TSPLIB, ...) or the name of a mission that comes with Muster:

\b
  muster solve 31T-6R50 --plot plan.png
"""


@click.group(cls=_Verbs, help=_HELP, context_settings={"help_option_names": ["-h", "--help"]})
@click.option(
    "--version",
    is_flag=True,
    expose_value=False,
    is_eager=True,
    callback=_print_version,
    help="Print the version, and how the core was built.",
)
def muster() -> None:
    """Plan missions of robot teams."""


def run(arguments: list[str], began_s: float | None = None) -> int:
    """Run the command, which began at a time of `SystemClock`, or begins now; returns the exit code."""
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, TextIOWrapper):  # a character that the terminal lacks is no reason to stop
            stream.reconfigure(errors="backslashreplace")
    colour = (
        True if os.environ.get("FORCE_COLOR") else None
    )  # as Rich takes it; NO_COLOR leaves bold, which is no colour
    invocation = Invocation(began_s)
    try:
        result = muster.main(arguments, prog_name="muster", standalone_mode=False, obj=invocation, color=colour)
        sys.stdout.flush()
    except click.exceptions.Exit as stop:
        return stop.exit_code
    except (KeyboardInterrupt, Exception) as error:  # whatever happens, the user gets a line
        return exit_code(_told(error), *invocation.endings)
    return result if isinstance(result, int) else exit_code(Ending.DONE)


def _told(error: BaseException) -> Ending:
    """Print the line of an exception that ended the command; returns how the command ended."""
    if isinstance(error, click.Abort) or _is_ctrl_c(error):
        click.echo("interrupted", err=True)
        return Ending.INTERRUPTED
    if isinstance(error, click.ClickException):
        error.show(sys.stderr)
        return Ending.REFUSED
    if isinstance(error, IncompletePlanError):
        click.echo(str(error), err=True)
        return Ending.CUT_SHORT
    if isinstance(error, MusterError):
        return _refused(str(error))
    if isinstance(error, (BrokenPipeError, _OutputClosedError)):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return Ending.BROKEN_PIPE
    if isinstance(error, OSError) and error.filename is not None:
        return _refused(f"{error.filename}: {error.strerror}; expected a file that can be read or written")
    if isinstance(error, OSError) and error.errno in (errno.ENOSPC, errno.EDQUOT):
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())  # which would fail again at the end
        return _refused(f"{error.strerror}; expected room for what is written, and printed")
    if os.environ.get("MUSTER_DEBUG"):
        raise error
    click.echo(f"internal error: {type(error).__name__}: {error} (MUSTER_DEBUG=1 shows where)", err=True)
    return Ending.INTERNAL_ERROR


def _refused(message: str) -> Ending:
    click.echo(message, err=True)
    return Ending.REFUSED


def _is_ctrl_c(error: BaseException | None) -> bool:
    """Whether Ctrl-C is at the root of an error: Python 3.11 wraps one that comes while it makes a class."""
    return isinstance(error, KeyboardInterrupt) or (error is not None and _is_ctrl_c(error.__cause__))
