"""A table that is edited cell by cell; its rows are drawn by a script in the browser, however many there are."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass

from nicegui.element import Element


@dataclass(frozen=True)
class Column:
    """A column: its key, which stands above it; what is typed: text, number, words or a choice; and what it means."""

    key: str
    kind: str = "text"
    choices: tuple[str, ...] = ()
    hint: str = ""


class Table(Element, component="table.js"):
    """Emits `cell` with `{row, key, value}` (the value as it was typed), `add`, and `drop` with the name of a row."""

    def __init__(self, title: str, *, editable: bool, grows: bool = True) -> None:
        super().__init__()
        self.props["title"] = title
        self.props["editable"] = editable
        self.props["grows"] = grows
        self.props["columns"] = []
        self.props["rows"] = []
        self.props["revision"] = 0

    def show(self, columns: Sequence[Column], rows: Sequence[Mapping[str, str]]) -> None:
        """Show rows, each a mapping from keys of columns to what their cells say.

        What is shown already is not sent again: it would take the place of what somebody is typing.
        """
        shown = {"columns": [asdict(column) for column in columns], "rows": [dict(row) for row in rows]}
        for name, value in shown.items():
            if self.props[name] != value:
                self.props[name] = value

    def forget(self) -> None:
        """Show again what is, in place of what was typed and refused."""
        self.props["revision"] += 1
