"""The ledger of a site: what became of every element of its files."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from muster.mission.errors import MissionError
from muster.mission.import_ledger import Ledger, LedgerBook, joined
from muster_files.sites.entries import Entry
from muster_files.sites.features import HEIGHT, Document, Layer

_ROUTE = "is a route of a plan: Muster plans it anew"
_TO_NOBODY = "is a zone that is forbidden to nobody"
_FLAT = "heights are left out, as some places have none or --flat says so"


def left_out(entries: Sequence[Entry], data: Mapping[str, Any], *, flat: bool) -> None:
    """Mark what was made to entries, and is not in the data of the mission after all.

    Raises
    ------
    MissionError
        if heights of a flight are left out, and a user has not said so (`flat`).
    """
    groups = ("robots", "tasks", "stations")
    in_plane = not any(len(one["position"]) == 3 for group in groups for one in data.get(group, ()))
    for entry in entries:
        source = entry.feature.source
        if entry.role == "route":
            source.drop(_ROUTE)
        elif entry.role == "zone" and entry.values.get("forbidden_to") == []:
            source.drop(_TO_NOBODY)
        elif in_plane and entry.height is not None:
            if source.needs_height and not flat:
                expected = (
                    "heights of all robots and places (alt) beside absolute ones; or --flat, which leaves them out"
                )
                raise MissionError([entry.feature.finding("height", f"{entry.height:g} m", expected)])
            headings = [column.heading for key, column in entry.columns.by_key.items() if key in ("alt", "z")]
            source.lose(_FLAT, HEIGHT, *headings)


def ledger_of(layers: Sequence[Layer]) -> Ledger:
    """Return the ledger of all files of which there are layers."""
    documents: dict[int, tuple[str, Document]] = {}
    for layer in layers:
        document = layer.document or _Values(layer)
        documents[id(document)] = layer.file, document
    books: dict[str, LedgerBook] = {}
    for file, document in documents.values():
        document.enter(books.setdefault(file, LedgerBook(file)))
    return joined(book.ledger() for book in books.values())


class _Values:
    """A layer of a reader that says nothing of its file: what the reader has made of it, not what is in the file."""

    def __init__(self, layer: Layer) -> None:
        self._layer = layer

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every value of each feature."""
        for feature in self._layer.features:
            for heading, value in feature.values.items():
                book.add(heading, feature.source.fate(heading, value), feature.where)
