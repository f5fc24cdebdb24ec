"""GeoJSON, GPX and KML of a plan: which of latitude and longitude comes first, winding, order of elements, odd ids."""

import csv
import json
import re
from xml.etree import ElementTree as Tree

import numpy as np
import pytest
from tests.muster_files.bay import ALT, BAY, LAT, LON, ROUTES, bay

from muster.mission.geodesy import wgs84_to_enu
from muster_files.earth import Earth
from muster_files.geographic_features import features_of
from muster_files.geojson import geojson_text
from muster_files.gpx import gpx_text
from muster_files.kml import kml_text
from muster_files.spreadsheet import csv_text
from muster_files.xml_text import add, text_of

ROBOTS = list(ROUTES)
GPX, KML = "{http://www.topografix.com/GPX/1/1}", "{http://www.opengis.net/kml/2.2}"


@pytest.fixture
def seen(tmp_path):
    return seen_in(tmp_path)


def seen_in(folder, text=BAY):
    mission, verdict, team = bay(folder, text)
    return features_of(mission, verdict, team, Earth.of(mission, "a test"))


def metres(lon, lat, alt=ALT):
    return wgs84_to_enu([(lat, lon, alt)], (LAT, LON, ALT))[0]


def positions(geometry):
    found = geometry["coordinates"]
    if geometry["type"] == "Point":
        return [found]
    return found if geometry["type"] == "LineString" else [place for ring in found for place in ring]


def test_geojson_has_longitude_first(seen):
    data = json.loads(geojson_text(seen))
    assert data["type"] == "FeatureCollection"
    for feature in data["features"]:
        assert set(feature) == {"type", "geometry", "properties"}
        for lon, lat, *_ in positions(feature["geometry"]):
            assert (lon, lat) == pytest.approx((LON, LAT), abs=0.01)


def test_geojson_has_every_thing(seen):
    features = json.loads(geojson_text(seen))["features"]
    names = {}
    for feature in features:
        names.setdefault(feature["properties"]["kind"], []).append(feature["properties"]["name"])
    assert names == {
        "boundary": ["boundary"],
        "zone": ["zone 0", "zone 1", "zone 2"],
        "route": ["d1", "d2", "d3", "rover"],
        "task": ["a", "b", "c", "e", "g", "left"],
        "robot": ROBOTS,
    }
    (a,) = [f for f in features if f["properties"]["name"] == "a"]
    assert (a["properties"]["robots"], a["properties"]["orders"]) == (["d2"], [1])
    assert a["properties"]["ends_s"] == pytest.approx(np.linalg.norm([97, 40, 20]) / 4 + 10)
    assert metres(*a["geometry"]["coordinates"]) == pytest.approx((100, 40, 20), abs=1e-3)


@pytest.mark.parametrize("turned", [False, True])
def test_geojson_polygons_are_closed_and_have_their_inside_to_the_left(turned, tmp_path):
    own = "[[60, 20], [90, 20], [90, 60], [60, 60]]"
    other = "[[60, 60], [90, 60], [90, 20], [60, 20]]"
    seen = seen_in(tmp_path, BAY.replace(own, other) if turned else BAY)
    rings = [f["geometry"]["coordinates"] for f in json.loads(geojson_text(seen))["features"]]
    rings = [ring for (ring, *_), area in zip(rings, seen.features, strict=True) if area.kind in ("boundary", "zone")]
    assert len(rings) == 4
    for ring in rings:
        assert ring[0] == ring[-1]
        lon, lat = np.array(ring).T
        assert np.sum(lon[:-1] * lat[1:] - lon[1:] * lat[:-1]) > 0


def test_a_mission_in_the_plane_has_no_heights(tmp_path):
    text = re.sub(r"(position: \[[^],]*, [^],]*), [^],]*\]", r"\1]", BAY)
    aside = text.replace("60, 20], [90, 20], [90, 60], [60, 60", "60, -90], [90, -90], [90, -81], [60, -81")
    seen = seen_in(tmp_path, aside)
    features = json.loads(geojson_text(seen))["features"]
    assert {len(p) for feature in features for p in positions(feature["geometry"])} == {2}
    assert "<ele>" not in gpx_text(seen)
    assert "relativeToGround" not in kml_text(seen)


