"""One feature that does not matter refuses no site: it is cut, made whole or passed over, and named.

What becomes a task or a robot is read strictly, and nothing that is closed opens by it.
"""

import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from shapely.affinity import translate
from tests.mission.strategies import examples
from tests.muster_files.sites import writers
from tests.muster_files.sites.writers import area, feature, geojson, points

from muster import MissionError, load, read_site
from muster_files.sites.shapes import mended

ORIGIN = (47.377, 8.542)
FAR = [(18.95, 69.64), (18.96, 69.64), (18.96, 69.65)]


@pytest.fixture
def team(tmp_path):
    file = tmp_path / "drones.csv"
    file.write_text("id,lat,lon\nd1,47.3768,8.5416\n", encoding="utf-8")
    return file


def site(folder, team, *features, **options):
    file = folder / "site.geojson"
    file.write_text(geojson(*features), encoding="utf-8")
    return read_site(file, robots=team, **options)


def zones(found):
    return [] if found.mission.map is None else [shapely.Polygon(zone.polygon) for zone in found.mission.map.zones]


@pytest.mark.parametrize("origin", [None, ORIGIN])
@pytest.mark.parametrize(
    "far",
    [
        area(FAR, name="No-fly north"),
        feature("Point", [18.95, 69.64], name="No-fly mast", radius="2 km"),
        feature("LineString", [[18.95, 69.64], [18.96, 69.65]], name="Road north"),
    ],
)
def test_what_is_far_is_passed_over_and_named(tmp_path, team, far, origin):
    found = site(tmp_path, team, area(name="Keep out"), far, *points(), origin=origin)
    assert (len(zones(found)), found.mission.lanes, len(found.mission.tasks)) == (1, None, 3)
    assert any("passed over, farther than 100 km" in note and far["properties"]["name"] in note for note in found.notes)
    assert abs(found.mission.origin_wgs84.lat_deg - 47.377) < 0.01


@pytest.mark.parametrize("origin", [None, ORIGIN])
def test_a_closed_area_that_reaches_far_is_cut_and_covers_what_it_covered(tmp_path, team, origin):
    country = area([(2, 44), (15, 44), (15, 50), (2, 50)], name="Keep out of all of it")
    hole = [(8.5410, 47.3760), (8.5430, 47.3760), (8.5430, 47.3780), (8.5410, 47.3780)]
    found = site(tmp_path, team, country, *points(), origin=origin)
    assert any("cut at 100 km" in note for note in found.notes)
    whole = shapely.union_all(zones(found))
    assert whole.covers(shapely.box(-60_000, -60_000, 60_000, 60_000))
    free = site(tmp_path, team, area([(2, 44), (15, 44), (15, 50), (2, 50)], [hole], name="Keep out"), *points())
    places = [shapely.Point(task.position[:2]) for task in free.mission.tasks]
    assert not any(zone.intersects(place) for zone in zones(free) for place in places)


@pytest.mark.parametrize(
    "wrong",
    [
        feature("Point", [18.95, 69.64], name="task"),
        area(FAR, name="Search", width_m=5),
        area(FAR, name="Perimeter"),
        area([(47.377, 8.5416), (47.3775, 8.5416), (47.3775, 8.542)], name="No-fly swapped"),
        area([(8.5416, 47.377), (8.542, 47.377), (0, 0)], name="No-fly with a corner at 0, 0"),
    ],
)
@pytest.mark.parametrize("origin", [None, ORIGIN])
def test_what_is_needed_or_mistaken_is_refused(tmp_path, team, wrong, origin):
    with pytest.raises(MissionError, match=r"within 100 km of the origin.*swapped, or 0"):
        site(tmp_path, team, wrong, *points(), origin=origin)


BOW = [(8.5418, 47.3770), (8.5424, 47.3774), (8.5424, 47.3770), (8.5418, 47.3774)]


