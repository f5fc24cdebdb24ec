"""`muster study`: a published experiment, repeated beside its published numbers."""

from __future__ import annotations

import os
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, redirect_stdout
from io import StringIO
from itertools import takewhile
from pathlib import Path
from typing import TYPE_CHECKING

import click

from muster.cli.exits import DONE
from muster.cli.options.common import format_option, quiet_option
from muster.mission.errors import ParameterError

if TYPE_CHECKING:
    from muster_studies.effort import Effort
    from muster_studies.registry import Study
    from muster_studies.tables import Cell, Report, Table

_SHORT_HEADERS = {"iterations": "iter."}  # what is wider than its numbers
_LEAST_SECONDS = 0.01

output_option = click.option(
    "-o", "--output", type=click.Path(path_type=Path), metavar="FILE", help="Write the tables (.json, .md, or text)."
)


@click.command(short_help="Repeat a published experiment beside its published numbers.")
@click.argument("name", required=False)
@click.option("--list", "list_studies", is_flag=True, help="List the studies.")
@click.option("--tables", metavar="N,N", help="Only these tables, such as 3.2,3.5.")
@click.option("--seeds", type=click.IntRange(min=1), metavar="N", help="Seeds 0 to N-1.  [default: 10; with --quick 2]")
@click.option("--iterations", type=click.IntRange(min=0), metavar="N", help="Of random algorithms, in all tables.")
@click.option("--quick", is_flag=True, help="The published numbers of iterations only, and few seeds.")
@click.option(
    "--workers", type=click.IntRange(min=1), metavar="N", help="Processes.  [default: one for each processor]"
)
@format_option
@output_option
@click.option(
    "--plot", type=click.Path(path_type=Path, file_okay=False), metavar="DIR", help="Draw its figures into a folder."
)
@click.option(
    "--figures", metavar="N,N", help="With --plot: draw only these figures, such as 3.6,A.1, or all; make no tables."
)
@quiet_option
def command(  # noqa: PLR0913  the options of a verb
    name: str | None,
    list_studies: bool,
    tables: str | None,
    seeds: int | None,
    iterations: int | None,
    quick: bool,
    workers: int | None,
    form: str,
    output: Path | None,
    plot: Path | None,
    figures: str | None,
    quiet: bool,
    verbose: bool,
) -> int:
    """Repeat the published experiment NAME and print its tables, published and own numbers side by side.

    All own numbers are the judge's. Without NAME the studies are listed.
    """
    from muster_studies.effort import Effort
    from muster_studies.registry import study_named

    if name is None or list_studies:
        _list(form)
        return DONE
    study = study_named(name)
    effort = Effort(seeds=seeds, iterations=iterations, quick=quick, tables=_numbers(tables), figures=_numbers(figures))
    if output is not None and (output.is_dir() or not output.parent.is_dir()):
        raise ParameterError(f"{output}: cannot be written; expected a file in a folder that exists")
    _check_figures(study, effort, plot)
    if not effort.figures:
        with _progress_bar(not quiet, study.name) as on_done:
            report = study.run(effort, workers or os.cpu_count() or 1, on_done)
        show(report, form, output)
        if verbose:
            click.echo(f"{report.runs} runs, {report.cpu_s:.1f} s of processor time", err=True)
    if plot is not None:
        _draw(study, effort, plot)
    return DONE


def _numbers(given: str | None) -> tuple[str, ...]:
    return tuple(number.strip() for number in (given or "").split(",") if number.strip())


def _check_figures(study: Study, effort: Effort, plot: Path | None) -> None:
    """Raise what is wrong about figures before the runs, which can take long."""
    from muster_studies.figures import wanted_figures

    if plot is None:
        if effort.figures:
            raise ParameterError(f"--figures {','.join(effort.figures)}: --plot missing; expected --plot DIR beside it")
        return
    if not study.figures:
        raise ParameterError(f"--plot: study {study.name} has no figures; expected one that has, such as rvo")
    if effort.figures and effort.tables:
        raise ParameterError("--figures: given with --tables; expected one of them")
    wanted_figures(study.figures, effort)


def _draw(study: Study, effort: Effort, folder: Path) -> None:
    from muster_studies.figures import draw_figures

    folder.mkdir(parents=True, exist_ok=True)
    for path in draw_figures(study.figures, effort, folder):
        click.echo(f"drew {path}", err=True)


