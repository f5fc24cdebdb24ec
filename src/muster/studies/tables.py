"""Tables as data, for a person's terminal and for programs alike. Immutable."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

Cell = str | int | float | tuple[str, ...] | tuple[float, float] | None
"""A word, a count, a figure, a sequence of ids, a range of figures, or nothing."""


@dataclass(frozen=True)
class Table:
    """One table; each row has a cell for each column."""

    number: str
    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[Cell, ...], ...]
    notes: tuple[str, ...] = ()

    def records(self) -> list[dict[str, Cell]]:
        """The rows as mappings from column to cell."""
        return [dict(zip(self.columns, row, strict=True)) for row in self.rows]

    def as_dict(self) -> dict[str, Any]:
        return {
            "number": self.number,
            "title": self.title,
            "columns": list(self.columns),
            "rows": self.records(),
            "notes": list(self.notes),
        }


@dataclass(frozen=True, kw_only=True)
class Report:
    """What a study found. `cpu_s` is the processor time of all `runs`; only times differ between repetitions."""

    study: str
    document: str
    seeds: int
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
    """Cells by name in the order of the columns; what is not there is empty."""
    return tuple(cells.get(column) for column in columns)
