"""Rows of cells as a layer: the first row that is not empty has the headings; titles may stand above it."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Iterator, Sequence
from itertools import chain
from textwrap import shorten

from muster.mission.import_ledger import Fate, LedgerBook, passed_over, read_as
from muster.mission.value_types import shown
from muster_files.sites.cells import NoValue
from muster_files.sites.features import Feature, Layer, refused
from muster_files.sites.file_sizes import MOST_COLUMNS, MOST_ROWS, require_few
from muster_files.sites.headings import means_something

Row = tuple[int, Sequence[object]]
"""The number of a row, from 1, and its cells."""
_LONGEST_TITLE = 60
MOST_TITLES = 5
"""Rows of a single cell that may stand above the headings."""


class TableDocument:
    """The cells of a table that are not empty: those of titles and headings, and of each row the ones under headings.

    Parameters
    ----------
    name
        of the sheet, if there is one.
    separator
        the sign that a cell above the table states as separator, if there is such a cell.
    """

    def __init__(self, name: str = "", separator: str = "") -> None:
        self._name = f"{name}: " if name else ""
        self._separator = separator
        self.titles: list[int] = []
        self.headings: tuple[int, Sequence[str]] = 1, ()
        self.rows: list[tuple[Feature, Sequence[str]]] = []
        """Features as they are in the table, each with the headings of its cells."""

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every cell."""
        if self._separator:
            book.add(f"sep={self._separator}", read_as("the separator"))
        for number in self.titles:
            book.add(f"{self._name}title", _TITLE, f"row {number}")
        groups: dict[tuple[Sequence[str], Fate | None, int], list[Feature]] = {}
        for feature, headings in self.rows:
            groups.setdefault((headings, feature.source.whole, feature.source.key), []).append(feature)
        read: set[str] = set()
        for (headings, _, _), features in groups.items():
            first = features[0]
            for heading in headings:
                fate = first.source.fate(heading, heading)
                read |= {heading} if fate.how == "read" else set()
                book.add(f"{self._name}{heading}", fate, f"row {first.line}", len(features))
        number, named = self.headings
        for heading in filter(None, named):
            book.add(f"{self._name}heading", _HEADING if heading in read else _UNUSED, f"row {number}")


_TITLE = passed_over("stands above the headings", noted=True)
_HEADING, _UNUSED = read_as("a heading"), passed_over("heads nothing that is read", minor=True)


def table_layer(file: str, name: str, rows: Iterable[Row], where: str = "", separator: str = "") -> Layer:
    """The layer of a table; empty rows, and columns without a heading and cells, are passed over.

    Raises
    ------
    MissionError
        if a row has a cell beyond the headings, or a heading that means something stands twice.
    """
    document = TableDocument(name, separator)
    titles, filled = _split_titles(row for row in rows if any(not is_empty(cell) for cell in row[1]))
    first = next(filled, None)
    if first is None:
        return Layer(file, name, (), ())
    line, head = first
    require_few(len(head), "columns", file, line, most=MOST_COLUMNS)
    lost = next((cell for cell in head if isinstance(cell, NoValue)), None)
    if lost is not None:
        raise refused(file, line, _field(where, "headings"), lost.told, lost.expected)
    headings = ["" if is_empty(cell) else " ".join(str(cell).split()) for cell in head]
    named = [heading for heading in headings if heading]
    twice = next((heading for heading in named if named.count(heading) > 1 and means_something(heading)), None)
    if twice is not None:
        raise refused(file, line, _field(where, twice), "a heading for the second time", "each heading once")
    headings = _numbered(headings)
    document.titles = [row[0] for row in titles]
    document.headings = line, headings
    features: list[Feature] = []
    alike: dict[Sequence[str], Sequence[str]] = {}
    for number, cells in filled:
        if len(features) >= MOST_ROWS:
            raise refused(file, number, where, f"more than {MOST_ROWS:,} rows", "fewer, in several files")
        _require_headings(file, number, cells, headings, where)
        values = {heading: _tidy(cell) for heading, cell in zip(headings, cells, strict=False) if not is_empty(cell)}
        features.append(Feature(values, file, number, where))
        present = tuple(values)
        document.rows.append((features[-1], alike.setdefault(present, present)))
    told = tuple(map(_told_title, titles))
    return Layer(file, name, tuple(filter(None, headings)), tuple(features), told, document=document)


def _numbered(headings: Sequence[str]) -> list[str]:
    """The headings; those that stand before already have their number."""
    counts: Counter[str] = Counter()
    found = []
    for heading in headings:
        counts[heading] += 1
        found.append(heading if counts[heading] == 1 or not heading else f"{heading} ({counts[heading]})")
    return found


def _split_titles(filled: Iterator[Row]) -> tuple[list[Row], Iterator[Row]]:
    """The rows of a single cell that stand above all rows of more, and the rest; none, where no row has more."""
    above: list[Row] = []
    for row in filled:
        if _has_several(row):
            return above, chain([row], filled)
        above.append(row)
        if len(above) > MOST_TITLES:
            break
    return [], chain(above, filled)


def _told_title(row: Row) -> str:
    number, cells = row
    text = next(str(cell) for cell in cells if not is_empty(cell))
    return f"row {number} ({shorten(text, _LONGEST_TITLE, placeholder=' ...')})"


def _has_several(row: Row) -> bool:
    return sum(not is_empty(cell) for cell in row[1]) > 1


def is_empty(cell: object) -> bool:
    """Whether a cell holds nothing."""
    return cell is None or (isinstance(cell, str) and not cell.strip())


def _tidy(cell: object) -> object:
    return cell.strip() if isinstance(cell, str) else cell


def _require_headings(file: str, number: int, cells: Sequence[object], headings: Sequence[str], where: str) -> None:
    for k, cell in enumerate(cells):
        if not is_empty(cell) and (k >= len(headings) or not headings[k]):
            expected = f"cells under {', '.join(filter(None, headings[:8]))}"
            told = shown(cell if isinstance(cell, str | int | float) else str(cell))
            raise refused(file, number, _field(where, f"column {k + 1}"), f"{told} without a heading", expected)


def _field(where: str, heading: str) -> str:
    return f"{where}, {heading}" if where else heading
