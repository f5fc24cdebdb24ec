"""Stations, charges and loads in the files of other programs."""

import csv
import json
from xml.etree import ElementTree as Tree

import pytest

from muster import load, verify
from muster.execution.itinerary import itineraries
from muster.mission.reading.plan_reader import plan_of
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported
from muster_files.earth import Earth
from muster_files.geographic_features import features_of
from muster_files.geojson import geojson_text
from muster_files.gpx import gpx_text
from muster_files.kml import kml_text
from muster_files.qgc.plan_format import NAV_WAYPOINT

GPX, KML = "{http://www.topografix.com/GPX/1/1}", "{http://www.opengis.net/kml/2.2}"
BAY = """\
schema: muster/1
name: bay
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
rules: {timing: constant}
stations:
  - {id: pad, position: [60, 0, 2], services: [charge], charge_per_s: 2}
  - {id: spare, position: [0, 90, 2], services: [swap]}
robots:
  - {id: r, position: [0, 0, 2], kind: air, load_capacity: 3, battery: {capacity: 100}}
  - {id: s, position: [60, 10, 2], battery: {capacity: 100}}
tasks:
  - {id: pier, position: [40, 0, 2], load: 2}
  - {id: buoy, position: [90, 0, 2], delivers: pier, duration_s: 5}
"""
ROUTES = {"r": ["pier", "pad", "buoy"], "s": ["pad"]}
# s charges first, from 10 to 15 s; r, there after 60 s, adds 60 m in 30 s, and is at the buoy after 120 s with 70 m.


@pytest.fixture
def bay(tmp_path):
    (tmp_path / "bay.yaml").write_text(BAY, encoding="utf-8")
    mission = load(tmp_path / "bay.yaml")
    return mission, verify(mission, plan_of(ROUTES))


@pytest.fixture
def seen(bay):
    mission, verdict = bay
    return features_of(mission, verdict, itineraries(mission, verdict), Earth.of(mission, "a test"))


def test_a_station_is_a_stop_of_the_itinerary(bay):
    passages = itineraries(*bay)[0].passages
    assert [(p.task, p.station, p.arrives_s, p.leaves_s) for p in passages] == [
        (None, None, 0, 0),
        ("pier", None, 40, 40),
        (None, "pad", 60, 90),
        ("buoy", None, 120, 125),
    ]


def test_geojson_says_who_is_served_when(seen):
    features = {f["properties"]["name"]: f["properties"] for f in json.loads(geojson_text(seen))["features"]}
    pad = features["pad"]
    assert (pad["kind"], pad["services"], pad["slots"]) == ("station", ["charge"], 1)
    assert (pad["robots"], pad["orders"]) == (["r", "s"], [2, 1])
    assert (pad["arrives_s"], pad["ends_s"], pad["charged"]) == ([60, 10], [90, 15], [60, 10])
    assert features["spare"]["robots"] == []
    assert (features["pier"]["load"], features["buoy"]["delivers"]) == (2, "pier")
    assert features["buoy"]["orders"] == [3]
    assert [f.properties.get("stops") for f in seen.routes] == [["pier", "[pad]", "buoy"], ["[pad]"]]


def test_gpx_and_kml_have_stations_as_places(seen):
    root = Tree.fromstring(gpx_text(seen))
    told = {point.find(f"{GPX}name").text: point.find(f"{GPX}desc").text for point in root.iter(f"{GPX}wpt")}
    calls = "robot r, number 2, from 60.0 s to 90.0 s; robot s, number 1, from 10.0 s to 15.0 s"
    assert told["pad"] == f"station, charge; {calls}"
    assert told["spare"] == "station, swap"
    assert [route.find(f"{GPX}desc").text for route in root.iter(f"{GPX}rte")] == [
        "tasks pier [pad] buoy",
        "tasks [pad]",
    ]
    folders = Tree.fromstring(kml_text(seen)).iter(f"{KML}Folder")
    names = {f.find(f"{KML}name").text: [m.find(f"{KML}name").text for m in f.iter(f"{KML}Placemark")] for f in folders}
    assert names["stations"] == ["pad", "spare"]


def test_csv_has_a_line_for_each_stop_with_charge_level_and_load(bay):
    rows = list(csv.DictReader(exported(*bay, "csv", ExportOptions()).texts["plan.csv"].splitlines()))
    assert [(row["robot"], row["order"], row["task"], row["station"]) for row in rows] == [
        ("r", "1", "pier", ""),
        ("r", "2", "", "pad"),
        ("r", "3", "buoy", ""),
        ("s", "1", "", "pad"),
    ]
    assert [(row["charged_m"], row["level_m"], row["load"]) for row in rows] == [
        ("", "60.0", "2"),
        ("60.0", "100.0", "2"),
        ("", "70.0", "0"),
        ("10.0", "100.0", "0"),
    ]


def test_qgroundcontrol_holds_at_a_station_for_its_service(bay):
    files = exported(*bay, "qgc", ExportOptions())
    items = json.loads(files.texts["r.plan"])["mission"]["items"]
    assert [item["params"][0] for item in items if item["command"] == NAV_WAYPOINT] == [0, 30, 5]
    assert "r: holds at pad for its service; whether it lands there is up to you" in files.messages


def test_a_solution_names_stations_in_their_places(bay):
    assert (
        exported(*bay, "sol", ExportOptions()).texts["plan.sol"].startswith("Route #1: pier pad buoy\nRoute #2: pad\n")
    )
