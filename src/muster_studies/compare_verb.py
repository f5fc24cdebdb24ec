"""`muster compare`: allocators on many missions, and what statistics say of them."""

from __future__ import annotations

import logging
import shlex
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exits import DONE, INCOMPLETE, INTERRUPTED
from muster.cli.options.common import Finite, format_option, objective_option, quiet_option
from muster.cli.outputs import require_drawable, require_writable
from muster.mission.errors import ParameterError

if TYPE_CHECKING:
    from muster_studies.comparison.compare import Pending
    from muster_studies.comparison.comparison import Comparison
    from muster_studies.comparison.run import Run

_FILE = click.Path(path_type=Path)
_MOST_SECONDS = 1e6


@click.command()
@click.argument("more", nargs=-1, metavar="[MISSION]...")
@click.option(
    "-a",
    "--allocators",
    multiple=True,
    required=True,
    metavar="A,A",
    help="Allocators: names (muster solve --list-allocators), with parameters as in genetic:population_size=40; "
    "MODULE:NAME of your own.",
)
@click.option(
    "--missions",
    multiple=True,
    metavar="M,M",
    help="Files, 'PATTERNS', folders, shipped missions; or families of random ones, as in uniform:tasks=40:count=20.",
)
@click.option("--seeds", type=click.IntRange(min=1), default=10, show_default=True, metavar="N", help="Runs of each.")
@click.option("--seed", type=int, default=0, show_default=True, metavar="N", help="The first seed.")
@click.option("--jobs", type=click.IntRange(min=1), metavar="N", help="Processes.  [default: one for each processor]")
@click.option("--time-limit", type=float, metavar="S", help="Seconds of each run.  [default: 1, without --iterations]")
@click.option("--iterations", type=int, metavar="N", help="Stop each run after so many.")
@click.option(
    "--clock",
    type=click.Choice(("wall", "processor")),
    default="wall",
    show_default=True,
    help="What seconds are of; processor time is not used up by other programs.",
)
@objective_option
@click.option(
    "--give-up", type=Finite(0.001, _MOST_SECONDS), metavar="S", help="End a run that takes longer; its row says so."
)
@click.option("--against", metavar="A", help="Test pairs with this allocator alone.  [default: all with all]")
@click.option("-o", "--output", type=_FILE, metavar="CSV", help="Add each run to this file; begun again it goes on.")
@click.option("--report", type=_FILE, metavar="HTML", help="Write a page with tables, figures and what they mean.")
@click.option("--plot", type=_FILE, metavar="FILE", help="Draw performance profiles (.png, .svg, .pdf).")
@format_option
@quiet_option
def command(  # noqa: PLR0913  the options of a verb
    more: tuple[str, ...],
    allocators: tuple[str, ...],
    missions: tuple[str, ...],
    seeds: int,
    seed: int,
    jobs: int | None,
    time_limit: float | None,
    iterations: int | None,
    clock: str,
    objective: str | None,
    give_up: float | None,
    against: str | None,
    output: Path | None,
    report: Path | None,
    plot: Path | None,
    form: str,
    quiet: bool,
    verbose: bool,
) -> int:
    """Compare allocators on many missions; every plan is judged by `verify`.

    Each run has one thread. Ctrl-C keeps what there is; with -o the same command goes on from there.
    """
    from muster_studies.comparison.compare import begun
    from muster_studies.comparison.settings import Settings
    from muster_studies.comparison.specs import listed

    if quiet:
        logging.getLogger("muster").setLevel(logging.ERROR)
    if not 0 <= seed < 2**64:
        raise ParameterError(f"--seed: {seed}; expected a whole number from 0 to 2**64 - 1")
    _require_files(output, report, plot)
    pending = begun(
        (*missions, *more),
        listed(allocators),
        seeds=range(seed, seed + seeds),
        jobs=jobs,
        settings=Settings(
            time_limit=time_limit, iterations=iterations, clock=clock, objective=objective, give_up=give_up
        ),
        against=against,
        results=output,
    )
    if verbose and pending.made:
        click.echo(f"{output}: {pending.made} of {pending.total} runs are there", err=True)
    whole = _run(pending, quiet=quiet, verbose=verbose)
    comparison = pending.comparison()
    _show(comparison, form, report, plot)
    if not quiet:
        for line in comparison.notes:
            click.echo(line, err=True)
    if whole:
        return DONE if comparison.has_a_plan else INCOMPLETE
    if not quiet:
        kept = f"; {output} has them, the same command goes on" if output else "; with -o it could go on from there"
        click.echo(f"interrupted after {pending.made} of {pending.total} runs{kept}", err=True)
    return INTERRUPTED


def _require_files(output: Path | None, report: Path | None, plot: Path | None) -> None:
    """Refuse files that cannot be written, before hours of work."""
    require_writable(None, (output, report, plot), (), ())
    require_drawable(plot)
    if report is not None:
        from muster_studies.comparison.page import require_page

        require_page(report, "--report")
        require_drawable(report.with_suffix(".svg"))


def _run(pending: Pending, *, quiet: bool, verbose: bool) -> bool:
    """Make all runs; False where Ctrl-C came first."""
    try:
        with _progress(not quiet, pending) as show:

            def on_run(run: Run, made: int, total: int) -> None:
                show(run, made, total)
                if verbose and not run.is_done:
                    click.echo(f"{run.mission}, {run.allocator}, seed {run.seed}: {run.status}: {run.reason}", err=True)

            pending.run(on_run)
    except KeyboardInterrupt:
        return False
    return True


@contextmanager
def _progress(wanted: bool, pending: Pending) -> Iterator[Callable[[Run, int, int], None]]:
    """A function that shows each run as progress, on standard error and only on a terminal."""
    if not wanted or not sys.stderr.isatty():
        yield lambda run, made, total: None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeRemainingColumn

    last = TextColumn("{task.fields[last]}", markup=False)
    columns = (TextColumn("comparing"), BarColumn(), MofNCompleteColumn(), TimeRemainingColumn(), last)
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task("", total=pending.total, completed=pending.made, last="")

        def show(run: Run, made: int, total: int) -> None:
            bar.update(line, completed=made, last=f"{run.mission}, {run.allocator}")

        yield show


def _show(comparison: Comparison, form: str, report: Path | None, plot: Path | None) -> None:
    """Print the tables or all data; write the page and the picture."""
    if form == "json":
        import json

        click.echo(json.dumps(comparison.as_dict(), indent=1))
    else:
        _print_tables(comparison)
    if report is not None:
        comparison.save_report(report, command=f"muster {shlex.join(sys.argv[1:])}")
    if plot is not None:
        from muster.report.figures.files import save_figure

        save_figure(comparison.plot_profile(), plot)


def _print_tables(comparison: Comparison) -> None:
    from muster.cli.tables.table import print_table
    from muster_studies.comparison.cells import PAIR_COLUMNS, STANDING_COLUMNS, pair_cells, standing_cells

    title = f"{comparison.counts}; {comparison.settings.text} each"
    print_table(STANDING_COLUMNS, map(standing_cells, comparison.standings), title=title, right=STANDING_COLUMNS[1:])
    if comparison.pairs:
        right = tuple(name for name in PAIR_COLUMNS if name not in ("allocator", "other", "better"))
        print_table(PAIR_COLUMNS, map(pair_cells, comparison.pairs), title="In pairs", right=right)
