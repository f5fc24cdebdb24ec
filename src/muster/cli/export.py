"""`muster export`: a plan as files of other tools."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import fields
from pathlib import Path
from typing import Any

import click
from click.core import ParameterSource

from muster.cli.backend import Backend, server_option
from muster.cli.exits import DONE
from muster.cli.options import Finite, MissionFile, ignore_option, load_plan, mission_argument, quiet_option
from muster.cli.outputs import require_folder, require_writable
from muster.exchange.export_request import FORMATS, Files, QgcOptions
from muster.mission.errors import ParameterError
from muster.mission.near_matches import did_you_mean


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
@click.option("-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="For qgc a folder.")
@click.option(
    "--altitude",
    type=Finite(0, 1e5),
    metavar="M",
    help="qgc: fly no lower than so many metres above the start; needed for drones of a mission in the plane.",
)
@click.option(
    "--clearance",
    type=Finite(0, 1e5),
    default=0.0,
    show_default=True,
    metavar="M",
    help="qgc: warn where bodies come nearer to each other.",
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
    type=click.Choice(["px4", "ardupilot"]),
    default="px4",
    show_default=True,
    help="qgc: the autopilot of the robots.",
)
@ignore_option
@quiet_option
@server_option()
def command(
    backend: Backend,
    mission: MissionFile,
    plan: Path,
    ignore: tuple[str, ...],
    form: str,
    output: Path | None,
    quiet: bool,
    verbose: bool,
    **options: Any,
) -> int:
    """Write a PLAN of a MISSION for other tools: ground stations, maps, spreadsheets.

    All but csv and sol need the mission's origin_wgs84. Without -o the file goes to standard output; qgc writes a file
    for each robot into a folder.
    """
    if form == "qgc":
        if output is None:
            raise ParameterError("-o missing; expected a folder for the .plan files")
        require_folder(output, "-o")
    else:
        _require_none_of_qgc(form)
        require_writable(None, (output,), mission.files, (plan,))
    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    files = backend.export(loaded, given, form, ignore, QgcOptions(**options), str(plan))
    if form == "qgc":
        assert output is not None
        _write_plan_files(files, output, (mission.name, plan))
        for message in () if quiet else files.messages:
            click.echo(message, err=True)
        return DONE
    if len(files.texts) != 1:
        raise ParameterError(f"--to: {form} made {len(files.texts)} files; expected one")
    (text,) = files.texts.values()
    if output is None:
        click.echo(text, nl=False)
    else:
        output.write_text(text, encoding="utf-8", newline="")
    return DONE


def _require_none_of_qgc(form: str) -> None:
    """Refuse options of plan files for another format."""
    context = click.get_current_context()
    for field in fields(QgcOptions):
        if context.get_parameter_source(field.name) is ParameterSource.COMMANDLINE:
            raise ParameterError(f"--{field.name} given; expected it with --to qgc, not {form}")


def _write_plan_files(files: Files, folder: Path, inputs: tuple[str | Path, ...]) -> None:
    """Write a file for each robot that has tasks."""
    _require_free(folder, files.texts, inputs)
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in files.texts.items():
        (folder / name).write_text(text, encoding="utf-8")


def _require_free(folder: Path, files: Collection[str], inputs: tuple[str | Path, ...]) -> None:
    """Refuse a folder whose files were read, or that holds plan files of other robots."""
    read = {Path(name).resolve() for name in inputs}
    for name in files:
        if (folder / name).resolve() in read or folder.resolve() in read:
            raise ParameterError(f"{folder / name}: given twice; expected a folder whose files are not read")
    others = sorted(file.name for file in folder.glob("*.plan") if file.name not in files)
    if others:
        raise ParameterError(f"-o: {folder} holds {others[0]}; expected a folder without .plan files of other robots")
