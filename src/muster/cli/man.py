"""`muster man`: the manual page of the command, made from what its verbs say of themselves."""

from __future__ import annotations

import re
from collections.abc import Iterator
from importlib.metadata import version

import click

from muster.cli.options import quiet_option
from muster.mission.system.installation import DISTRIBUTION
from muster.mission.system.plugins import declared, is_shipped

_HELP = """Print the manual page, for `man`.

\b
  muster man > muster.1 && man ./muster.1
"""


@click.command(help=_HELP)
@quiet_option
def command(quiet: bool, verbose: bool) -> None:
    """Print the manual page."""
    click.echo(page(), nl=False)


def page() -> str:
    """The manual page muster(1) in the macros of man(7), with all verbs of this distribution and their options."""
    from muster.cli.main import VERB_GROUP, muster

    root = click.Context(muster, info_name="muster", help_option_names=["-h", "--help"])
    lines = [
        f'.TH MUSTER 1 "" "muster {version(DISTRIBUTION)}" "User Commands"',
        ".SH NAME",
        r"muster \- plan and carry out missions of robot teams",
        ".SH SYNOPSIS",
        ".B muster",
        r"\fIVERB\fR [\fIOPTIONS\fR]",
        ".SH DESCRIPTION",
        *_text(muster.help or ""),
        ".SH VERBS",
    ]
    for name in (found.name for found in declared(VERB_GROUP) if is_shipped(found)):
        verb = muster.get_command(root, name)
        assert verb is not None
        lines += _verb(verb, click.Context(verb, info_name=name, parent=root))
    return "\n".join([*lines, *_ENDING, ""])


_ENDING = (
    ".SH EXIT STATUS",
    "0 done; 1 a plan is rejected, or what is installed does not work; 2 bad input, usage or a missing extra;",
    "3 tasks are left out with \\-\\-require\\-complete, or a comparison has no plan; 4 a real robot still moves;",
    "130 interrupted.",
    ".SH ENVIRONMENT",
    "NO_COLOR switches colours off, FORCE_COLOR lets letters be bold in files and pipes too.",
    "MUSTER_DEBUG shows where an internal error is.",
    "MUSTER_TOKEN is what \\-\\-server shows a server, MUSTER_DB the database of mission control.",
)


def _verb(verb: click.Command, context: click.Context) -> Iterator[str]:
    usage = " ".join(verb.collect_usage_pieces(context))
    yield f".SS {_escaped(context.command_path)} {_escaped(usage)}"
    yield from _text(verb.help or "")
    for parameter in verb.get_params(context):
        record = parameter.get_help_record(context)
        if record is not None:
            yield from (".TP", f"\\fB{_escaped(record[0])}\\fR", _escaped(" ".join(record[1].split())))
    if isinstance(verb, click.Group):
        for name in verb.list_commands(context):
            below = verb.get_command(context, name)
            if below is not None:
                yield from _verb(below, click.Context(below, info_name=name, parent=context))


def _text(text: str) -> Iterator[str]:
    """Paragraphs; one that begins with click's mark of a backspace keeps its lines."""
    for paragraph in re.split(r"\n\s*\n", text.strip()):
        kept = paragraph.lstrip().startswith("\b")
        yield ".PP"
        if kept:
            yield from (
                ".nf",
                *(_escaped(line) for line in paragraph.replace("\b", "").strip("\n").splitlines()),
                ".fi",
            )
        else:
            yield _escaped(" ".join(paragraph.split()))


def _escaped(text: str) -> str:
    """Text in which nothing is a macro or an escape of roff."""
    text = text.replace("\\", r"\e").replace("-", r"\-").replace("'", r"\(aq")
    return rf"\&{text}" if text.startswith(".") else text
