"""`muster doctor`: what is installed, whether it works, and what was found of the system."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.exits import DONE, REJECTED
from muster.cli.options import format_option, quiet_option
from muster.mission.errors import MusterError

if TYPE_CHECKING:
    from muster.mission.system.installation import Part
    from muster.running.doctor import ExtraHealth
    from muster.running.system_facts import Found, Processors


@click.command()
@click.option("--server", metavar="URL", help="A mission control that should answer: http://HOST:8117.")
@click.option("--token-file", type=click.Path(path_type=Path), metavar="FILE", help="File with your token for it.")
@format_option
@quiet_option
def command(server: str | None, token_file: Path | None, form: str, quiet: bool, verbose: bool) -> int:
    """Say what is installed and in which version, what works, and what was found of the system.

    Each optional package is imported, in a process of its own. Exits with 1 if one that is installed cannot be, or if
    the server does not answer; what is not installed is no fault.
    """
    from muster.mission.system.installation import core_build, core_parts, extras, installed_version
    from muster.running.doctor import health, import_faults
    from muster.running.system_facts import processors, programs, python, system

    if verbose:
        click.echo("importing every package that is installed ...", err=True)
    core = core_parts()
    core_faults = import_faults(["muster.core", *(part.name for part in core)])
    states = health({name: parts for name, parts in extras().items() if parts and name != "all"})
    answer = _server_answer(server, token_file)
    build, used, found = core_build(), processors(), programs()
    facts: dict[str, Any] = {
        "version": installed_version(),
        "core": None if build is None else vars(build),
        "python": python(),
        "system": system(),
        "processors": vars(used),
        "packages": {part.name: part.version for part in core},
        "faults": core_faults,
        "extras": {state.name: _extra_facts(state) for state in states},
        "programs": {one.name: one.where for one in found},
        "server": answer,
    }
    works = not core_faults and all(state.state != "broken" for state in states) and (answer or {}).get("fault") is None
    if form == "json":
        import json

        click.echo(json.dumps(facts | {"works": works}, indent=1))
    else:
        _print(facts, core, states, found, used)
    return DONE if works else REJECTED


def _extra_facts(state: ExtraHealth) -> dict[str, Any]:
    packages = {part.name: part.version for part in state.parts}
    return {"state": state.state, "packages": packages, "faults": dict(state.faults)}


def _server_answer(url: str | None, token_file: Path | None) -> dict[str, str | None] | None:
    """What a server says of itself, or why it does not; None if none is named."""
    if url is None:
        return None
    from muster.cli.backend import open_backend

    try:
        with open_backend(url, token_file) as backend:
            return {"url": url, "version": backend.version(), "fault": None}
    except MusterError as error:
        return {"url": url, "version": None, "fault": str(error)}


def _print(
    facts: dict[str, Any],
    core: tuple[Part, ...],
    states: tuple[ExtraHealth, ...],
    found: tuple[Found, ...],
    processors: Processors,
) -> None:
    from muster.cli.tables import print_table
    from muster.mission.system.installation import version_line

    limit = "" if processors.group_limit is None else f", {processors.group_limit:g} allowed by the control group"
    rows = [
        ("Muster", version_line()),
        ("Python", facts["python"]),
        ("system", facts["system"]),
        ("processors", f"{processors.machine}, {processors.usable} usable{limit}"),
        ("packages", ", ".join(f"{part.name} {part.version}" for part in core)),
        *(("broken", f"{name}: {fault}") for name, fault in facts["faults"].items()),
    ]
    if facts["server"]:
        answer = facts["server"]
        rows.append(("server", f"{answer['url']}: {answer['fault'] or 'answers, version ' + answer['version']}"))
    print_table(("what", "found"), rows, title="Installation")
    print_table(("extra", "state", "packages"), [_row(state) for state in states], title="Extras")
    print_table(
        ("program", "found", "needed for"),
        [(one.name, one.where or "-", one.needed_for) for one in found],
        title="System",
    )


def _row(state: ExtraHealth) -> tuple[str, str, str]:
    """Of a broken extra the faults; of others the versions, and what is missing."""
    if state.faults:
        return state.name, state.state, "; ".join(f"{name}: {fault}" for name, fault in state.faults.items())
    there = ", ".join(f"{part.name} {part.version}" for part in state.parts if part.version is not None)
    missing = f"missing: {', '.join(state.missing)}" if state.missing else ""
    return state.name, state.state, "; ".join(filter(None, (there, missing)))
