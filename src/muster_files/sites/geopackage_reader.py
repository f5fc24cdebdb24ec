"""GeoPackage (OGC 12-128r19) as layers, one a table of features or attributes; shapely reads its geometries.

A GeoPackage is a database of SQLite. It is opened for reading alone, and its schema is not trusted to run anything.
"""

from __future__ import annotations

import itertools
import sqlite3
import struct
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from muster.mission.import_ledger import EMPTY, Fate, LedgerBook, Source, passed_over, read_as
from muster.mission.system.extras import needs_extra
from muster_files.sites.coordinate_systems import to_wgs84
from muster_files.sites.features import Coordinate, Feature, Geometry, Layer, refused, with_name
from muster_files.sites.file_sizes import MOST_BYTES, MOST_CELLS, MOST_ROWS, read_bytes, require_few
from muster_files.sites.shapes import geometries_of

_WHAT = "a GeoPackage"
_KEY, _GEOMETRY = passed_over("is the number of the row", minor=True), read_as("a geometry")
_BYTES, _OTHER = passed_over("holds bytes"), passed_over("holds neither features nor attributes")
_OF_FORMAT = ("gpkg_", "rtree_", "sqlite_")
_STEPS, _MOST_WORK = 1_000_000, 2_000
"""Steps of SQLite's machine between two looks, and how many looks: a table of a million rows takes a tenth."""
_ENVELOPES = (0, 32, 48, 48, 64)
"""Bytes of the envelope by its indicator (section 2.1.3)."""
_TABLES = """
SELECT c.table_name, g.column_name, s.organization, s.organization_coordsys_id, s.srs_id
FROM gpkg_contents AS c
LEFT JOIN gpkg_geometry_columns AS g ON g.table_name = c.table_name
LEFT JOIN gpkg_spatial_ref_sys AS s ON s.srs_id = g.srs_id
WHERE c.data_type IN ('features', 'attributes') ORDER BY c.rowid
"""


def read_geopackage_layers(path: Path) -> Sequence[Layer]:
    """The tables of features and attributes.

    Raises
    ------
    MissionError
        if it is none, or a geometry in it cannot be read.
    MissingExtraError
        without shapely; without pyproj, where it is not in WGS84.
    """
    with needs_extra("map", "reading a GeoPackage"):
        import shapely  # noqa: F401
    file = str(path)
    if not read_bytes(path).startswith(b"SQLite format 3\0"):
        raise refused(file, None, "", "no database of SQLite", _WHAT)
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro&immutable=1", uri=True)) as database:
            database.execute("PRAGMA trusted_schema = OFF")
            database.execute("PRAGMA cell_size_check = ON")
            _limit(database)
            document = _Document(file)
            tables = [_Table(database, file, document, *row) for row in database.execute(_TABLES).fetchall()]
            layers = [table.layer() for table in tables]
            document.add_others(database, [table.name for table in tables])
    except (sqlite3.Error, OverflowError, UnicodeError) as error:
        raise refused(file, None, "", f"cannot be read ({error})", _WHAT) from None
    if not layers:
        raise refused(file, None, "gpkg_contents", "no tables", "a table of features")
    return layers


def _limit(database: sqlite3.Connection) -> None:
    """Limit the length of values, and the work that a view may make: SQLite interrupts what takes more."""
    database.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, MOST_BYTES)
    rest = itertools.count(_MOST_WORK, -1)
    database.set_progress_handler(lambda: next(rest) <= 0, _STEPS)


