"""`muster export --server`: written there, kept here."""

from __future__ import annotations

import io
import zipfile
from pathlib import Path
from typing import TYPE_CHECKING

import click
from click.core import ParameterSource

from muster.cli.exits import DONE
from muster.cli.options import MissionFile, load_plan
from muster.cli.outputs import require_folder, require_writable
from muster.cli.remote.uploads import kept_plan
from muster.mission.errors import NetworkError, ParameterError

if TYPE_CHECKING:
    from muster.client import Client

_NOTES = "NOTES.txt"


def run(
    control: Client,
    *,
    mission: MissionFile,
    plan: Path,
    ignore: tuple[str, ...],
    form: str,
    output: Path | None,
    altitude: float | None,
    clearance: float,
    tolerance: float,
    firmware: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Send the mission and the plan; write what comes back."""
    if form == "qgc":
        if output is None:
            raise ParameterError("-o missing; expected a folder for the .plan files")
        require_folder(output, "-o")
    else:
        require_writable(None, (output,), mission.files, (plan,))
    loaded = mission.load(verbose=verbose)
    given = load_plan(plan, loaded, ignore, quiet=quiet, verbose=verbose)
    wishes = {"altitude": altitude, "clearance": clearance, "tolerance": tolerance, "firmware": firmware}
    asked = {name: value for name, value in wishes.items() if _is_given(name)}
    if asked and form != "qgc":
        raise ParameterError(f"--{next(iter(asked))} given; expected it with --to qgc, not {form}")
    name, data = control.plans.export(kept_plan(control, loaded, given, verbose=verbose).id, form, ignore, **asked)
    if form == "qgc":
        assert output is not None
        notes = _unpack(name, data, output)
        for note in () if quiet else notes:
            click.echo(note, err=True)
    elif output is None:
        click.echo(data, nl=False)
    else:
        output.write_bytes(data)
    return DONE


def _is_given(name: str) -> bool:
    return click.get_current_context().get_parameter_source(name) is ParameterSource.COMMANDLINE


def _unpack(name: str, data: bytes, folder: Path) -> list[str]:
    """Write the plan files that came into a folder that has none of other robots; what a person has to know."""
    if name.endswith(".zip"):
        with zipfile.ZipFile(io.BytesIO(data)) as archive:
            files = {each: archive.read(each) for each in archive.namelist()}
    else:
        files = {name: data}
    notes = files.pop(_NOTES, b"").decode("utf-8", "replace")
    for each in files:
        if Path(each).name != each:
            raise NetworkError(f"the server sends a file {each!r}; expected a name without folders")
    others = sorted(file.name for file in folder.glob("*.plan") if file.name not in files)
    if others:
        raise ParameterError(f"-o: {folder} holds {others[0]}; expected a folder without .plan files of other robots")
    folder.mkdir(parents=True, exist_ok=True)
    for each, content in files.items():
        (folder / each).write_bytes(content)
    return notes.splitlines()
