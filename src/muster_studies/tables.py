"""Tables as data, for a person's terminal and for programs alike. Immutable."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

CHECK_MARK = "✓"
"""The mark of an own value that equals a published one of the same measure."""

Cell = str | int | float | tuple[str, ...] | tuple[float, float] | None
"""A word, a count, a figure, a sequence of ids, a range of figures, or nothing."""


@dataclass(frozen=True)
class Table:
    """One table; each row has a cell for each column.

    Parameters
    ----------
    decimals
        of figures on a person's screen.
    mark_rule
        when a cell has a check mark; it is shown in the head of the table.

    Raises
    ------
    ValueError
        if a cell has a check mark, and the table no rule for it.
    """

    number: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()
    decimals: int = 2
    mark_rule: str = ""

    def __post_init__(self) -> None:
        ticked = any(isinstance(cell, str) and CHECK_MARK in cell for row in self.rows for cell in row)
        if ticked and not self.mark_rule.startswith(f"{CHECK_MARK}: "):
            raise ValueError(f"{self.heading}: check marks without their rule; expected mark_rule, '{CHECK_MARK}: ...'")

    @classmethod
    def of_cells(
        cls,
        number: str,
        title: str,
        cells: Iterable[Mapping[str, Cell]],
        notes: tuple[str, ...] = (),
        *,
        decimals: int = 2,
        mark_rule: str = "",
    ) -> Table:
        """Return the table whose rows have these cells by column; columns are in the order in which rows name them."""
        named = list(cells)
        columns = tuple(dict.fromkeys(column for one in named for column in one))
        return cls(number, title, columns, tuple(row(columns, one) for one in named), notes, decimals, mark_rule)

    @property
    def heading(self) -> str:
        """Number and title; a number that is a name stands for itself."""
        return f"{'Table ' if _is_printed(self.number) else ''}{self.number}. {self.title}"

    def records(self) -> list[dict[str, Cell]]:
        """The rows as mappings from column to cell."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def as_dict(self) -> dict[str, Any]:
        return {
            "number": self.number,
            "title": self.title,
            "mark_rule": self.mark_rule,
            "columns": list(self.columns),
            "rows": self.records(),
            "notes": list(self.notes),
        }


@dataclass(frozen=True, kw_only=True)
class Report:
    """The result of a study.

    `cpu_s` is the processor time of all `runs`; only times differ between repetitions. `seeds` is None where nothing is
    random.
    """

    study: str
    document: str
    seeds: int | None
    runs: int
    cpu_s: float
    legend: tuple[str, ...]
    tables: tuple[Table, ...]

    def as_dict(self) -> dict[str, Any]:
        return {
            "study": self.study,
            "document": self.document,
            "seeds": self.seeds,
            "runs": self.runs,
            "cpu_s": self.cpu_s,
            "legend": list(self.legend),
            "tables": [table.as_dict() for table in self.tables],
        }


class Notes:
    """The numbered notes of one table, while it is made; the same text twice is one note."""

    def __init__(self) -> None:
        self._texts: dict[str, int] = {}

    def number(self, text: str) -> str:
        """How a cell refers to the note, such as `(2)`."""
        return f"({self._texts.setdefault(text, len(self._texts) + 1)})"

    def lines(self) -> tuple[str, ...]:
        return tuple(f"({number}) {text}" for text, number in self._texts.items())


def row(columns: tuple[str, ...], cells: Mapping[str, Cell]) -> tuple[Cell, ...]:
    """Cells by name in the order of the columns; a missing cell is empty."""
    return tuple(cells.get(column) for column in columns)


MOST_NAMES = 4


def span(numbers: Sequence[str]) -> str:
    """The numbers of tables in short, such as `3.2 to 3.22`; of those that are names the first few."""
    printed = [number for number in numbers if _is_printed(number)]
    names = [number for number in numbers if not _is_printed(number)]
    more = [f"{len(names) - MOST_NAMES} more"] if len(names) > MOST_NAMES else []
    return ", ".join([*([f"{printed[0]} to {printed[-1]}"] if printed else []), *names[:MOST_NAMES], *more])


def _is_printed(number: str) -> bool:
    """Whether this is the number of a table in a document, such as `3.2`."""
    return number.replace(".", "").isdecimal()
