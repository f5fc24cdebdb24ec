"""Tables on standard output."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import Any

_WIDTH_WITHOUT_TERMINAL = 120
_MOST_TASKS_SHOWN = 60
_MOST_STYLED = 200  # rows; more are printed as lines where nothing folds
_LONGEST_WORD = 10  # that is not folded where there is little room


def print_table(
    columns: Sequence[str], rows: Iterable[Sequence[str]], *, title: str = "", right: Sequence[str] = ()
) -> None:
    """Print a table; columns named in `right` are set to the right.

    In a narrow terminal words wrap and figures do not: a table may be wider than the terminal.
    """
    listed = [tuple(row) for row in rows]
    out = console()
    widths = _widths([(name, [row[k] for row in listed]) for k, name in enumerate(columns)], right, out.width)
    if len(listed) > _MOST_STYLED and not out.options.ascii_only and _is_plain((columns, *listed), widths):
        _print_lines(columns, listed, widths, title, right)
        return
    from rich import box
    from rich.table import Table

    table = Table(
        box=box.SIMPLE_HEAD,
        title=_plain(title) if title else None,
        title_justify="left",
        title_style="bold",
        pad_edge=False,
    )
    for column, width in zip(columns, widths, strict=True):
        justify: Any = "right" if column in right else "left"
        table.add_column(_plain(column), justify=justify, overflow="fold", width=width)
    for row in listed:
        table.add_row(*(_plain(cell) for cell in row))
    out.width = max(out.width, _whole(widths))
    out.print(table)


def _is_plain(rows: Iterable[Sequence[str]], widths: Sequence[int]) -> bool:
    """Whether each cell is one line that fits into its column."""
    return all(
        "\n" not in cell and _width(cell) <= width for row in rows for cell, width in zip(row, widths, strict=True)
    )


def _print_lines(
    columns: Sequence[str], rows: Iterable[Sequence[str]], widths: Sequence[int], title: str, right: Sequence[str]
) -> None:
    """Print a table of many rows, in which nothing folds, as it is printed else: that takes a millisecond a row."""
    import click

    def line(cells: Sequence[str]) -> str:
        room = [" " * (width - _width(cell)) for cell, width in zip(cells, widths, strict=True)]
        set_right = [name in right for name in columns]
        padded = [
            f"{gap}{cell}" if at else f"{cell}{gap}" for cell, gap, at in zip(cells, room, set_right, strict=True)
        ]
        return f" {'   '.join(padded)} "

    whole = _whole(widths)
    titles = [click.style(title.ljust(whole), bold=True)] if title else []
    head = [" " * whole, click.style(line(columns), bold=True), f" {'─' * (whole - 2)} "]
    click.echo("\n".join([*titles, *head, *map(line, rows), " " * whole]))


def _widths(columns: Sequence[tuple[str, Sequence[str]]], right: Sequence[str], room: int) -> list[int]:
    """Widths of columns (head, cells): those of their cells; without room for that, narrow columns grow first."""
    lines_of = [[line for cell in (head, *cells) for line in cell.split("\n")] for head, cells in columns]
    wanted = list(map(_widest, lines_of))
    if _whole(wanted) <= room:
        return wanted
    widths = []
    for (head, _), lines in zip(columns, lines_of, strict=True):
        words = min(_LONGEST_WORD, _widest([word for line in lines for word in line.split()]))
        widths.append(max(_widest(head.split()), _widest(lines[1:])) if head in right else words)
    spare = room - _whole(widths)
    while spare > 0 and widths != wanted:
        _, k = min((width, k) for k, width in enumerate(widths) if width < wanted[k])
        widths[k], spare = widths[k] + 1, spare - 1
    return widths


def _whole(widths: Sequence[int]) -> int:
    """The width of a table: three spaces between columns, one before and one after."""
    return sum(widths) + 3 * len(widths) - 1


def _widest(texts: Iterable[str]) -> int:
    return max(map(_width, texts), default=0)


def _width(text: str) -> int:
    """The columns that a text takes in a terminal."""
    from rich.cells import cell_len

    return len(text) if text.isascii() else cell_len(text)


def _plain(cell: str) -> Any:
    from rich.text import Text

    return Text(cell)


def console() -> Any:
    """Standard output; as wide as the terminal, or of a fixed width into files and pipes."""
    from rich.console import Console

    class Terminal(Console):
        def on_broken_pipe(self) -> None:
            raise BrokenPipeError  # for `main` to turn into an exit code; rich's own would be that of a rejected plan

    return Terminal(file=sys.stdout, width=None if sys.stdout.isatty() else _WIDTH_WITHOUT_TERMINAL, highlight=False)


def sequence(tasks: Sequence[str]) -> str:
    """A route's tasks in a cell."""
    shown = ", ".join(tasks[:_MOST_TASKS_SHOWN])
    more = len(tasks) - _MOST_TASKS_SHOWN
    return f"{shown}, ... and {more} more" if more > 0 else shown or "-"


def number(value: float | None, unit: str = "") -> str:
    """A figure in a cell."""
    return "-" if value is None else f"{value:.2f} {unit}".rstrip()
