"""Tables on standard output."""

from __future__ import annotations

import sys
from collections.abc import Iterable, Sequence
from typing import Any

_WIDTH_WITHOUT_TERMINAL = 120
_MOST_TASKS_SHOWN = 60


def print_table(
    columns: Sequence[str], rows: Iterable[Sequence[str]], *, title: str = "", right: Sequence[str] = ()
) -> None:
    """Print a table; columns named in `right` are set to the right."""
    from rich import box
    from rich.table import Table

    table = Table(
        box=box.SIMPLE_HEAD,
        title=_plain(title) if title else None,
        title_justify="left",
        title_style="bold",
        pad_edge=False,
    )
    for column in columns:
        table.add_column(_plain(column), justify="right" if column in right else "left", overflow="fold")
    for row in rows:
        table.add_row(*(_plain(cell) for cell in row))
    console().print(table)


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
