"""Three hundred broken files, made of good ones by seeded mutations: one clear message each, never a traceback.

A mutation may leave a file right, as where it cuts a remark: then it is read. Most do not, which is counted.
"""

import random
import struct
import zipfile

import pytest
import shapely
from tests.muster_files.sites import writers

from muster.mission.errors import MissionError, MusterError
from muster_files.importing import read_site

KINDS = ("csv", "xlsx", "geojson", "kml", "kmz", "gpx", "gpkg")
FILES_A_KIND = 43
WORDS = (b"NaN", b"-1e400", b"", b"null", b"[]", b"99999", b"\xff\xfe", b"\0", b"<", b'"', b"yes", b"1e308", b"{")


@pytest.fixture(scope="module")
def good(tmp_path_factory):
    """A good file of each kind, as bytes."""
    folder = tmp_path_factory.mktemp("good")
    lane = "<LineString><coordinates>8.5416,47.3768 8.5417,47.3770</coordinates></LineString>"
    texts = {
        "csv": "name,lat,lon,duration,opens,priority,after\n"
        "a,47.3775,8.5417,15 min,10:00,2,\nb,47.3770,8.5425,00:05,11:00,1,a\nc,47.3765,8.5417,90,12:00,3,a b\n",
        "geojson": writers.geojson(*writers.points(), writers.area(name="roof"), name="site"),
        "kml": writers.kml(*writers.kml_points(), writers.placemark("way", lane)),
        "gpx": writers.gpx(
            *writers.gpx_points(),
            "<trk><name>way</name><trkseg><trkpt lat='47.3768' lon='8.5416'/>"
            "<trkpt lat='47.3770' lon='8.5417'/></trkseg></trk>",
        ),
    }
    for kind, text in texts.items():
        (folder / f"site.{kind}").write_text(text, encoding="utf-8")
    writers.write_kmz(folder / "site.kmz", texts["kml"])
    tasks = [["name", "lat", "lon", "duration"], *([*task, 5.0] for task in writers.TASKS)]
    writers.write_workbook(folder / "site.xlsx", {"Tasks": tasks})
    layer = [(shapely.Point(lon, lat), {"name": name}) for name, lat, lon in writers.TASKS]
    writers.write_geopackage(folder / "site.gpkg", {"tasks": layer, "fences": [(shapely.Polygon(writers.FENCE), {})]})
    (folder / "robots.csv").write_text(writers.ROBOTS, encoding="utf-8")
    for kind in KINDS:  # each is right as it is
        assert len(read_site(folder / f"site.{kind}", robots=folder / "robots.csv").mission.tasks) == 3
    return {kind: (folder / f"site.{kind}").read_bytes() for kind in KINDS}


def cut(data, chance):
    return data[: chance.randrange(len(data))]


def lose(data, chance):
    begin = chance.randrange(len(data))
    return data[:begin] + data[begin + chance.randrange(1, 60) :]


def put(data, chance):
    at = chance.randrange(len(data))
    return data[:at] + chance.choice(WORDS) + data[at + chance.randrange(8) :]


