"""`muster init`: a mission file to start from."""

from __future__ import annotations

import json
import re
from pathlib import Path
from string import Template

import click

from muster.cli.options import quiet_option
from muster.mission.errors import ParameterError
from muster.mission.texts.packaged_files import packaged_text


@click.command()
@click.argument("name", default="mission")
@click.option("--from", "shipped", metavar="SHIPPED", help="Copy a mission that comes with Muster.")
@click.option("-o", "--output", type=click.Path(path_type=Path), help="The file to write.  [default: NAME.yaml]")
@quiet_option
def command(name: str, shipped: str | None, output: Path | None, quiet: bool, verbose: bool) -> None:
    """Write a mission file to start from: NAME.yaml in this folder.

    An existing file is left alone.
    """
    stem = name.removesuffix(".yaml").removesuffix(".yml")
    path = output or Path(f"{stem}.yaml")
    text, beside = _template(path) if shipped is None else _shipped(shipped)
    files = {path: text.encode(), **{path.with_name(file.name): file.read_bytes() for file in beside}}
    if len(files) <= len(beside):
        raise ParameterError(f"{path}: the name of the mission's map; expected another one")
    for new in files:
        if new.exists() or new.is_symlink():
            raise ParameterError(f"{new}: exists; expected the name of a new file")
    for new, content in files.items():
        with new.open("xb") as stream:
            stream.write(content)
        click.echo(str(new))
    if verbose:
        origin = "a template" if shipped is None else f"a copy of {shipped}"
        click.echo(f"wrote {path}: {origin}, {len(text.splitlines())} lines", err=True)
    if not quiet:
        click.echo(f"next: muster check {path}; muster solve {path}", err=True)


def _template(path: Path) -> tuple[str, list[Path]]:
    template = Template(packaged_text("muster.cli", "init_template.yaml"))
    return template.substitute(name=json.dumps(path.stem, ensure_ascii=False), file=path), []


def _shipped(shipped: str) -> tuple[str, list[Path]]:
    """The text of a shipped mission, and the files of its map, which go beside it."""
    from muster.library import mission_names, mission_path
    from muster.mission.texts.near_matches import did_you_mean

    path = mission_path(shipped)
    if path is None:
        hint = did_you_mean(shipped, mission_names())
        raise ParameterError(f"--from: no shipped mission {shipped}; expected one of `muster missions`{hint}")
    if path.suffix != ".yaml":
        raise ParameterError(f"--from: {shipped} is no YAML; use it as it is: muster solve {shipped} --salesmen 3")
    text = path.read_text(encoding="utf-8")
    named = re.search(r"ros_yaml: (\S+)", text)
    if named is None:
        return text, []
    ros_map = path.parent / named[1]
    return text.replace(named[1], ros_map.name), sorted(ros_map.parent.glob(f"{ros_map.stem}.*"))
