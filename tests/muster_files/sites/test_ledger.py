"""The ledger of a site: each element of its files is read or passed over, and what is read makes a difference."""

import json
import sqlite3
from contextlib import closing

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples
from tests.muster_files.sites import writers
from tests.raw_counts import raw_count

import muster
from muster.mission.errors import MissionError
from muster.mission.import_ledger import summary_lines
from muster.mission.yaml_writer import file_data
from muster_files.importing import read_site
from muster_files.sites.keys import ROLES, keys_of

ORIGIN = (47.37, 8.54)


@pytest.fixture
def robots(tmp_path):
    file = tmp_path / "robots.csv"
    file.write_text(writers.ROBOTS, encoding="utf-8")
    return file


def rows_of(ledger, file, how="passed over"):
    """The rows of a file as `kind: reason`, with the count."""
    return {f"{row.kind}: {row.said}": row.count for row in ledger.rows if row.file == str(file) and row.how == how}


def assert_complete(ledger, file):
    assert raw_count(file) == sum(row.count for row in ledger.rows if row.file == str(file))


MIXED = writers.geojson(
    writers.feature("Point", [8.5417, 47.377], name="mast", ceiling_m=30, oneway="yes", speed="5 m/s", note=None),
    writers.area(name="hall", height=12, priority=3, duration="10 min", **{"@id": "way/1"}),
    writers.feature("LineString", [[8.5416, 47.3768], [8.5417, 47.377, 9]], name="lane", floor_m=3, width_m=2),
    name="site",
    bbox=[8, 47, 9, 48],
    made_by={"program": "x", "versions": [{"major": 1}]},
)
KML = writers.kml(
    "<name>doc</name><Style id='s'><LineStyle><color>ff</color></LineStyle></Style>",
    "<Placemark id='p'><name>mast</name><description>a text</description><TimeStamp><when>2027</when></TimeStamp>"
    "<ExtendedData><Data name='duration' id='d'><displayName>Time</displayName><value>90</value></Data>"
    "<Data name='colour'><value>red</value></Data>"
    "<Data name='empty'><value/></Data></ExtendedData>"
    "<Point><coordinates>8.5417,47.377,30</coordinates></Point></Placemark>",
    "<Placemark><name>camera</name><LookAt><range>3</range></LookAt></Placemark>",
    "<NetworkLink><Link><href>http://x</href></Link></NetworkLink>",
)
GPX = writers.gpx(
    "<metadata><time>2027</time></metadata>",
    "<wpt lat='47.377' lon='8.5417'><ele>440</ele><time>2027</time><name>mast</name>"
    "<extensions><duration>90</duration><hdop>3</hdop></extensions></wpt>",
    "<trk><name>way</name><trkseg><trkpt lat='47.3768' lon='8.5416'><ele>3</ele></trkpt>"
    "<trkpt lat='47.3770' lon='8.5417'/></trkseg></trk>",
    "<rte><name>short</name><rtept lat='47.3768' lon='8.5416'/></rte>",
)
CSV = "sep=;\nPanels of the roof\nname;lat;lon;colour;dauer;\na;47.377;8.5417;red;;\nb;47.376;8.5417;;3;\n"


def write(folder, kind):
    """A file of a kind with much that means nothing."""
    file = folder / f"site.{kind}"
    if kind in ("geojson", "kml", "gpx", "csv"):
        text = {"geojson": MIXED, "kml": KML, "gpx": GPX, "csv": CSV}[kind]
        file.write_text(text, encoding="utf-8")
    elif kind == "kmz":
        writers.write_kmz(file, KML)
    elif kind == "xlsx":
        rows = [["Roof"], ["name", "lat", "lon", "colour"], ["a", 47.377, 8.5417, "red"], ["b", 47.376, 8.5417, None]]
        writers.write_workbook(file, {"Tasks": rows, "Remarks": [["who", "what"], ["me", "nothing"]]})
    else:
        layer = [(shapely.Point(lon, lat), {"name": name, "colour": "red"}) for name, lat, lon in writers.TASKS]
        writers.write_geopackage(file, {"tasks": layer, "fences": [(shapely.Polygon(writers.FENCE), {"duration": 3})]})
        with closing(sqlite3.connect(file)) as database, database:
            database.execute('CREATE TABLE "of ""others" (a INTEGER PRIMARY KEY, b TEXT, c BLOB)')
            database.executemany('INSERT INTO "of ""others" (b) VALUES (?)', [("x",), (None,)])
    return file