def turn(data, chance):
    changed = bytearray(data)
    for _ in range(chance.randrange(1, 12)):
        changed[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(changed)


def swap(data, chance):
    a, b = sorted(chance.sample(range(len(data)), 2))
    return data[b:] + data[a:b] + data[:a]


def encode(data, chance):
    return data.decode("latin-1").encode(chance.choice(["utf-16-be", "utf-32", "cp037"]))


def number(data, chance):
    digits = [k for k, byte in enumerate(data) if 48 <= byte <= 57]
    at = chance.choice(digits or [0])
    return data[:at] + chance.choice(WORDS) + data[at + 1 :]


MUTATIONS = (cut, lose, put, turn, swap, encode, number)


def message(file, robots):
    """What is said of a file; None where it is read."""
    try:
        read_site(file, robots=robots)
    except MusterError as error:
        return str(error)
    return None


@pytest.mark.parametrize("kind", KINDS)
def test_a_broken_file_is_read_or_refused_with_a_message(kind, good, tmp_path):
    robots = tmp_path / "robots.csv"
    robots.write_text(writers.ROBOTS, encoding="utf-8")
    chance, refused = random.Random(f"broken {kind}"), 0
    for k in range(FILES_A_KIND):
        file = tmp_path / f"{k}.{kind}"
        file.write_bytes(MUTATIONS[k % len(MUTATIONS)](good[kind], chance))
        told = message(file, robots)
        refused += told is not None
        assert told is None or (str(file) in told and "expected" in told)
        assert all(len(line) < 600 for line in (told or "").splitlines())
    assert refused > FILES_A_KIND // 2


HOSTILE = {
    "entities.kml": b'<?xml version="1.0"?><!DOCTYPE k [<!ENTITY a "aaaa"><!ENTITY b "&a;&a;">]><kml>&b;</kml>',
    "outside.gpx": b'<?xml version="1.0"?><!DOCTYPE gpx SYSTEM "file:///etc/passwd"><gpx/>',
    "deep.kml": b"<kml>" + b"<Folder>" * 5000,
    "deep.geojson": b'{"type": "FeatureCollection", "features": ' + b"[" * 100_000,
    "deep_geometry.geojson": b'{"type":"Feature","properties":{},"geometry":'
    + b'{"type":"GeometryCollection","geometries":[' * 300
    + b"]}" * 300
    + b"}",
    "deep.csv": b'id,wkt\n1,"' + b"GEOMETRYCOLLECTION(" * 20_000 + b'"\n',
    "html.kml": b"<html><body>404</body></html>",
    "nul.csv": b"id,lat,lon\n1,47.1\0,8\n",
    "infinite.geojson": b'{"type":"Point","coordinates":[1e999, 3]}',
    "nan.geojson": b'{"type":"Point","coordinates":[NaN, 3]}',
    "nan.gpx": b'<gpx><wpt lat="47" lon="nan"/></gpx>',
    "nan_height.gpx": b'<gpx><wpt lat="47" lon="8"><ele>nan</ele></wpt></gpx>',
    "empty.csv": b"",
    "blank.csv": b"\n\n;;\n",
    "no.kmz": b"PK\3\4 no archive",
    "no.xlsx": b"<table></table>",
    "no.gpkg": b"SQLite format 3\0" + b"\1" * 4000,
    "latin.csv": "name,lat,lon\nGr\u00fcn,47,8\n".encode("cp1252"),
    "swapped.geojson": b'{"type":"Point","coordinates":[8.5, 147.3]}',
    "null_island.csv": b"name,lat,lon\na,47.1,8.2\nb,0,0\n",
    "bow.geojson": b'{"type":"Polygon","coordinates":[[[8,47],[8.001,47.001],[8.001,47],[8,47.001],[8,47]]]}',
}


@pytest.mark.parametrize("name", HOSTILE)
def test_a_hostile_file_is_refused(name, tmp_path):
    file = tmp_path / name
    file.write_bytes(HOSTILE[name])
    robots = tmp_path / "robots.csv"
    robots.write_text(writers.ROBOTS, encoding="utf-8")
    with pytest.raises(MissionError) as caught:
        read_site(file, robots=robots)
    assert all(finding.file == str(file) for finding in caught.value.findings)


def test_an_archive_that_unpacks_to_too_much_is_refused(tmp_path, monkeypatch):
    monkeypatch.setattr("muster_files.sites.file_sizes.MOST_BYTES", 2**20)
    bomb = tmp_path / "bomb.kmz"
    with zipfile.ZipFile(bomb, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("doc.kml", "w") as member:
        member.write(b" " * 3 * 2**20)
    with pytest.raises(MissionError, match=r"bomb.kmz: 3 MiB unpacked; expected at most"):
        read_site(bomb)


def test_an_archive_that_lies_about_its_size_is_refused(tmp_path):
    file = tmp_path / "lies.kmz"
    writers.write_kmz(file, "<kml>" + " " * 100_000 + "</kml>")
    data = bytearray(file.read_bytes())
    at = data.rindex(b"PK\1\2")
    data[at + 24 : at + 28] = struct.pack("<I", 10)
    file.write_bytes(data)
    with pytest.raises(MissionError, match=r"lies.kmz"):
        read_site(file)


def test_a_sheet_with_a_cell_far_out_is_refused_before_it_fills_the_memory(tmp_path):
    file = tmp_path / "far.xlsx"
    writers.write_workbook(file, {"Tasks": [["name", "lat", "lon"], ["a", 47.0, 8.0]]})
    with zipfile.ZipFile(file) as archive:
        members = {name: archive.read(name) for name in archive.namelist()}
    sheet = next(name for name in members if name.startswith("xl/worksheets/"))
    members[sheet] = members[sheet].replace(b'r="C2"', b'r="XFD1048576"').replace(b'row r="2"', b'row r="1048576"')
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in members.items():
            archive.writestr(name, data)
    with pytest.raises(MissionError, match=r"1,048,576 rows of 16,384 cells; expected at most 1,000,000 rows"):
        read_site(file)
