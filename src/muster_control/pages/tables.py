"""Plain HTML tables, which are cheap also if they are long, and the way to the next page of a list."""

from __future__ import annotations

from collections.abc import Collection, Sequence
from html import escape
from urllib.parse import urlencode

from nicegui import ui

from muster_control.contract import MOST_ROWS

Cell = str | tuple[str, str]
"""Text, or words and the address that they link to."""


def table(
    heads: Sequence[str], rows: Sequence[Sequence[Cell]], *, label: str = "", numbers: Collection[int] = ()
) -> None:
    """Put a table into the page, of longer ones the first rows; `numbers` are columns that are set to the right."""
    ui.html(table_text(heads, rows[:MOST_ROWS], label=label, numbers=numbers), sanitize=False).classes("scrolling")
    if len(rows) > MOST_ROWS:
        ui.label(f"The first {MOST_ROWS} of {len(rows):,}.").classes("quiet")


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


def address(path: str, **query: object) -> str:
    """A path with those parameters that are not empty."""
    given = {name: value for name, value in query.items() if value not in ("", None)}
    return f"{path}?{urlencode(given)}" if given else path


def search_text(label: str, value: str, name: str = "words") -> str:
    """A field for words to search for, as HTML: what is typed stays, whatever else of the page changes."""
    words = f'aria-label="{escape(label)}" placeholder="{escape(label)}" value="{escape(value)}"'
    return f'<input class="search" type="search" id="search" name="{name}" {words}>'


def pager_text(first: str, following: str) -> str:
    """Links to the first page of a list and the next one, as HTML; empty addresses are left out."""
    links = (("First page", first, ""), ("Next page", following, ' rel="next"'))
    shown = [f'<a href="{escape(to)}"{rel}>{words}</a>' for words, to, rel in links if to]
    return f'<nav class="pager" aria-label="Pages">{"".join(shown)}</nav>' if shown else ""


def _cell(cell: Cell) -> str:
    if isinstance(cell, str):
        return escape(cell)
    words, address = cell
    return f'<a href="{escape(address)}">{escape(words)}</a>'