@pytest.mark.parametrize("kind", ["geojson", "kml", "kmz", "gpx", "csv", "xlsx", "gpkg"])
def test_the_sums_are_what_another_program_counts(kind, tmp_path, robots):
    file = write(tmp_path, kind)
    ledger = read_site(file, robots=robots).ledger
    assert_complete(ledger, file)
    assert_complete(ledger, robots)
    assert ledger.count("passed over", str(file)) > 0
    assert ledger.as_dict()["files"][str(file)]["read"] == ledger.count("read", str(file)) > 0


def test_a_property_is_counted_for_its_feature_not_for_its_layer(tmp_path, robots):
    file = write(tmp_path, "geojson")
    found = read_site(file, robots=robots)
    lost = rows_of(found.ledger, file)
    for name, role in (
        *(("ceiling_m", "task"), ("oneway", "task"), ("speed", "task")),
        *(("height", "zone"), ("priority", "zone"), ("duration", "zone"), ("floor_m", "lane")),
    ):
        assert lost[f"features[].properties.{name}: means nothing for a {role}"] == 1
        assert any(f"{name} of {role}s" in note for note in found.notes)
    assert "features[].properties.width_m: means nothing for a lane" not in lost
    assert lost["made_by: has no meaning here"] == 4  # with what is in it
    assert lost["features[].properties.note: is empty"] == 1


def test_elements_of_kml_have_their_reasons(tmp_path, robots):
    lost = rows_of(read_site(file := write(tmp_path, "kml"), robots=robots).ledger, file)
    assert lost["<Placemark> <description>: is a text for people"] == 1
    assert lost["<Placemark> <TimeStamp>: has no meaning here"] == 2
    assert lost["<Style>: says how things look"] == 4
    assert lost["property colour: means nothing for a task"] == 3
    assert lost["<Placemark>: has no point, line or area"] == 4
    assert lost["<NetworkLink>: has no point, line or area"] == 3
    assert lost["property duration: stands beside the value"] == 1
    assert lost["property duration: has no meaning here"] == 1  # the attribute id
    read = rows_of(read_site(file, robots=robots).ledger, file, "read")
    assert read["property duration: duration_s"] == 2
    assert read["<Point> <coordinates>: places without their heights: altitudeMode does not say what they are"] == 1


def test_heights_that_are_left_out_are_passed_over(tmp_path, robots):
    file = tmp_path / "site.csv"
    file.write_text("name,lat,lon,alt\na,47.377,8.5417,440\n", encoding="utf-8")
    lost = rows_of(read_site(file, robots=robots).ledger, file)
    assert lost["alt: heights are left out, as some places have none or --flat says so"] == 1


@pytest.mark.parametrize(
    ("cells", "read"),
    [
        ({"lat": 47.377, "lon": 8.5417, "x": 3, "y": 4}, {"lat", "lon"}),
        ({"lat_lon": "47.377, 8.5417", "lat": 47.37, "lon": 8.54}, {"lat_lon"}),
        ({"lat": 47.377, "lon": 8.5417, "alt": 440, "z": 30}, {"lat", "lon", "z"}),
        ({"position": "3 4", "x": 5, "y": 6}, {"position"}),
        ({"x": 5, "y": 6, "lat": 47.377}, {"x", "y"}),
    ],
)
def test_a_place_that_another_is_stronger_than_is_passed_over(cells, read, tmp_path):
    """What is read moves the task; what is passed over does not."""
    (tmp_path / "robots.csv").write_text("id,lat,lon,z,kind\nr_0,47.3768,8.5416,0,air\n", encoding="utf-8")

    def read_cells(**cells):
        file = tmp_path / "site.csv"
        file.write_text(f"name;{';'.join(cells)}\na;{';'.join(map(str, cells.values()))}\n", encoding="utf-8")
        found = read_site(file, robots=tmp_path / "robots.csv", origin=ORIGIN)
        return found.mission.tasks[0].position, rows_of(found.ledger, file, "read")

    place, rows = read_cells(**cells)
    assert {key for key in cells if f"{key}: {key}" in rows} == read
    for key in cells.keys() - read:
        assert read_cells(**{name: value for name, value in cells.items() if name != key})[0] == place


