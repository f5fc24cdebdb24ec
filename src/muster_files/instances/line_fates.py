"""The lines of an instance file with the fate of each, for the ledger of the import."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path as FilePath

from muster.mission.import_ledger import UNKNOWN, Fate, Ledger, LedgerBook, read_as
from muster.mission.texts.text_files import read_text
from muster_files.number_rows import Row

_READ = read_as("itself")


class LineFates:
    """The fates of lines by their numbers; a line of which nothing is said has no meaning here."""

    def __init__(self) -> None:
        self._fates: dict[int, tuple[str, Fate]] = {}

    def say(self, line: int, kind: str, fate: Fate = _READ) -> None:
        """Say what a line is in the terms of the file, and what becomes of it."""
        self._fates[line] = kind, fate

    def read(self, kind: str, rows: Iterable[Row]) -> None:
        """Mark rows as read."""
        for row in rows:
            self.say(row.line, kind)

    def ledger(self, path: FilePath) -> Ledger:
        """Return the ledger of a file: each of its lines that is not blank is an element."""
        book = LedgerBook(str(path))
        for number, text in enumerate(read_text(path).splitlines(), 1):
            if text.strip():
                kind, fate = self._fates.get(number, ("line", UNKNOWN))
                book.add(kind, fate, f"line {number}")
        return book.ledger()
