"""`muster generate`: random missions of a family; each family is a command with its parameters as options."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence
from dataclasses import MISSING, Field, fields
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from muster.cli.options.common import format_option, quiet_option
from muster.mission.errors import ParameterError
from muster.mission.yaml_writer import YAML_SUFFIXES, yaml_text

if TYPE_CHECKING:
    from muster.generation.generator import Generator
    from muster.mission.model import Mission

_FILE = click.Path(path_type=Path)


class _Families(click.Group):
    """The families, each a command that is made when it is called."""

    def list_commands(self, ctx: click.Context) -> list[str]:
        from muster.generation.registry import GENERATORS

        return list(GENERATORS)

    def get_command(self, ctx: click.Context, cmd_name: str) -> click.Command:
        from muster.generation.registry import GENERATORS

        return _command_of(GENERATORS.named(cmd_name))

    def format_commands(self, ctx: click.Context, formatter: click.HelpFormatter) -> None:
        from muster.generation.registry import GENERATORS

        with formatter.section("Families"):
            formatter.write_dl([(one.name, one.summary) for one in GENERATORS.usable().values()])


@click.group(cls=_Families, invoke_without_command=True, subcommand_metavar="FAMILY [OPTIONS]")
@click.option("--list", "listed", is_flag=True, help="List the families with their parameters and defaults.")
@format_option
@quiet_option
@click.pass_context
def command(ctx: click.Context, listed: bool, form: str, quiet: bool, verbose: bool) -> None:
    """Write random missions of a FAMILY, for tests and comparisons.

    The same family, parameters and seed give the same file on every machine. `muster generate FAMILY --help` lists the
    parameters of a family.
    """
    ctx.obj = quiet
    if listed:
        _list(form)
        ctx.exit()
    if form != "table":
        raise click.UsageError("--format without --list; missions are written as YAML", ctx)
    if ctx.invoked_subcommand is None:
        raise click.UsageError("FAMILY missing; expected one of `muster generate --list`", ctx)


def _command_of(generator: Generator) -> click.Command:
    """The command of a family."""
    own = [_option(f) for f in fields(generator.parameters) if _type(f) in _METAVARS]
    common = [
        click.Option(["--count"], type=int, default=1, show_default=True, metavar="N", help="How many missions."),
        click.Option(
            ["--seed"],
            type=int,
            default=0,
            show_default=True,
            metavar="N",
            help="Seed of the first; the next has the next.",
        ),
        click.Option(
            ["-o", "--output"],
            type=_FILE,
            metavar="PLACE",
            help="Folder to write to, made where it is not there; a file, .yaml, for a single mission.",
        ),
        click.Option(["-q", "--quiet"], is_flag=True, help="No messages on standard error, errors aside."),
    ]

    @click.pass_obj
    def write(group_quiet: bool, /, count: int, seed: int, output: Path | None, quiet: bool, **values: Any) -> None:
        given = {name: value for name, value in values.items() if value is not None}
        _write(generator, given, count, seed, output, quiet or group_quiet)

    source = f"Source: {generator.source}."
    return click.Command(
        generator.name,
        params=[*own, *common],
        callback=write,
        help=f"{generator.summary[0].upper()}{generator.summary[1:]}.",
        epilog=source,
    )


def _option(f: Field[Any]) -> click.Option:
    """A parameter as an option; without a value the family's own default holds."""
    name, kind = f.name.replace("_", "-"), _type(f)
    declared = [f"--{name}/--no-{name}" if kind is bool else f"--{name}", f.name]
    choices = getattr(f.metadata.get("kind"), "words", None)
    return click.Option(
        declared,
        type=kind,
        default=None,
        metavar=f"[{'|'.join(choices)}]" if choices else _METAVARS[kind],
        help=_help(f),
    )


_METAVARS: dict[type[Any], str | None] = {bool: None, int: "N", float: "X", str: "NAME"}
"""What an option may be; parameters of other types are for Python alone."""


def _type(f: Field[Any]) -> type[Any]:
    """The type of a parameter's values: that of its default, or of the first number that its kind has in its place."""
    default, kind = _default(f), f.metadata.get("kind")
    return type(kind.filler if default is None and kind is not None else default)


def _default(f: Field[Any]) -> Any:
    return f.default if f.default_factory is MISSING else f.default_factory()


def _help(f: Field[Any]) -> str:
    from muster.mission.values.field_help import unit_of

    text, unit = f.metadata.get("doc", ""), unit_of(f)
    default = "" if _default(f) is None else f"  [default: {_shown(_default(f))}]"
    return f"{text[:1].upper()}{text[1:]}{f', in {unit}' if unit else ''}.{default}".lstrip(".")


def _shown(value: object) -> str:
    return f"{value:g}" if isinstance(value, float) else ("no", "yes")[value] if isinstance(value, bool) else str(value)


def _list(form: str) -> None:
    from muster.cli.tables.table import print_table
    from muster.generation.registry import GENERATORS

    families = GENERATORS.usable().values()
    if form == "json":
        click.echo(json.dumps([_as_data(one) for one in families], indent=1))
        return
    rows = [
        (one.name, one.summary, ", ".join(f"{f.name}={_given(_default(f))}" for f in fields(one.parameters)))
        for one in families
    ]
    print_table(("family", "what it is", "parameters and defaults"), rows)


def _given(default: object) -> str:
    return "(drawn)" if default is None else _shown(default)


def _as_data(generator: Generator) -> dict[str, Any]:
    from muster.mission.values.field_help import unit_of

    parameters = [
        {"name": f.name, "unit": unit_of(f) or None, "default": _default(f), "meaning": f.metadata.get("doc", "")}
        for f in fields(generator.parameters)
    ]
    return {
        "family": generator.name,
        "summary": generator.summary,
        "source": generator.source,
        "parameters": parameters,
    }


def _write(
    generator: Generator, values: dict[str, Any], count: int, seed: int, output: Path | None, quiet: bool
) -> None:
    """Print one mission, or write all, and print the names of the files."""
    from muster.generation.generate import generate

    if output is None and count > 1:
        raise ParameterError(f"--count: {count} without -o; expected -o FOLDER")
    missions = generate(generator.name, count, seed, **values)
    if output is None:
        click.echo(yaml_text(missions[0]), nl=False)
    else:
        for file in _written(missions, output):
            click.echo(str(file))
        if not quiet:
            click.echo(f"next: muster compare {output} --allocators search,greedy,auction", err=True)


def _written(missions: Sequence[Mission], output: Path) -> Iterator[Path]:
    """The files, each after it is written; a file that is there is left alone where it is the same.

    Raises
    ------
    ParameterError
        before any file is written, if one is there that is another.
    """
    from muster.mission.texts.text_files import write_text

    texts = {_file(mission, output, len(missions)): yaml_text(mission) for mission in missions}
    for file, text in texts.items():
        if file.exists() and file.read_bytes() != text.encode():
            raise ParameterError(f"{file}: exists, with another content; expected the name of a new file")
    if output.suffix not in YAML_SUFFIXES:
        output.mkdir(parents=True, exist_ok=True)
    for file, text in texts.items():
        write_text(file, text)
        yield file


def _file(mission: Mission, output: Path, count: int) -> Path:
    if output.suffix == ".json":
        raise ParameterError(f"--output: {output}; expected a folder, or a file .yaml")
    if output.suffix not in YAML_SUFFIXES:
        return output / f"{mission.name}.yaml"
    if count > 1:
        raise ParameterError(f"--output: {output}; expected a folder for {count} missions")
    return output