def test_gpx_has_places_then_routes_with_their_elements_in_order(seen):
    root = Tree.fromstring(gpx_text(seen))
    assert (root.tag, root.get("version")) == (f"{GPX}gpx", "1.1")
    assert [child.tag.removeprefix(GPX) for child in root] == ["metadata", *["wpt"] * 11, *["rte"] * 4]
    orders = {"wpt": ["ele", "name", "desc", "type"], "rte": ["name", "desc", "number"], "rtept": ["ele"]}
    for element in root.iter():
        order = orders.get(element.tag.removeprefix(GPX))
        if order is not None:
            assert [child.tag.removeprefix(GPX) for child in element if child.tag != f"{GPX}rtept"] == order
    for point in root.iter():
        if point.get("lat") is not None:
            assert (float(point.get("lat")), float(point.get("lon"))) == pytest.approx((LAT, LON), abs=0.01)
    route = root.find(f"{GPX}rte[2]")
    assert route.find(f"{GPX}name").text == "d2"
    goal = route.findall(f"{GPX}rtept")[1]
    place = metres(float(goal.get("lon")), float(goal.get("lat")), float(goal.find(f"{GPX}ele").text))
    assert place == pytest.approx((100, 40, 20), abs=1e-3)


def test_kml_has_longitude_first_and_its_elements_in_order(seen):
    root = Tree.fromstring(kml_text(seen))
    marks = list(root.iter(f"{KML}Placemark"))
    assert len(marks) == 4 + 4 + 6 + 5
    for mark in marks:
        tags = [child.tag.removeprefix(KML) for child in mark]
        assert tags[:2] == ["name", "ExtendedData"]
        assert tags[2:] in (["Point"], ["LineString"], ["Polygon"])
        for shape in mark.iter():
            if shape.tag in (f"{KML}Point", f"{KML}LineString"):
                assert [child.tag.removeprefix(KML) for child in shape] == ["altitudeMode", "coordinates"]
    for element in root.iter(f"{KML}coordinates"):
        for place in element.text.split():
            lon, lat, _ = map(float, place.split(","))
            assert (lon, lat) == pytest.approx((LON, LAT), abs=0.01)
    for ring in root.iter(f"{KML}LinearRing"):
        places = ring.find(f"{KML}coordinates").text.split()
        assert places[0] == places[-1]


@pytest.mark.parametrize("write", [gpx_text, kml_text])
def test_xml_survives_odd_ids(write, tmp_path):
    text = BAY.replace("id: left", r'id: "<&\">é日"')
    root = Tree.fromstring(write(seen_in(tmp_path, text)))
    assert '<&">é日' in {element.text for element in root.iter()}


def test_what_xml_cannot_hold_is_replaced():
    root = Tree.Element("a")
    add(root, "b", "x\u0007\ufffe\ty")
    assert Tree.fromstring(text_of(root))[0].text == "x\ufffd\ufffd\ty"


def test_csv_has_a_line_for_each_visit_and_each_task_left_out(tmp_path):
    mission, verdict, _ = bay(tmp_path)
    head, *lines = [line.split(",") for line in csv_text(mission, verdict, Earth.of(mission, "a test")).splitlines()]
    assert head == [
        *("robot", "order", "task", "x", "y", "z", "lat_deg", "lon_deg"),
        *("arrives_s", "starts_s", "ends_s", "usage_m", "waits_s", "late_s", "with"),
    ]
    assert [line[:3] for line in lines] == [
        ["d1", "1", "b"],
        ["d1", "2", "c"],
        ["d2", "1", "a"],
        ["d3", "1", "e"],
        ["rover", "1", "g"],
        ["", "", "left"],
    ]
    a = [float(word) for word in lines[2][3:-2]]
    away = np.linalg.norm([97, 40, 20])
    assert a[:3] == [100, 40, 20]
    assert a[3:5] == pytest.approx((LAT, LON), abs=0.01)
    assert a[5:] == pytest.approx([away / 4, away / 4, away / 4 + 10, away, 0], abs=1e-4)
    assert lines[2][-2:] == ["", ""]


def test_csv_needs_no_origin(tmp_path):
    mission, verdict, _ = bay(tmp_path, re.sub("origin_wgs84.*\n", "", BAY))
    lines = csv_text(mission, verdict, None).splitlines()
    assert lines[1].startswith("d1,1,b,40.0,90.0,15.0,,,")


@pytest.mark.parametrize("begin", ["=", "+", "-", "@"])
def test_no_id_in_csv_is_a_formula(begin, tmp_path):
    name = f"{begin}1+2"
    mission, verdict, _ = bay(tmp_path, BAY.replace("id: left", f'id: "{name}"'))
    *_, left = csv.reader(csv_text(mission, verdict, None).splitlines())
    assert left[:3] == ["", "", f"'{name}"]
    assert float(left[3]) == 30  # numbers stay numbers
