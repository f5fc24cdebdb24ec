"""GeoPackage (OGC 12-128r19) as layers, one a table of features or attributes; shapely reads its geometries.

A GeoPackage is a database of SQLite. It is opened for reading alone, and its schema is not trusted to run anything.
"""

from __future__ import annotations

import sqlite3
import struct
from collections.abc import Callable, Iterator, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from muster.exchange.sites.coordinate_systems import to_wgs84
from muster.exchange.sites.features import Coordinate, Feature, Geometry, Layer, refused, with_name
from muster.exchange.sites.file_sizes import read_bytes
from muster.exchange.sites.shapes import geometries_of
from muster.exchange.sites.tables import MOST_ROWS
from muster.mission.errors import MissingExtraError

_WHAT = "a GeoPackage"
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
    try:
        import shapely  # noqa: F401
    except ImportError:
        raise MissingExtraError("map", "reading a GeoPackage") from None
    file = str(path)
    if not read_bytes(path).startswith(b"SQLite format 3\0"):
        raise refused(file, None, "", "no database of SQLite", _WHAT)
    try:
        with closing(sqlite3.connect(f"{path.resolve().as_uri()}?mode=ro&immutable=1", uri=True)) as database:
            database.execute("PRAGMA trusted_schema = OFF")
            database.execute("PRAGMA cell_size_check = ON")
            layers = [_Table(database, file, *row).layer() for row in database.execute(_TABLES).fetchall()]
    except (sqlite3.Error, OverflowError, UnicodeError) as error:
        raise refused(file, None, "", f"cannot be read ({error})", _WHAT) from None
    if not layers:
        raise refused(file, None, "gpkg_contents", "no tables", "a table of features")
    return layers


class _Table:
    """Reads one table."""

    def __init__(
        self, database: sqlite3.Connection, file: str, name: Any, column: Any, organization: Any, number: Any, srs: Any
    ) -> None:
        if not isinstance(name, str) or not isinstance(column, str | None):
            raise refused(file, None, "gpkg_contents", "a name that is no text", _WHAT)
        self._database, self._file, self._name, self._column = database, file, name, column
        self._transform: Callable[[Coordinate], Coordinate] | None = None
        self._unsaid: set[str | None] = set()
        """Columns without a meaning: the key, and the geometry."""
        if column is not None and srs not in (0, 4326):
            system = f"{organization}:{number}".upper() if organization else f"srs_id {srs}"
            self._transform = to_wgs84(system, file, f"layer {name}")

    def layer(self) -> Layer:
        quoted = self._name.replace('"', '""')
        cursor = self._database.execute(f'SELECT * FROM "{quoted}"')  # noqa: S608 - in quotes
        names = [description[0] for description in cursor.description]
        keys = {row[1] for row in self._database.execute(f'PRAGMA table_info("{quoted}")') if row[5]}
        self._unsaid = {*keys, self._column}
        headings = tuple(name for name in names if name not in self._unsaid)
        features: list[Feature] = []
        for k, row in enumerate(cursor, 1):
            if k > MOST_ROWS:
                raise refused(self._file, None, self._name, f"more than {MOST_ROWS:,} rows", "fewer")
            features.extend(self._features(k, dict(zip(names, row, strict=True))))
        return Layer(self._file, self._name, headings, tuple(features))

    def _features(self, number: int, row: dict[str, Any]) -> Iterator[Feature]:
        where = f"layer {self._name}, row {number}"
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
            yield Feature(values, self._file, None, with_name(where, values), geometry)


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