@pytest.mark.parametrize("properties", [{"building": "yes"}, {"name": "No-fly"}])
def test_a_closed_area_whose_sides_cross_is_closed_in_both_its_lobes(tmp_path, team, properties):
    found = site(tmp_path, team, area(BOW, **properties), *points(), origin=ORIGIN)
    (note,) = [note for note in found.notes if "closed areas whose sides cross are closed as a whole" in note]
    assert "self-intersection at latitude 47.3772" in note
    frame = found.mission.map
    west, east = (shapely.Polygon(zone.polygon).centroid.x for zone in sorted(frame.zones, key=lambda z: z.polygon[0]))
    assert len(frame.zones) == 2
    assert west != east
    with pytest.raises(MissionError, match="geometry: self-intersection at latitude"):
        site(tmp_path, team, area(BOW, name="Perimeter"), *points())


places = st.tuples(st.floats(-100, 100), st.floats(-100, 100))


@examples(300)
@given(st.lists(places, min_size=3, max_size=9))
def test_what_a_ring_may_mean_is_in_what_is_made_of_it(ring):
    """By the rule of even and odd, by that of turns, and as the valid area that GEOS makes of it."""
    line = shapely.LineString([*ring, ring[0]])
    try:
        whole = shapely.union_all(mended([[list(place) for place in ring]]))
    except ValueError:
        assert shapely.make_valid(shapely.Polygon(ring)).area < 1e-9
        return
    for meant in (shapely.make_valid(shapely.Polygon(ring)), shapely.Polygon(ring).buffer(0)):
        assert shapely.difference(meant, whole.buffer(1e-6)).area < 1e-6
    assert shapely.convex_hull(line).buffer(1e-6).covers(whole)


def test_holes_of_what_crosses_itself_are_closed_too():
    ring = [(0, 0), (10, 10), (10, 0), (0, 10)]
    hole = [(8.0, 4.0), (9.0, 4.0), (9.0, 6.0), (8.0, 6.0)]
    whole = shapely.union_all(mended([ring, hole]))
    assert whole.covers(shapely.Polygon(hole))
    assert not whole.intersects(translate(shapely.Polygon(hole), yoff=-3.9).buffer(-0.5))


@pytest.mark.parametrize("ring", [[(8.54, 47.37), (8.541, 47.371), (8.54, 47.37)], [(8.54, 47.37)] * 3])
def test_a_closed_area_that_encloses_nothing_is_refused(tmp_path, team, ring):
    with pytest.raises(MissionError, match="an area whose sides meet at its corners alone"):
        site(tmp_path, team, area(ring, name="No-fly"), *points())


@pytest.mark.parametrize(
    "tags",
    [
        {"highway": "service", "service": "driveway"},
        {"opening_hours": "Mo-Fr 08:00-18:00", "amenity": "cafe"},
        {"from": "Zug", "to": "Baar", "by": "bus"},
        {"title": "Reserve, 500 ft", "label": "x"},
        {"importance": "high", "cost": "low", "crew": "two"},
    ],
)
def test_tags_of_maps_that_look_like_keys_are_not_read_and_named(tmp_path, team, tags):
    mast = feature("Point", [8.5417, 47.3775], name="mast", **tags)
    found = site(tmp_path, team, mast)
    assert [task.id for task in found.mission.tasks] == ["mast"]
    (note,) = [note for note in found.notes if "site.geojson: not read: " in note] or [""]
    assert all(key in note for key in tags)


def test_a_column_of_durations_is_read_strictly(tmp_path, team):
    given = [
        feature("Point", [8.5417, 47.377 + k / 1e4], name=f"t{k}", service=v) for k, v in enumerate(["5 min", "x"])
    ]
    with pytest.raises(MissionError, match="service: x; expected a duration"):
        site(tmp_path, team, *given)


