"""Tables in HTML, for notebooks: short, and with every text escaped."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from html import escape

MOST_ROWS = 20


def html_table(title: str, columns: Sequence[str], rows: Iterable[Sequence[object]]) -> str:
    """A table under its title; of many rows the first, and how many more there are."""
    listed = list(rows)
    shown, more = listed[:MOST_ROWS], len(listed) - MOST_ROWS
    head = "".join(f"<th>{escape(name)}</th>" for name in columns)
    body = "".join("<tr>" + "".join(f"<td>{_cell(cell)}</td>" for cell in row) + "</tr>" for row in shown)
    rest = f'<tr><td colspan="{len(columns)}">and {more} more</td></tr>' if more > 0 else ""
    return f"<table><caption>{escape(title)}</caption><tr>{head}</tr>{body}{rest}</table>"


def html_line(text: str) -> str:
    """A line of text."""
    return f"<p>{escape(text)}</p>"


def _cell(value: object) -> str:
    if value is None:
        return "-"
    if isinstance(value, float):
        return f"{value:.2f}"
    if isinstance(value, tuple | list):
        return escape(", ".join(f"{item:g}" if isinstance(item, float) else str(item) for item in value))
    return escape(str(value))
