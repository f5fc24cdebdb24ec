"""Tables of what is planned and carried out: pandas DataFrames (extra `frames`), and HTML for notebooks.

HTML is short, and every text in it escaped. Pandas is loaded when a DataFrame is made.
"""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict, fields
from html import escape
from typing import TYPE_CHECKING, Any

from muster.mission.records import Checked, all_keys, specified
from muster.mission.system.extras import needs_extra

if TYPE_CHECKING:
    from pandas import DataFrame

MOST_ROWS = 20


def data_frame(rows: Iterable[Mapping[str, Any]], columns: Iterable[str]) -> DataFrame:
    """A DataFrame of rows; with these columns, also where there is no row.

    Raises
    ------
    MissingExtraError
        without pandas.
    """
    with needs_extra("frames", "a DataFrame"):
        from pandas import DataFrame
    return DataFrame(list(rows), columns=list(columns))


def frame_of_records(kind: type[Any], records: Iterable[Any]) -> DataFrame:
    """A DataFrame with a row for each instance of a dataclass and a column for each of its fields.

    A column of numbers that are all missing is one of numbers (NaN), as where some are.
    """
    of_rules = all_keys(kind)[len(specified(kind)) :] if issubclass(kind, Checked) else ()
    columns = [*(f for f in fields(kind) if f.name != "extra"), *of_rules]
    frame = data_frame(map(_row, records), [f.name for f in columns])
    numbers = [f.name for f in columns if str(f.type) in ("int | None", "float | None")]
    missing = [name for name in numbers if frame[name].isna().all()]
    return frame.astype(dict.fromkeys(missing, float))


def _row(one: Any) -> dict[str, Any]:
    """The fields of a record, and what it says by keys of rules."""
    own = asdict(one)
    extra: dict[str, Any] = own.pop("extra", {})
    return own | extra


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