NAMES = [
    ("Vogel\u00adschutz\u00adgebiet", "Vogelschutzgebiet"),
    ("می\u200cخو", "می\u200cخو"),
    ("क्\u200dष", "क्\u200dष"),
    ("Turm\u200b 3", "Turm 3"),
    ("\ufeffmast", "mast"),
    ("👩\u200d🚒 fire", "👩\u200d🚒 fire"),
    ("\u202amast\u202c", "mast"),
    ("mast\u00a03", "mast 3"),
    ("Ort\u2028Zwei", "Ort Zwei"),
]


@pytest.mark.parametrize(("written", "read"), NAMES)
@pytest.mark.parametrize("form", ["csv", "kml", "geojson"])
def test_marks_that_nobody_sees_are_no_control_characters(tmp_path, team, written, read, form):
    file = tmp_path / f"site.{form}"
    place = "<Point><coordinates>8.5417,47.3775</coordinates></Point>"
    text = {
        "csv": f'name,lat,lon,kind\n"{written}",47.3775,8.5417,task\n',
        "kml": writers.kml("<Folder><name>Tasks</name>", writers.placemark(written, place), "</Folder>"),
        "geojson": geojson(feature("Point", [8.5417, 47.3775], name=written, kind="task")),
    }[form]
    file.write_text(text, encoding="utf-8")
    found = read_site(file, robots=team, kinds={read: "task"})
    assert [task.id for task in found.mission.tasks] == [read]
    found.mission.save(tmp_path / "again.yaml")
    assert load(tmp_path / "again.yaml") == found.mission


@pytest.mark.parametrize("sign", ["\x07", "\x1b[31m"])
def test_control_characters_are_refused(tmp_path, team, sign):
    with pytest.raises(MissionError, match="a text without control characters"):
        site(tmp_path, team, feature("Point", [8.5417, 47.3775], name=f"a{sign}b"))


@pytest.mark.parametrize("form", ["kml", "geojson"])
def test_the_label_of_an_area_is_no_place(tmp_path, team, form):
    ring = [(8.5418, 47.3770), (8.5424, 47.3770), (8.5424, 47.3774)]
    if form == "kml":
        text = " ".join(f"{lon},{lat}" for lon, lat in [*ring, ring[0]])
        shape = (
            "<MultiGeometry><Point><coordinates>8.542,47.3772</coordinates></Point><Polygon><outerBoundaryIs><LinearRing>"
            f"<coordinates>{text}</coordinates></LinearRing></outerBoundaryIs></Polygon></MultiGeometry>"
        )
        text = writers.kml(writers.placemark("No-fly: school", shape), *writers.kml_points())
    else:
        parts = [{"type": "Point", "coordinates": [8.542, 47.3772]}, area(ring)["geometry"]]
        both = {"type": "GeometryCollection", "geometries": parts}
        text = geojson({"type": "Feature", "properties": {"name": "No-fly: school"}, "geometry": both}, *points())
    file = tmp_path / f"site.{form}"
    file.write_text(text, encoding="utf-8")
    found = read_site(file, robots=team)
    assert (len(found.mission.tasks), len(zones(found))) == (3, 1)
    assert any("points beside areas of the same feature" in note for note in found.notes)


STRAIGHT = [(8.5418, 47.3770), (8.5424, 47.3774)]
BENT = [(8.5418, 47.3770), (8.542, 47.377), (8.542, 47.3776)]


@pytest.mark.parametrize("line", [STRAIGHT, BENT])
@pytest.mark.parametrize("properties", [{"barrier": "fence"}, {"name": "Wall north"}, {"name": "No entry"}])
def test_an_open_line_that_is_closed_lets_nobody_across(tmp_path, team, line, properties):
    found = site(tmp_path, team, feature("LineString", [list(place) for place in line], **properties), *points())
    assert found.mission.lanes is None
    whole = shapely.union_all(zones(found))
    assert any("closed lines are closed 0.25 m to each side" in note for note in found.notes)
    across = shapely.convex_hull(whole)
    assert whole.area > 0
    assert (len(line) > 2 and "No entry" in properties.values()) == (whole.area > 0.8 * across.area and len(line) > 2)
