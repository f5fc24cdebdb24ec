"""The log of a run, compressed in memory, for times when the database cannot be read."""

from __future__ import annotations

import json
import zlib
from collections.abc import Iterator, Sequence
from datetime import datetime
from typing import Any

from muster.exchange.mission_control import Entry

_BLOCK = 2**18
"""Characters that are packed together, to a tenth or less."""


class PackedLog:
    """Entries in order."""

    def __init__(self) -> None:
        self._packed: list[bytes] = []
        self._loose: list[str] = []
        self._size = 0

    def add(self, entries: Sequence[Entry]) -> None:
        """Add entries."""
        for entry in entries:
            text = _text(entry)
            self._loose.append(text)
            self._size += len(text)
            if self._size > _BLOCK:
                self._packed.append(zlib.compress("\n".join(self._loose).encode(), level=1))
                self._loose, self._size = [], 0

    def entries(self) -> Iterator[Entry]:
        """All entries."""
        for block in self._packed:
            yield from map(_entry, zlib.decompress(block).decode().split("\n"))
        yield from map(_entry, self._loose)


def _text(entry: Entry) -> str:
    said: dict[str, Any] = vars(entry) | {"at": entry.at and entry.at.isoformat(), "data": dict(entry.data)}
    return json.dumps(said, separators=(",", ":"))


def _entry(text: str) -> Entry:
    said = json.loads(text)
    return Entry(**said | {"at": said["at"] and datetime.fromisoformat(said["at"])})
