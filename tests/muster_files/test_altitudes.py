"""Drones that share the air fly at heights of their own, in every format, and what comes too close is named."""

import json
from xml.etree import ElementTree as Tree

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster import ParameterError, load, verify
from muster.mission.reading.plan_reader import plan_of
from muster.planning.export_formats import ExportOptions, altitudes_in
from muster.planning.exporting import exported
from muster_files.altitudes import altitudes_of

KML = "{http://www.opengis.net/kml/2.2}"
CROSSING = """\
schema: muster/1
name: crossing
origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}
robots:
  - {id: d1, position: [0, 0], kind: air, radius_m: 0.5}
  - {id: rover, position: [0, 90], radius_m: 0.5}
  - {id: d2, position: [50, -50], kind: air, radius_m: 0.5}
tasks:
  - {id: east, position: [100, 0]}
  - {id: north, position: [50, 50]}
  - {id: ground, position: [0, 95]}
"""
ROUTES = {"d1": ["east"], "rover": ["ground"], "d2": ["north"]}
# d1 and d2 are at (50, 0) at the same moment, after 50 s.


@pytest.fixture
def crossing(tmp_path):
    def made(text=CROSSING):
        (tmp_path / "m.yaml").write_text(text, encoding="utf-8")
        mission = load(tmp_path / "m.yaml")
        return mission, verify(mission, plan_of(ROUTES))

    return made


def test_layers_follow_the_order_of_drones(crossing):
    mission, _ = crossing()
    assert altitudes_of(mission, ExportOptions()) == {}
    assert altitudes_of(mission, ExportOptions(altitude=30)) == {"d1": 30, "d2": 30}
    assert altitudes_of(mission, ExportOptions(altitude_step=10)) == {"d1": 10, "d2": 20}
    assert altitudes_of(mission, ExportOptions(altitude=30, altitude_step=5)) == {"d1": 30, "d2": 35}
    assert altitudes_of(mission, ExportOptions(altitude=30, altitudes={"d1": 60})) == {"d1": 60, "d2": 30}
    assert altitudes_of(mission, ExportOptions(altitudes={"d2": 60})) == {"d2": 60}


@pytest.mark.parametrize("name", ["rover", "d3"])
def test_only_drones_have_heights(name, crossing):
    mission, _ = crossing()
    with pytest.raises(ParameterError, match=f"altitudes: {name}; expected robots of kind air: d1, d2"):
        altitudes_of(mission, ExportOptions(altitudes={name: 3}))


def test_one_height_for_all_is_a_meeting_and_layers_are_none(crossing):
    given = crossing()
    (warning,) = exported(*given, "geojson", ExportOptions(altitude=30)).messages
    assert warning == "warning: d1 and d2: 0.00 m apart at 50.0 s of the schedule; expected at least 1.00 m"
    assert exported(*given, "geojson", ExportOptions(altitude=30, altitude_step=20)).messages == ()
    assert exported(*given, "geojson", ExportOptions()).messages == ()


def test_layers_that_lie_too_close_are_named(crossing):
    files = exported(*crossing(), "kml", ExportOptions(altitudes={"d1": 30, "d2": 30.5}))
    assert files.messages[0] == (
        "warning: d1 and d2 do not fly in layers of their own: from 30 to 30 m, and from 30.5 to 30.5 m"
    )
    assert " apart at " in files.messages[1]
    files = exported(*crossing(), "kml", ExportOptions(altitudes={"d1": 30, "d2": 38}, clearance=9))
    assert "do not fly in layers of their own" in files.messages[0]


def test_plan_files_fly_in_layers(crossing):
    files = exported(*crossing(), "qgc", ExportOptions(altitude=30, altitude_step=20))
    for name, height in (("d1.plan", 30), ("d2.plan", 50)):
        items = json.loads(files.texts[name])["mission"]["items"]
        flown = [item["Altitude"] for item in items if item["command"] in (16, 22)]
        assert flown == pytest.approx([height] * len(flown), abs=0.01)
    with pytest.raises(ParameterError, match="--altitude missing; expected metres above the start for d1"):
        exported(*crossing(), "qgc", ExportOptions(altitudes={"d2": 30}))