def test_a_member_that_stands_twice_is_named(tmp_path, robots):
    file = tmp_path / "site.geojson"
    point = '{"type":"Point","coordinates":[8.5417,47.377]}'
    file.write_text(
        '{"type":"Feature","properties":{"name":"a","name":"b","duration":{"x":1},"duration":9},"geometry":'
        + point
        + "}",
        encoding="utf-8",
    )
    ledger = read_site(file, robots=robots).ledger
    assert_complete(ledger, file)
    lost = rows_of(ledger, file)
    assert lost["properties.name: stands again later in the same object"] == 1
    assert lost["properties.duration: stands again later in the same object"] == 2


def test_a_name_that_cannot_be_printed_is_escaped_and_cut(tmp_path, robots):
    file = tmp_path / "site.geojson"
    point = writers.feature("Point", [8.5417, 47.377], name="a")
    file.write_text(writers.geojson(point, **{"\x1b[31m\n": 1, "x" * 500: 2}), encoding="utf-8")
    lines = list(summary_lines(read_site(file, robots=robots).ledger))
    assert all(line.isprintable() and len(line) < 300 + len(str(file)) for line in lines)
    assert any("\\x1b[31m\\n" in line for line in lines)


@pytest.mark.long
def test_the_ledger_of_any_number_of_kinds_is_short_and_complete(tmp_path, robots):
    file = tmp_path / "site.geojson"
    point = writers.feature("Point", [8.5417, 47.377], **{f"p{k}": 1 for k in range(2_500)})
    file.write_text(writers.geojson(point), encoding="utf-8")
    ledger = read_site(file, robots=robots).ledger
    assert_complete(ledger, file)
    assert len(ledger.rows) < 2_100
    assert rows_of(ledger, file)["other kinds: means nothing for a task"] > 400


SHAPES = {
    "point": {"type": "Point", "coordinates": [8.5417, 47.3770]},
    "line": {"type": "LineString", "coordinates": [[8.5417, 47.3770], [8.5427, 47.3770]]},
    "area": {
        "type": "Polygon",
        "coordinates": [[[8.5418, 47.377], [8.542, 47.377], [8.542, 47.3772], [8.5418, 47.377]]],
    },
}
SHAPE_OF = {
    **dict.fromkeys(("task", "robot", "station"), "point"),
    **dict.fromkeys(("lane", "route"), "line"),
    **dict.fromkeys(("zone", "boundary", "survey"), "area"),
}
NEEDED = {"survey": {"width_m": "5", "height_m": "10"}, "station": {"services": "charge", "charge_per_s": "1"}}
VALUES = ("3", "yes", "a", "10:00", "air", "ground", "10:00-11:00", "swap", "0.5", "2027-03-01T10:00", "gripper")
SAME = {
    ("zone", "forbidden_to"),
    ("lane", "both_ways"),
    ("station", "partial"),
    ("zone", "name"),
    ("boundary", "name"),
    ("lane", "name"),
}
"""What is read and changes nothing here: what is the default, and names that may say what a feature is."""


def read_feature(folder, role, properties):
    """The mission of one feature of a role beside a robot and a task, and whether each of its properties was read."""
    features = [{"type": "Feature", "properties": {"kind": role, **properties}, "geometry": SHAPES[SHAPE_OF[role]]}]
    for kind, name in (("robot", "rr"), ("task", "a")):
        point = {"type": "Point", "coordinates": [8.5417, 47.3768]}
        properties = {"kind": kind, "called": name} | ({"moves": "air"} if kind == "robot" else {})
        features.append({"type": "Feature", "properties": properties, "geometry": point})
    file = folder / "site.geojson"
    file.write_text(json.dumps({"type": "FeatureCollection", "features": features}), encoding="utf-8")
    found = read_site(file, starts_at="2027-03-01T08:00", origin=ORIGIN)
    read = {row.kind.rpartition(".")[2] for row in found.ledger.rows if row.how == "read" and "properties." in row.kind}
    return file_data(found.mission), read


