"""How many elements a file has, counted without Muster: by json, ElementTree, csv, openpyxl and sqlite3.

What an element is: a member of a JSON object, and of a plan each parameter of a command that is not null; an element
or attribute of XML, and each other file of an archive; a cell that is not blank; a column of a row that is not null; a
word of way points as text; a line of an instance file that is not blank.
"""

import csv
import io
import json
import sqlite3
import xml.etree.ElementTree as ElementTree
import zipfile
from contextlib import closing


def raw_count(path):
    """The number of elements of a file, by its suffix and its first line."""
    suffix = path.suffix.lower()
    if path.is_dir():
        return sum(raw_count(file) for file in path.iterdir() if file.suffix == ".plan")
    if suffix in (".geojson", ".json", ".plan"):
        return json_members(path.read_text(encoding="utf-8-sig")) + (plan_parameters(path) if suffix == ".plan" else 0)
    if suffix in (".kml", ".gpx", ".wpml"):
        return xml_elements(path.read_bytes())
    if suffix == ".kmz":
        return archive_elements(path)
    if suffix in (".csv", ".tsv"):
        return filled_cells(path)
    if suffix in (".xlsx", ".xlsm"):
        return workbook_cells(path)
    if suffix == ".gpkg":
        return database_columns(path)
    text = path.read_text(encoding="utf-8-sig", errors="replace")
    return len(text.split()) if text.startswith("QGC WPL") else sum(1 for line in text.splitlines() if line.strip())


def json_members(text):
    count = 0

    def pairs(found):
        nonlocal count
        count += len(found)
        return dict(found)

    json.loads(text, object_pairs_hook=pairs)
    return count


def plan_parameters(path):
    items = json.loads(path.read_text(encoding="utf-8"))["mission"]["items"]
    return sum(value is not None for item in items for value in item.get("params", ()))


def xml_elements(data):
    root = ElementTree.fromstring(data)
    return sum(1 + len(element.attrib) for element in root.iter())


def archive_elements(path):
    with zipfile.ZipFile(path) as archive:
        names = archive.namelist()
        maps = [name for name in names if name.endswith("waylines.wpml")]
        maps += [name for name in names if name.rpartition("/")[2] == "doc.kml"]
        maps += [name for name in names if name.endswith(".kml")]
        return len(names) - 1 + xml_elements(archive.read(maps[0]))


def filled_cells(path):
    text = path.read_text(encoding="utf-8-sig")
    first = next(line for line in text.splitlines() if line.strip())
    separator = max(";\t,|", key=first.count)
    rows = csv.reader(io.StringIO(text, newline=""), delimiter=separator)
    return sum(bool(cell.strip()) for row in rows for cell in row)


def workbook_cells(path):
    import openpyxl

    book = openpyxl.load_workbook(path)
    cells = (cell.value for sheet in book for row in sheet.iter_rows() for cell in row)
    return sum(value is not None and bool(str(value).strip()) for value in cells)


def database_columns(path):
    count = 0
    with closing(sqlite3.connect(path)) as database:
        tables = database.execute("SELECT name FROM sqlite_master WHERE type = 'table'").fetchall()
        for (table,) in tables:
            if not table.startswith(("gpkg_", "rtree_", "sqlite_")):
                quoted = table.replace('"', '""')
                rows = database.execute(f'SELECT * FROM "{quoted}"').fetchall()
                count += sum(value is not None for row in rows for value in row)
    return count
