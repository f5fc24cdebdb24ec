"""Plain HTML tables, which are cheap also if they are long."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from html import escape

from nicegui import ui

Cell = str | tuple[str, str]
"""Text, or words and the address that they link to."""


def table(
    heads: Sequence[str], rows: Sequence[Sequence[Cell]], *, label: str = "", numbers: Collection[int] = ()
) -> None:
    """Put a table into the page; `numbers` are columns whose cells are set to the right."""
    ui.html(table_text(heads, rows, label=label, numbers=numbers), sanitize=False).classes("scrolling")


def table_text(
    heads: Sequence[str], rows: Sequence[Sequence[Cell]], *, label: str = "", numbers: Collection[int] = ()
) -> str:
    """The table as HTML, with all texts escaped."""
    look = [' class="number"' if k in numbers else "" for k in range(len(heads))]
    head = "".join(f'<th scope="col"{look[k]}>{escape(words)}</th>' for k, words in enumerate(heads))
    body = "".join(
        "<tr>" + "".join(f"<td{look[k]}>{_cell(cell)}</td>" for k, cell in enumerate(row)) + "</tr>" for row in rows
    )
    named = f' aria-label="{escape(label)}"' if label else ""
    return f'<table class="plain"{named}><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>'


def _cell(cell: Cell) -> str:
    if isinstance(cell, str):
        return escape(cell)
    words, address = cell
    return f'<a href="{escape(address)}">{escape(words)}</a>'