def test_maps_have_the_heights_of_drones_alone(crossing):
    given, options = crossing(), ExportOptions(altitude_step=20)
    routes = {
        f["properties"]["name"]: f
        for f in json.loads(exported(*given, "geojson", options).texts["plan.geojson"])["features"]
        if f["properties"]["kind"] == "route"
    }
    assert [point[2] for point in routes["d2"]["geometry"]["coordinates"]] == pytest.approx([0, 40], abs=0.01)
    assert routes["d2"]["properties"]["altitude_m"] == 40
    assert {len(point) for point in routes["rover"]["geometry"]["coordinates"]} == {2}
    root = Tree.fromstring(exported(*given, "kml", options).texts["plan.kml"])
    lines = [line.find(f"{KML}coordinates").text.split() for line in root.iter(f"{KML}LineString")]
    assert [line[-1].rpartition(",")[2] for line in lines] == ["20", "0", "40"]


def test_tasks_that_lie_lower_are_named_in_space(crossing):
    text = CROSSING
    for place in ("[0, 0]", "[0, 90]", "[50, -50]", "[100, 0]", "[50, 50]", "[0, 95]"):
        text = text.replace(f"position: {place}", f"position: {place[:-1]}, 0]")
    files = exported(*crossing(text), "geojson", ExportOptions(altitude_step=20))
    assert files.messages == (
        "d1: does east at its height of flight, not lower as the mission says",
        "d2: does north at its height of flight, not lower as the mission says",
    )


@given(st.dictionaries(st.text(min_size=1).filter(lambda s: "=" not in s and not s.endswith(",")), st.floats(0, 1e5)))
def test_altitudes_are_read_from_texts(altitudes):
    assert altitudes_in([f"{name}={metres!r}" for name, metres in altitudes.items()]) == altitudes


@pytest.mark.parametrize("text", ["", "r", "r=1,s", "r=x", "r="])
def test_texts_that_are_no_altitudes(text):
    with pytest.raises(ParameterError, match=r"altitudes: .*; expected "):
        altitudes_in([text])


def test_one_height_for_each_robot():
    for texts in (["r_0=30,r_0=40"], ["r_0=30", "r_0=30"]):
        with pytest.raises(ParameterError, match="altitudes: r_0 twice; expected one height for each robot"):
            altitudes_in(texts)


@pytest.mark.parametrize(
    ("options", "line"),
    [
        ({"altitude": -1.0}, "altitude: -1.0; expected metres, from 0 to 100000"),
        ({"altitude_step": True}, "altitude_step: true; expected metres"),
        ({"altitudes": [3]}, r"altitudes: \[3\]; expected metres by robot"),
        ({"altitudes": {"r": float("nan")}}, "altitudes: r: .*; expected metres"),
        ({"firmware": "own"}, 'firmware: "own"; expected px4 or ardupilot'),
        ({"per_robot": 1}, "per_robot: 1; expected true or false"),
    ],
)
def test_options_are_checked(options, line):
    with pytest.raises(ParameterError, match=line):
        ExportOptions(**options)


PLANE = """\
schema: muster/1
name: plane
origin_wgs84: {lat_deg: 48.1, lon_deg: 11.5}
robots: [{id: b, position: [0, -20], kind: air, camera: {fov_deg: 60, tilt_deg: 90}}]
tasks:
  - {id: f, action: {name: coverage, area: [[-30, 0], [30, 0], [30, 60], [-30, 60]], height_m: 20}}
  - {id: gate, position: [3, 3]}
"""


@pytest.mark.parametrize(("altitude", "survey_m"), [(5, 20), (30, 30)])
def test_in_the_plane_work_is_done_at_its_own_height(crossing, altitude, survey_m):
    mission, _ = crossing(PLANE)
    verdict = verify(mission, plan_of({"b": ["f", "gate"]}))
    found = exported(mission, verdict, "qgc", ExportOptions(altitude=altitude))
    items = json.loads(found.texts["b.plan"])["mission"]["items"]
    (survey,) = [item["TransectStyleComplexItem"] for item in items if item["type"] == "ComplexItem"]
    assert survey["CameraCalc"]["DistanceToSurface"] == pytest.approx(survey_m, abs=0.01)
    (gate,) = [item for item in items if item.get("command") == 16]
    assert gate["params"][6] == pytest.approx(altitude, abs=0.01)
    raised = "b: does f at its height of flight, not lower as the mission says"
    assert (raised in found.messages) == (survey_m > 20)