class _Document:
    """The columns of all rows that are not null: those of tables that are read, and those of others."""

    def __init__(self, file: str) -> None:
        self._file = file
        self._rows: list[tuple[str, Sequence[str], Mapping[str, Fate], Source]] = []
        self._others: list[tuple[str, int]] = []
        self._alike: dict[Sequence[str], Sequence[str]] = {}
        self._cells = self._bytes = 0

    def add(self, table: str, row: Mapping[str, Any], unsaid: Mapping[str, Fate], source: Source) -> None:
        """Add a row of a table; `unsaid` are the fates of columns that are no values of a feature."""
        present = tuple(name for name, value in row.items() if value is not None)
        self._cells += len(present)
        self._bytes += sum(len(value) for value in row.values() if isinstance(value, str | bytes))
        require_few(self._cells, "cells", self._file, most=MOST_CELLS)
        require_few(self._bytes, "bytes of values", self._file, most=MOST_BYTES)
        own = {
            name: EMPTY if row[name] == "" else _BYTES for name in present if row[name] == "" or _is_bytes(row[name])
        }
        self._rows.append(
            (table, self._alike.setdefault(present, present), {**own, **unsaid} if own else unsaid, source)
        )

    def add_others(self, database: sqlite3.Connection, read: Sequence[str]) -> None:
        """Add the tables that hold neither features nor attributes; not those that say how it is read."""
        found = database.execute("SELECT name FROM sqlite_master WHERE type = 'table' ORDER BY name").fetchall()
        for (name,) in found:
            if name in read or name.startswith(_OF_FORMAT):
                continue
            quoted = name.replace('"', '""')
            columns = [row[1].replace('"', '""') for row in database.execute(f'PRAGMA table_info("{quoted}")')]
            counts = ", ".join(f'COUNT("{column}")' for column in columns)
            row = database.execute(f'SELECT {counts} FROM "{quoted}"').fetchone()  # noqa: S608 - in quotes
            self._others.append((name, sum(row)))

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every column of every row."""
        for table, names, own, source in self._rows:
            for name in names:
                book.add(f"{table}: {name}", source.whole or own.get(name) or source.fate(name, name), table)
        for name, count in self._others:
            book.add(f"table {name}", _OTHER, name, count)


def _is_bytes(value: object) -> bool:
    return isinstance(value, bytes)


class _Table:
    """Reads one table."""

    def __init__(
        self,
        database: sqlite3.Connection,
        file: str,
        document: _Document,
        name: Any,
        column: Any,
        organization: Any,
        number: Any,
        srs: Any,
    ) -> None:
        if not isinstance(name, str) or not isinstance(column, str | None):
            raise refused(file, None, "gpkg_contents", "a name that is no text", _WHAT)
        self._database, self._file, self.name, self._column = database, file, name, column
        self._document = document
        self._transform: Callable[[Coordinate], Coordinate] | None = None
        self._unsaid: Mapping[str, Fate] = {}
        """Columns that are no values: the key, and the geometry."""
        if column is not None and srs not in (0, 4326):
            system = f"{organization}:{number}".upper() if organization else f"srs_id {srs}"
            self._transform = to_wgs84(system, file, f"layer {name}")

    def layer(self) -> Layer:
        quoted = self.name.replace('"', '""')
        cursor = self._database.execute(f'SELECT * FROM "{quoted}"')  # noqa: S608 - in quotes
        names = [description[0] for description in cursor.description]
        keys = {row[1] for row in self._database.execute(f'PRAGMA table_info("{quoted}")') if row[5]}
        self._unsaid = dict.fromkeys(keys, _KEY) | ({} if self._column is None else {self._column: _GEOMETRY})
        headings = tuple(name for name in names if name not in self._unsaid)
        features: list[Feature] = []
        for k, row in enumerate(cursor, 1):
            if k > MOST_ROWS:
                raise refused(self._file, None, self.name, f"more than {MOST_ROWS:,} rows", "fewer")
            features.extend(self._features(k, dict(zip(names, row, strict=True))))
        return Layer(self._file, self.name, headings, tuple(features), document=self._document)

    def _features(self, number: int, row: dict[str, Any]) -> Iterator[Feature]:
        where = f"layer {self.name}, row {number}"
        source = Source()
        self._document.add(self.name, row, self._unsaid, source)
        blob = row.pop(self._column, None) if self._column is not None else None
        values = {
            name: value for name, value in row.items() if value not in (None, "") and not isinstance(value, bytes)
        }
        found: list[Geometry | None] = []
        try:
            found += [] if blob is None else geometries_of(_well_known(blob), self._transform)
        except ValueError as error:
            told = " ".join(str(error).split())
            raise refused(self._file, None, f"{where}, {self._column}", told, "a geometry of a GeoPackage") from None
        for geometry in found or [None]:
            yield Feature(values, self._file, None, with_name(where, values), geometry, source)


def _well_known(blob: object) -> Any:
    """The geometry in a blob: a header, an envelope, and well-known binary (section 2.1.3)."""
    import shapely

    if not isinstance(blob, bytes) or len(blob) < 8 or blob[:2] != b"GP":
        raise ValueError("no geometry")
    flags = blob[3]
    indicator = flags >> 1 & 7
    if flags & 0x20 or indicator >= len(_ENVELOPES):
        raise ValueError("an extended geometry")
    try:
        return shapely.from_wkb(blob[8 + _ENVELOPES[indicator] :])
    except (shapely.errors.ShapelyError, TypeError, struct.error) as error:
        raise ValueError(f"broken ({error})") from None
