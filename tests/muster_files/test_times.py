"""Times, limits of time and teams in the files of other programs."""

import csv
import json
from xml.etree import ElementTree as Tree

import pytest

from muster import load, verify
from muster.execution.itinerary import itineraries
from muster.mission.reading.plan_reader import plan_of
from muster_files.earth import Earth
from muster_files.geographic_features import features_of
from muster_files.geojson import geojson_text
from muster_files.gpx import gpx_text
from muster_files.kml import kml_text
from muster_files.spreadsheet import csv_text

GPX, KML = "{http://www.topografix.com/GPX/1/1}", "{http://www.opengis.net/kml/2.2}"
LIFT = """\
schema: muster/1
name: lift
starts_at: 2027-03-01T23:59:00+01:00
origin_wgs84: {lat_deg: 35.53, lon_deg: -124.06}
rules: {objective: lateness, timing: constant}
robots:
  - {id: r_1, position: [0, 0]}
  - {id: "=r", position: [0, 10], available_from_s: 5}
tasks:
  - {id: beam, position: [20, 0], duration_s: 60, robots_needed: 2, window: ["00:00", "00:30"], due: "00:00:45"}
  - {id: scan, position: [20, 30], duration_s: 10, deadline: "00:10"}
  - {id: left, position: [50, 50], window_s: [[0, 10], [20, null]]}
"""
ROUTES = {"r_1": ["beam"], "=r": ["beam", "scan"]}
# "=r" is at the beam after 5 + 22.36 s, r_1 after 20 s; the window opens after 60 s, and the beam is due after 105 s.


def given(folder, text=LIFT):
    (folder / "lift.yaml").write_text(text, encoding="utf-8")
    mission = load(folder / "lift.yaml")
    return mission, verify(mission, plan_of(ROUTES))


def seen(folder, text=LIFT):
    mission, verdict = given(folder, text)
    return features_of(mission, verdict, itineraries(mission, verdict), Earth.of(mission, "a test"))


def task_in(folder, name, text=LIFT):
    features = json.loads(geojson_text(seen(folder, text)))["features"]
    (found,) = [f["properties"] for f in features if f["properties"]["name"] == name]
    return found


def test_geojson_names_every_robot_of_a_team_and_its_times(tmp_path):
    beam = task_in(tmp_path, "beam")
    assert beam["robots"] == ["r_1", "=r"]
    assert beam["orders"] == [1, 1]
    assert beam["arrives_s"] == pytest.approx([20, 5 + 500**0.5])
    assert beam["waits_s"] == pytest.approx([40, 55 - 500**0.5])
    assert (beam["starts_s"], beam["ends_s"], beam["late_s"]) == pytest.approx((60, 120, 15))
    assert (beam["starts_at"], beam["ends_at"]) == ("2027-03-02T00:00:00.000+01:00", "2027-03-02T00:01:00.000+01:00")
    assert (beam["window_s"], beam["due_s"]) == ([[60, 1860]], 105)
    assert task_in(tmp_path, "scan")["deadline_s"] == 660


def test_geojson_has_the_limits_of_a_task_left_out(tmp_path):
    left = task_in(tmp_path, "left")
    assert left["robots"] == []
    assert left["window_s"] == [[0, 10], [20, None]]
    assert "starts_s" not in left


def test_gpx_has_times_in_utc(tmp_path):
    root = Tree.fromstring(gpx_text(seen(tmp_path)))
    times = {point.find(f"{GPX}name").text: point.find(f"{GPX}time") for point in root.iter(f"{GPX}wpt")}
    assert times["beam"].text == "2027-03-01T23:00:00.000Z"
    assert times["left"] is times["r_1"] is None
    told = {point.find(f"{GPX}name").text: point.find(f"{GPX}desc").text for point in root.iter(f"{GPX}wpt")}
    assert told["beam"] == "robot r_1, number 1 and robot =r, number 1, from 60.0 s to 120.0 s, 15.0 s late"
    (second,) = [route for route in root.iter(f"{GPX}rte") if route.find(f"{GPX}name").text == "=r"]
    points = [point.find(f"{GPX}time").text for point in second.iter(f"{GPX}rtept")]
    assert points[0] == "2027-03-01T22:59:05.000Z"  # when it leaves its start
    assert points[-1] == "2027-03-01T23:01:30.000Z"  # 120 s of work, and 30 m of way
    for point in root.iter(f"{GPX}wpt"):
        tags = [child.tag.removeprefix(GPX) for child in point]
        assert tags == [tag for tag in ("ele", "time", "name", "desc", "type") if tag in tags]


def test_kml_has_spans_of_time_where_the_schema_wants_them(tmp_path):
    root = Tree.fromstring(kml_text(seen(tmp_path)))
    marks = {mark.find(f"{KML}name").text: mark for mark in root.iter(f"{KML}Placemark")}
    assert [child.tag.removeprefix(KML) for child in marks["beam"]] == ["name", "TimeSpan", "ExtendedData", "Point"]
    span = marks["beam"].find(f"{KML}TimeSpan")
    assert [child.text for child in span] == ["2027-03-01T23:00:00.000Z", "2027-03-01T23:01:00.000Z"]
    data = {one.get("name"): one.find(f"{KML}value").text for one in marks["beam"].iter(f"{KML}Data")}
    assert (data["robots"], data["window_s"]) == ("r_1 =r", "[[60.0, 1860.0]]")
    assert marks["left"].find(f"{KML}TimeSpan") is None


@pytest.mark.parametrize("write", [gpx_text, kml_text])
def test_a_start_without_zone_gives_no_times_in_utc(write, tmp_path):
    text = write(seen(tmp_path, LIFT.replace("00+01:00", "00")))
    assert not {"<time>", "<TimeSpan>"} & set(text.split())
    assert task_in(tmp_path, "beam", LIFT.replace("00+01:00", "00"))["starts_at"] == "2027-03-02T00:00:00.000"


def test_csv_has_the_columns_of_the_schedule(tmp_path):
    mission, verdict = given(tmp_path)
    lines = list(csv.DictReader(csv_text(mission, verdict, None).splitlines()))
    first, second, scan, left = lines
    assert (first["robot"], first["task"], first["with"]) == ("r_1", "beam", "'=r")
    assert (second["robot"], second["with"]) == ("'=r", "r_1")
    assert [float(first[name]) for name in ("arrives_s", "starts_s", "ends_s", "waits_s", "late_s")] == [
        *(20, 60, 120, 40, 15)
    ]
    assert first["starts_at"] == "2027-03-02T00:00:00.000+01:00"
    assert (scan["late_s"], scan["with"]) == ("", "")
    assert {left[name] for name in ("robot", "order", "starts_s", "waits_s", "with", "ends_at")} == {""}
    assert None not in left  # no more cells than columns


def test_csv_without_a_start_has_no_clock_times(tmp_path):
    text = LIFT.replace("starts_at: 2027-03-01T23:59:00+01:00\n", "").replace('deadline: "00:10"', "deadline_s: 660")
    text = text.replace('window: ["00:00", "00:30"], due: "00:00:45"', "window_s: [60, 90], due_s: 105")
    head = csv_text(*given(tmp_path, text), None).splitlines()[0]
    assert head.endswith(",ends_s,usage_m,waits_s,late_s,with")