@pytest.mark.long
@pytest.mark.parametrize("role", ROLES)
def test_what_is_read_changes_the_mission_and_what_is_passed_over_does_not(role, tmp_path):
    tried = 0
    for key in sorted(keys_of(role)):
        needed = {name: value for name, value in NEEDED.get(role, {}).items() if name != key}
        for value in VALUES if key != "kind" else ():
            try:
                without, _ = read_feature(
                    tmp_path, role, NEEDED.get(role, {}) if key in NEEDED.get(role, {}) else needed
                )
                mission, read = read_feature(tmp_path, role, needed | {key: value})
            except MissionError:
                continue
            tried += 1
            assert (key in read) == (mission != without) or (role, key) in SAME, (role, key, value)
            break
    assert tried or role == "route"


names = st.text(st.characters(codec="utf-8", categories=["L", "N"]), min_size=1, max_size=6)
plain = st.none() | st.booleans() | st.integers(-9, 9) | st.sampled_from(["", "a", "90", "3 m"])
members = st.dictionaries(
    names, st.recursive(plain, lambda s: st.lists(s, max_size=2) | st.dictionaries(names, s), max_leaves=4), max_size=3
)
properties = st.dictionaries(
    names | st.sampled_from(["name", "id", "duration", "height", "priority", "kind"]), plain, max_size=4
)
geometries = st.sampled_from([*SHAPES.values(), None])


@st.composite
def collections(draw):
    """A collection of features with members that nobody knows anywhere."""
    features = [
        draw(members)
        | {
            "type": "Feature",
            "properties": draw(properties | st.none()),
            "geometry": with_members(draw, draw(geometries)),
        }
        for _ in range(draw(st.integers(1, 4)))
    ]
    return draw(members) | {"type": "FeatureCollection", "features": features}


def with_members(draw, geometry):
    return None if geometry is None else draw(members) | geometry


@examples(60)
@given(collections())
def test_members_of_any_geojson_are_accounted_for(tmp_path_factory, data):
    folder = tmp_path_factory.mktemp("any", numbered=True)
    assert_accounted_for(folder, "geojson", json.dumps(data))


xml_names = st.sampled_from(
    ["name", "description", "x", "Data", "TimeSpan", "Style", "Folder", "ExtendedData", "value"]
)


@st.composite
def elements(draw, depth=2):
    """An element that may mean something in its place, or nothing."""
    name = draw(xml_names)
    attributes = "".join(
        f" {key}='{draw(st.sampled_from(['a', '', 'duration']))}'" for key in draw(st.sets(xml_names, max_size=2))
    )
    inside = (
        "".join(draw(st.lists(elements(depth - 1), max_size=2))) if depth else draw(st.sampled_from(["", "t", "90"]))
    )
    return f"<{name}{attributes}>{inside}</{name}>"


@examples(60)
@given(st.lists(elements(), max_size=3), st.lists(st.lists(elements(), max_size=3), min_size=1, max_size=3))
def test_elements_of_any_kml_are_accounted_for(tmp_path_factory, around, within):
    point = "<Point><extrude>1</extrude><coordinates>8.5417,47.377</coordinates></Point>"
    marks = [f"<Placemark>{''.join(one)}{point}</Placemark>" for one in within]
    folder = tmp_path_factory.mktemp("any", numbered=True)
    assert_accounted_for(folder, "kml", writers.kml(*around, *marks))


def assert_accounted_for(folder, kind, text):
    """The file is refused in lines that name it, or its ledger is complete."""
    file, robots = folder / f"site.{kind}", folder / "robots.csv"
    file.write_text(text, encoding="utf-8")
    robots.write_text(writers.ROBOTS, encoding="utf-8")
    ledger, refused = None, ()
    try:
        ledger = muster.read_site(file, robots=robots).ledger
    except MissionError as error:
        refused = error.findings
    if ledger is None:
        assert refused
        assert all(finding.file and finding.expected for finding in refused)
    else:
        assert_complete(ledger, file)
