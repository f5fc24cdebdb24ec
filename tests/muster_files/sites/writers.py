"""Sites written as files by other code than Muster's: workbooks by openpyxl, GeoPackages by hand from the standard."""

import json
import sqlite3
import struct
import zipfile
from contextlib import closing

import shapely

TASKS = [
    ("north", 47.3775, 8.5417),
    ("east", 47.3770, 8.5425),
    ("south", 47.3765, 8.5417),
]
CSV = "name,lat,lon\n" + "".join(f"{name},{lat},{lon}\n" for name, lat, lon in TASKS)
ROBOTS = "id,lat,lon,speed,kind\nr_0,47.3768,8.5416,1.5,ground\n"
FENCE = [(8.5418, 47.3770), (8.5420, 47.3770), (8.5420, 47.3772), (8.5418, 47.3772)]


def feature(shape, coordinates, **properties):
    return {
        "type": "Feature",
        "properties": properties,
        "geometry": {"type": shape, "coordinates": coordinates},
    }


def geojson(*features, **more):
    return json.dumps({"type": "FeatureCollection", "features": list(features), **more}, indent=1)


def points():
    return [feature("Point", [lon, lat], name=name) for name, lat, lon in TASKS]


def area(corners=FENCE, holes=(), **properties):
    return feature("Polygon", [[*map(list, ring), list(ring[0])] for ring in (corners, *holes)], **properties)


def kml(*marks):
    inside = "\n".join(marks)
    return (
        f'<?xml version="1.0"?>\n<kml xmlns="http://www.opengis.net/kml/2.2"><Document>\n{inside}\n</Document></kml>\n'
    )


def placemark(name, shape):
    return f"<Placemark><name>{name}</name>{shape}</Placemark>"


def kml_points():
    return [placemark(name, f"<Point><coordinates>{lon},{lat}</coordinates></Point>") for name, lat, lon in TASKS]


def gpx(*elements):
    return '<?xml version="1.0"?>\n<gpx version="1.1" creator="hand" xmlns="http://www.topografix.com/GPX/1/1">' + (
        "\n".join(elements) + "</gpx>\n"
    )


def gpx_points():
    return [f'<wpt lat="{lat}" lon="{lon}"><name>{name}</name></wpt>' for name, lat, lon in TASKS]


def write_kmz(path, text, name="doc.kml"):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr(name, text)


def write_workbook(path, sheets, merged=None):
    """Sheets by name, each a list of rows; `merged` are ranges of cells by sheet."""
    import openpyxl

    book = openpyxl.Workbook()
    book.remove(book.active)
    for name, rows in sheets.items():
        sheet = book.create_sheet(name)
        for row in rows:
            sheet.append(row)
        for cells in (merged or {}).get(name, ()):
            sheet.merge_cells(cells)
    book.save(path)


def write_geopackage(path, layers, srs=4326):
    """Layers by name, each a list of (geometry of shapely or None, {column: value})."""
    path.unlink(missing_ok=True)
    with closing(sqlite3.connect(path)) as database, database:
        database.executescript(_SCHEMA)
        database.execute("INSERT OR IGNORE INTO gpkg_spatial_ref_sys VALUES ('x', ?, 'EPSG', ?, 'x', NULL)", (srs, srs))
        for name, rows in layers.items():
            columns = list(dict.fromkeys(key for _, values in rows for key in values))
            spec = "".join(f', "{column}"' for column in columns)
            database.execute(f'CREATE TABLE "{name}" (fid INTEGER PRIMARY KEY, geom BLOB{spec})')
            database.execute(
                "INSERT INTO gpkg_contents (table_name, data_type, srs_id) VALUES (?, 'features', ?)", (name, srs)
            )
            database.execute("INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', 'GEOMETRY', ?, 0, 0)", (name, srs))
            for geometry, values in rows:
                cells = [None if geometry is None else blob(geometry, srs), *(values.get(column) for column in columns)]
                marks = ", ".join("?" * len(cells))
                database.execute(f'INSERT INTO "{name}" (geom{spec}) VALUES ({marks})', cells)


def blob(geometry, srs=4326):
    """A geometry by GeoPackage, section 2.1.3, with an envelope."""
    west, south, east, north = geometry.bounds
    head = struct.pack("<2sBBi4d", b"GP", 0, 0b00000011, srs, west, east, south, north)
    return head + shapely.to_wkb(geometry, byte_order=1)


_SCHEMA = """
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT, srs_id INTEGER PRIMARY KEY, organization TEXT,
    organization_coordsys_id INTEGER, definition TEXT, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT PRIMARY KEY, data_type TEXT, identifier TEXT, srs_id INTEGER);
CREATE TABLE gpkg_geometry_columns (table_name TEXT, column_name TEXT, geometry_type_name TEXT, srs_id INTEGER,
    z TINYINT, m TINYINT);
"""
