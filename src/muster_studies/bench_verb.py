"""`muster bench`: speed on this machine; `peers`, ...: quality against other solvers; `scale`: against time."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import asdict
from pathlib import Path
from typing import Any

import click

from muster.cli.options.common import format_option, quiet_option
from muster.mission.errors import MissingExtraError, ParameterError
from muster.mission.system.platforms import require_posix
from muster.mission.value_types import shown
from muster.mission.values.keywords import require_one_of
from muster_studies import study_verb
from muster_studies.benches import BENCHES, bench_named
from muster_studies.descriptions import comparisons

_Verb = Callable[..., Any]

_seeds_option = click.option(
    "--seeds", type=click.IntRange(min=1), metavar="N", help="Seeds 0 to N-1.  [default: 3; with --quick 1]"
)


def _comparison_options(*, quick: str, tables: str | None = None) -> Callable[[_Verb], _Verb]:
    """The options of a comparison with others: what `--quick` does, and the tables to choose from, if several."""

    def decorate(verb: _Verb) -> _Verb:
        verb = format_option(study_verb.output_option(quiet_option(click.pass_context(verb))))
        verb = _seeds_option(click.option("--quick", is_flag=True, help=quick)(verb))
        if tables is None:
            return verb
        return click.option("--tables", metavar="N,N", help=f"Only these tables: {tables}.")(verb)

    return decorate


@click.group(invoke_without_command=True, short_help="Measure speed on this machine, or quality against other solvers.")
@click.option("--only", metavar="NAMES", help=f"Some of: {', '.join(BENCHES)}.")
@click.option("--runs", type=click.IntRange(min=1), default=5, show_default=True, help="Runs of each; medians count.")
@format_option
@quiet_option
@click.pass_context
def command(ctx: click.Context, only: str | None, runs: int, form: str, quiet: bool, verbose: bool) -> None:
    """Measure speed on this machine: medians over runs, with the range, beside the aim.

    Without --only a bench that needs a part that is not installed is skipped, with a line that says so.
    """
    import json

    from muster.cli.tables.table import print_table

    if ctx.invoked_subcommand is not None:
        return
    require_posix("muster bench")
    names = list(BENCHES) if only is None else [name.strip() for name in only.split(",")]
    for name in names:
        require_one_of("--only", name, BENCHES)
    found = []
    for name in names:
        if not quiet:
            click.echo(f"measuring {name} ...", err=True)
        try:
            found += bench_named(name)(runs)
        except MissingExtraError as error:
            if only is not None:
                raise
            click.echo(f"skipped {name}: {error}", err=True)
    if form == "json":
        click.echo(json.dumps([asdict(m) for m in found], indent=1))
        return
    rows = [
        (m.name, _figure(m.median), f"{_figure(m.lowest)} - {_figure(m.highest)}", m.unit, m.aim, m.note) for m in found
    ]
    print_table(("what", "median", "range", "unit", "aim", "note"), rows, right=("median", "range"))


def _compare(ctx: click.Context, /, **options: Any) -> int:
    return int(ctx.invoke(study_verb.command, name=ctx.info_name, **options))


for _name, _words in comparisons().items():
    _options = _comparison_options(quick=_words.quick, tables=_words.tables)
    command.command(_name, help=_words.help)(_options(_compare))


@command.command("scale")
@click.option("--tasks", metavar="N,N", default="100,1000,10000,100000", show_default=True, help="Sizes of missions.")
@click.option("--seconds", metavar="S,S", default="1,5,20,60", show_default=True, help="Time limits.")
@click.option(
    "--kept",
    type=click.Path(path_type=Path, dir_okay=False),
    metavar="FILE",
    help="Add each run to this file; those that it has are not made again.",
)
@format_option
@study_verb.output_option
@quiet_option
def scale(
    tasks: str, seconds: str, kept: Path | None, form: str, output: Path | None, quiet: bool, verbose: bool
) -> None:
    """Measure quality against time from 100 to 100,000 tasks: greedy, auction and search."""
    from muster_studies import scale as scales

    def told(run: scales.Run) -> None:
        click.echo(f"{run.tasks} tasks, {run.allocator}, {run.limit_s:g} s: {run.wall_s:.1f} s", err=True)

    sizes = [_one_of(name, scales.ROBOTS) for name in tasks.split(",")]
    report = scales.scale(sizes, [_seconds(text) for text in seconds.split(",")], kept, None if quiet else told)
    study_verb.show(report, form, output)


def _one_of(text: str, sizes: Mapping[int, int]) -> int:
    if text.strip() not in map(str, sizes):
        raise ParameterError(f"--tasks: {shown(text)}; expected {' or '.join(map(str, sizes))}")
    return int(text)


def _seconds(text: str) -> float:
    try:
        seconds = float(text)
    except ValueError:
        seconds = 0.0
    if not 0 < seconds < math.inf:
        raise ParameterError(f"--seconds: {shown(text.strip())}; expected numbers above 0, separated by commas")
    return seconds


def _figure(value: float) -> str:
    return f"{value:,.0f}" if value >= 1000 else f"{value:.3g}" if abs(value) >= 1e-3 else "0"
