"""A table that is edited cell by cell; its rows are drawn by a script in the browser, however many there are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from nicegui.element import Element


@dataclass(frozen=True)
class Column:
    """A column: its key, its kind (a choice, or one of `cell_texts`), and its meaning."""

    key: str
    kind: str = "text"
    choices: tuple[str, ...] = ()
    hint: str = ""


class Table(Element, component="table.js"):
    """Emits `cell`, `add`, and `drop` with the id of a row.

    `cell` comes with `{row, id, key, value}`: the row's number and id, empty where it has none, and what was typed.
    That is shown until the table is told to `forget` it, whatever else changes meanwhile.
    """

    def __init__(self, title: str, *, editable: bool, grows: bool = True) -> None:
        super().__init__()
        self.props["title"] = title
        self.props["editable"] = editable
        self.props["grows"] = grows
        self.props["columns"] = []
        self.props["rows"] = []

    def show(self, columns: Sequence[Column], rows: Sequence[Mapping[str, str]]) -> None:
        """Show rows, each a mapping from keys of columns to what their cells say; what is there is not sent again."""
        shown = {"columns": [asdict(column) for column in columns], "rows": [dict(row) for row in rows]}
        for name, value in shown.items():
            if self.props[name] != value:
                self.props[name] = value

    def forget(self) -> None:
        """Show what the rows say in place of what was typed into cells: it has been taken, or refused."""
        self.run_method("forget")
