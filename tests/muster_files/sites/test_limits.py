"""Files that would fill the memory are refused before they do, in a process that has little of it."""

import json
import sqlite3
import subprocess
import sys
import zipfile
from contextlib import closing
from pathlib import Path

import pytest
from tests.muster_files.sites import writers

from muster.mission.errors import MissionError
from muster.mission.texts.text_files import LARGEST_FILE
from muster_files.importing import read_site

HEAD, TAIL = b'<kml xmlns="http://www.opengis.net/kml/2.2"><Document>', b"</Document></kml>"
MARK = b"<Placemark><name>a</name><Point><coordinates>8.5,47.3</coordinates></Point></Placemark>"
MEMORY = 1536 * 2**20
"""Bytes of addresses: the interpreter and its libraries take up to half of them."""
PROGRAM = f"""
import json, resource, sys
resource.setrlimit(resource.RLIMIT_AS, ({MEMORY}, {MEMORY}))
from pathlib import Path
from muster.mission.errors import MusterError
from muster_files.importing import read_site
from muster.planning.loading import load
told = {{}}
for name in sys.argv[1:]:
    try:
        load(name) if name.endswith((".plan", ".txt")) else read_site(name)
        told[Path(name).name] = "read"
    except MusterError as error:
        told[Path(name).name] = str(error)
print(json.dumps(told))
"""


def archive(path, pieces):
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as made, made.open("doc.kml", "w") as member:
        for piece in pieces:
            member.write(piece)


def marks(path):
    archive(path, [HEAD, *[MARK * 1000] * 2600, TAIL])


def blanks(path):
    archive(path, [b" " * (50 * 2**20)])


def members(path):
    with zipfile.ZipFile(path, "w") as made:
        for k in range(1100):
            made.writestr(f"{k}.kml", "")


def shared_text(path):
    """A workbook in which each of many cells has the same long text."""
    import xlsxwriter

    with xlsxwriter.Workbook(path) as book:
        sheet = book.add_worksheet("Tasks")
        sheet.write_row(0, 0, ["name", "lat", "lon"])
        for row in range(1, 3_000):
            sheet.write_string(row, 0, "a" * 30_000)


def view(query):
    """A GeoPackage whose table is a view that makes its rows out of nothing."""

    def write(path):
        writers.write_geopackage(path, {"tasks": []})
        with closing(sqlite3.connect(path)) as database, database:
            database.execute("DROP TABLE tasks")
            database.execute(f"CREATE VIEW tasks AS {query}")

    return write


ROWS = "WITH RECURSIVE n(k) AS (SELECT 1 UNION ALL SELECT k + 1 FROM n) "
BOMBS = {
    "marks.kmz": (marks, "MiB unpacked; expected at most"),
    "blanks.kmz": (blanks, "50 MiB unpacked, packed to "),
    "members.kmz": (members, "more than 1,000 files in the archive"),
    "elements.kml": (HEAD + b"<a/>" * 1_000_001 + TAIL, "more than 1,000,000 elements and attributes"),
    "attributes.gpx": (b"<gpx>" + b'<wpt lat="1" lon="2"/>' * 400_000 + b"</gpx>", "elements and attributes"),
    "places.kml": (HEAD + b"<LineString><coordinates>" + b"1,1 " * 4_100_000, "more than 4,000,000 values"),
    "lists.geojson": (b'{"type":"FeatureCollection","features":[' + b"[]," * 4_100_000, "more than 4,000,000 values"),
    "objects.geojson": (b'{"type":"FeatureCollection","features":[' + b"{}," * 1_100_000, "1,000,000 objects"),
    "objects.plan": (b'{"fileType":"Plan","mission":[' + b"{}," * 1_100_000, "more than 1,000,000 objects"),
    "deep.geojson": (b'{"type":"FeatureCollection","features":' + b"[" * 200_000, "expected GeoJSON"),
    "cells.csv": (b"id,lat,lon\n" + b"," * 10_100_000, "more than 10,000,000 cells"),
    "columns.csv": (b"id,lat,lon" + b",a" * 20_000 + b"\n", "more than 16,384 columns"),
    "large.csv": (b"id,lat,lon\n" + b" " * LARGEST_FILE, "more than 32 MiB; expected at most 32 MiB"),
    "lines.txt": (b"QGC WPL 110\n" + b"0 0 3 16 0 0 0 0 0 0 0 1\n" * 100_001, "more than 100,000 lines"),
    "shared.xlsx": (shared_text, "bytes of texts in cells"),
    "endless.gpkg": (view(ROWS + "SELECT k AS fid, NULL AS geom FROM n WHERE k < 0"), "cannot be read (interrupted)"),
    "rows.gpkg": (view(ROWS + "SELECT k AS fid, NULL AS geom FROM n"), "more than 1,000,000 rows"),
    "blobs.gpkg": (view(ROWS + "SELECT k AS fid, NULL AS geom, zeroblob(10000000) AS photo FROM n"), "bytes of values"),
    "blob.gpkg": (view("SELECT 1 AS fid, zeroblob(900000000) AS geom"), "cannot be read (string or blob too big)"),
}


@pytest.mark.long
@pytest.mark.parametrize(
    "names",
    [
        ("blanks.kmz", "members.kmz", "columns.csv", "deep.geojson", "blob.gpkg", "shared.xlsx", "objects.plan"),
        pytest.param(tuple(BOMBS), marks=pytest.mark.long),
    ],
)
def test_a_bomb_is_refused_in_little_memory(names, tmp_path):
    for name in names:
        made, _ = BOMBS[name]
        if isinstance(made, bytes):
            (tmp_path / name).write_bytes(made)
        else:
            made(tmp_path / name)
    paths = [str(tmp_path / name) for name in names]
    ran = subprocess.run([sys.executable, "-c", PROGRAM, *paths], capture_output=True, text=True, check=False)
    assert ran.returncode == 0, ran.stderr[-2000:]
    told = json.loads(ran.stdout)
    for name in names:
        assert BOMBS[name][1] in told[name], name
        assert "expected" in told[name]
        assert str(tmp_path / name) in told[name]


def test_an_archive_that_packs_well_but_is_small_is_read(tmp_path):
    text = writers.kml(*writers.kml_points()) + " " * (3 * 2**20)
    writers.write_kmz(tmp_path / "site.kmz", text)
    (tmp_path / "robots.csv").write_text(writers.ROBOTS, encoding="utf-8")
    assert len(read_site(tmp_path / "site.kmz", robots=tmp_path / "robots.csv").mission.tasks) == 3


@pytest.mark.skipif(not Path("/dev/zero").exists(), reason="no device without an end")
def test_a_file_without_an_end_is_refused(tmp_path):
    (tmp_path / "zero.csv").symlink_to("/dev/zero")
    with pytest.raises(MissionError, match="more than 32 MiB"):
        read_site(tmp_path / "zero.csv")
