"""`muster export`: a plan as files of other tools."""

from __future__ import annotations

import sys
from collections.abc import Collection
from dataclasses import fields
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from muster.cli.backend import Backend, server_option
from muster.cli.exit_codes import Ending, exit_code_if
from muster.cli.options import (
    Finite,
    MissionFile,
    accept_partial_option,
    ignore_option,
    load_plan,
    mission_argument,
    quiet_option,
)
from muster.cli.outputs import require_folder, require_writable
from muster.mission.errors import ParameterError
from muster.mission.texts.near_matches import did_you_mean
from muster.planning.export_formats import (
    FIRMWARES,
    FORMATS,
    ExportOptions,
    Files,
    altitudes_in,
    makes_folder,
    options_of,
)


def _format(_: click.Context, __: click.Parameter, value: str) -> str:
    if value not in FORMATS:
        hint = did_you_mean(value, FORMATS)
        raise click.BadParameter(f"{value!r} is not one of {', '.join(FORMATS)}{hint}", param_hint="'--to'")
    return value


@click.command()
@mission_argument
@click.argument("plan", type=click.Path(path_type=Path))
@click.option(
    "--to",
    "form",
    required=True,
    callback=_format,
    metavar="FORMAT",
    help=f"One of {', '.join(FORMATS.shipped)}, or a format of an installed package.",
)
@click.option(
    "-o",
    "--output",
    type=click.Path(path_type=Path),
    metavar="FILE",
    help="For qgc, and with --per-robot, a folder.",
)
@click.option(
    "--altitude",
    type=Finite(0, 1e5),
    metavar="M",
    help="Drones fly no lower than so many metres above their starts; qgc needs it for drones in the plane.",
)
@click.option(
    "--altitude-step",
    type=Finite(0, 1e4),
    default=0.0,
    metavar="M",
    help="Each drone, in mission order, flies so many metres higher than the one before it.",
)
@click.option(
    "--altitudes",
    multiple=True,
    metavar="ROBOT=M,...",
    help="The heights of single drones, as --altitude: r_0=30,r_1=40.",
)
@click.option(
    "--clearance",
    type=Finite(0, 1e5),
    default=0.0,
    show_default=True,
    metavar="M",
    help="Warn where bodies come nearer to each other.",
)
@click.option(
    "--tolerance",
    type=Finite(0, 1e3),
    default=0.1,
    show_default=True,
    metavar="M",
    help="qgc: around corners of a map join way points, no farther than this from the way; 0 keeps all.",
)
@click.option(
    "--firmware",
    type=click.Choice(FIRMWARES),
    default="px4",
    show_default=True,
    help="qgc: the autopilot of the robots.",
)
@click.option("--per-robot", is_flag=True, help="sheets, ics: a file for each robot, into a folder.")
@ignore_option
@accept_partial_option
@quiet_option
@server_option()
def command(
    backend: Backend,
    mission: MissionFile,
    plan: Path,
    ignore: tuple[str, ...],
    form: str,
    output: Path | None,
    altitudes: tuple[str, ...],
    accept_partial: bool,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> int:
    """Write a PLAN of a MISSION for other tools, and to print: ground stations, maps, spreadsheets, sheets, calendars.

    The files of ground stations and maps need the mission's origin_wgs84, calendars its starts_at. Without -o the file
    goes to standard output; qgc writes a file for each robot into a folder.
    """
    _require_own_options(form)
    chosen = ExportOptions(altitudes=altitudes_in(altitudes), **options)
    is_folder = makes_folder(form, chosen)
    if is_folder:
        if output is None:
            raise ParameterError(f"-o missing; expected a folder for the {_SUFFIXES.get(form, form)} files")
        require_folder(output, "-o")
    else:
        require_writable(None, (output,), mission.files, (plan,))
    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    files = backend.export(loaded, given, form, ignore, chosen, str(plan))
    if is_folder:
        assert output is not None
        _write_files(files, output, (mission.name, plan))
    else:
        _write_file(files, output, form)
    for message in () if quiet else files.messages:
        if message != given.cut_short_line:  # which is said where the plan is read
            click.echo(message, err=True)
    return exit_code_if((Ending.CUT_SHORT, given.cut_short and not accept_partial))


_SUFFIXES = {"qgc": ".plan", "sheets": ".pdf", "ics": ".ics"}


def _require_own_options(form: str) -> None:
    """Refuse options of other formats."""
    context = click.get_current_context()
    for field in fields(ExportOptions):
        is_given = context.get_parameter_source(field.name) is ParameterSource.COMMANDLINE
        if is_given and field.name not in options_of(form):
            owners = [name for name in FORMATS.usable() if field.name in options_of(name)]
            option = f"--{field.name.replace('_', '-')}"
            raise ParameterError(f"{option} given; expected it with --to {' or '.join(owners)}, not {form}")


def _write_file(files: Files, output: Path | None, form: str) -> None:
    """Write the only file to its path, or to standard output."""
    if len(files.contents) != 1:
        raise ParameterError(f"--to: {form} made {len(files.contents)} files; expected one")
    (content,) = files.contents.values()
    if output is None and isinstance(content, bytes) and sys.stdout.isatty():
        raise ParameterError(f"-o missing; expected a file: {form} is no text for a terminal")
    if output is None:
        click.echo(content, nl=False)
    else:
        (data,) = files.encoded.values()
        output.write_bytes(data)


def _write_files(files: Files, folder: Path, inputs: tuple[str | Path, ...]) -> None:
    """Write a file for each robot that has stops."""
    _require_free(folder, files.contents, inputs)
    folder.mkdir(parents=True, exist_ok=True)
    for name, content in files.encoded.items():
        (folder / name).write_bytes(content)


def _require_free(folder: Path, files: Collection[str], inputs: tuple[str | Path, ...]) -> None:
    """Refuse a folder whose files were read, or that holds such files of other robots."""
    read = {Path(name).resolve() for name in inputs}
    for name in files:
        if (folder / name).resolve() in read or folder.resolve() in read:
            raise ParameterError(f"{folder / name}: given twice; expected a folder whose files are not read")
    for suffix in sorted({Path(name).suffix for name in files}):
        others = sorted(file.name for file in folder.glob(f"*{suffix}") if file.name not in files)
        if others:
            told = f"expected a folder without {suffix} files of other robots"
            raise ParameterError(f"-o: {folder} holds {others[0]}; {told}")