def _list(form: str) -> None:
    from muster.cli.tables.table import print_table
    from muster_studies.registry import STUDIES
    from muster_studies.tables import span

    if form == "json":
        click.echo(_json([_as_dict(study) for study in STUDIES.values()]))
        return
    rows = [
        (s.name, s.summary, span(s.tables), str(len(s.figures) or ""), ", ".join(s.extras)) for s in STUDIES.values()
    ]
    print_table(("study", "what it is", "tables", "figures", "extras"), rows, right=("figures",))


def _as_dict(study: Study) -> dict[str, object]:
    figures = [{"number": one.number, "source": one.source, "shows": one.shows} for one in study.figures]
    return {
        "name": study.name,
        "summary": study.summary,
        "tables": study.tables,
        "figures": figures,
        "extras": study.extras,
    }


def show(report: Report, form: str, output: Path | None) -> None:
    """Print a report, and write it to a file where one is given."""
    if form == "json":
        click.echo(_json(report.as_dict()))
    else:
        _print_report(report)
    if output is None:
        return
    if output.suffix == ".md":
        from muster_studies.markdown import as_markdown

        output.write_text(as_markdown(report, f"muster {' '.join(sys.argv[1:])}"), encoding="utf-8")
        return
    with redirect_stdout(StringIO()) as text:
        if form == "json" or output.suffix == ".json":
            click.echo(_json(report.as_dict()))
        else:
            _print_report(report)
    output.write_text(text.getvalue(), encoding="utf-8")


def _json(data: object) -> str:
    import json

    return json.dumps(data, indent=1)


def _print_report(report: Report) -> None:
    seeds = "" if report.seeds is None else f"seeds 0 to {report.seeds - 1}; "
    _print_text(f"{report.study}: {report.document}; {seeds}{report.runs} runs, {report.cpu_s:.1f} s of processor time")
    for line in (*report.legend, ""):
        _print_text(line)
    for table in report.tables:
        _print_table(table)


def _print_table(table: Table) -> None:
    from muster.cli.tables.table import print_table

    headers = [_SHORT_HEADERS.get(column, column) for column in table.columns]
    numeric = [header for k, header in enumerate(headers) if any(isinstance(row[k], int | float) for row in table.rows)]
    rows = [
        [_text(column, cell, table.decimals) for column, cell in zip(table.columns, row, strict=True)]
        for row in table.rows
    ]
    print_table(headers, _without_repetition(rows), title=_head(table), right=numeric)
    for note in table.notes:
        _print_text(note)
    _print_text("")


def _head(table: Table) -> str:
    """The heading, and under it when a cell has a check mark."""
    return _printable("\n".join(line for line in (table.heading, table.mark_rule) if line))


def _without_repetition(rows: Sequence[Sequence[str]]) -> Iterator[list[str]]:
    """Rows in which the first cells are empty as long as they are those of the row above."""
    above: Sequence[str] = ()
    for row in rows:
        same = sum(1 for _ in takewhile(lambda pair: pair[0] == pair[1], zip(row, above, strict=False)))
        yield [*[""] * same, *row[same:]]
        above = row


def _print_text(line: str) -> None:
    from rich.text import Text

    from muster.cli.tables.table import console

    console().print(Text(_printable(line)))


def _printable(text: str) -> str:
    """The text with `=` for a check mark where standard output cannot show one."""
    try:
        "✓".encode(sys.stdout.encoding or "utf-8")
    except UnicodeEncodeError:
        return text.replace("✓", "=")
    return text


def _text(column: str, cell: Cell, decimals: int) -> str:
    from muster.cli.tables.table import sequence

    if isinstance(cell, float):
        return "<0.01" if column == "s" and cell < _LEAST_SECONDS else f"{cell:.{decimals}f}"
    if isinstance(cell, tuple):
        if cell and isinstance(cell[0], float):
            return " to\n".join(f"{value:.2f}" for value in cell)
        return sequence([str(part) for part in cell])
    return "-" if cell is None else _printable(str(cell))


@contextmanager
def _progress_bar(wanted: bool, study: str) -> Iterator[Callable[[int, int], None] | None]:
    """A function that shows how many runs are done; None where nothing is to be shown."""
    if not wanted or not sys.stderr.isatty():
        yield None
        return
    from rich.console import Console
    from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

    columns = (TextColumn(study), BarColumn(), MofNCompleteColumn(), TextColumn("runs"), TimeElapsedColumn())
    with Progress(*columns, console=Console(stderr=True), transient=True) as bar:
        line = bar.add_task("", total=None)
        yield lambda done, whole: bar.update(line, completed=done, total=whole)
