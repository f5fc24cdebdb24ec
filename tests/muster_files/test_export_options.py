"""Options of exports that fit no robot are refused, and each drone's landing is told."""

import pytest

from muster import ParameterError, load, verify
from muster.mission.reading.plan_reader import plan_of
from muster.planning.export_formats import ExportOptions
from muster.planning.exporting import exported

YARD = """\
schema: muster/1
name: yard
origin_wgs84: {{lat_deg: 47, lon_deg: 11}}
rules: {{return_to_start: {returns}}}
robots: [{robots}]
tasks: [{{id: east, position: [30, 40]}}, {{id: north, position: [0, 50]}}]
"""
ROVERS = "{id: r1, position: [0, 0]}, {id: r2, position: [10, 0]}"
DRONE = "{id: d1, position: [0, 0], kind: air}"
BOTH = f"{DRONE}, {{id: d2, position: [10, 0], kind: air}}"
MAP = "map: {boundary: [[-99, -99], [99, -99], [99, 99], [-99, 99]]}\n"


def given(folder, robots, returns="false", more=""):
    (folder / "m.yaml").write_text(YARD.format(robots=robots, returns=returns) + more, encoding="utf-8")
    mission = load(folder / "m.yaml")
    first = mission.robots[0].id
    return mission, verify(mission, plan_of({first: ["north", "east"]}))


@pytest.mark.parametrize("form", ["qgc", "geojson", "kml", "gpx"])
@pytest.mark.parametrize(
    ("robots", "options", "message"),
    [
        (ROVERS, {"altitude": 60}, "altitude: 60; expected it with robots of kind air: the mission has none"),
        (ROVERS, {"altitude_step": 5}, "altitude_step: 5; expected it with robots of kind air: the mission has none"),
        (ROVERS, {"altitudes": {"r1": 5}}, "altitudes: r1; expected robots of kind air: none"),
        (DRONE, {"altitude": 60, "altitude_step": 5}, "altitude_step: 5; expected it, beside altitude, with several"),
        (DRONE, {"altitude": 60, "clearance": 5}, r"clearance: 5; expected it with several robots: .* d1 alone"),
    ],
)
def test_what_fits_no_robot_is_refused(tmp_path, form, robots, options, message):
    with pytest.raises(ParameterError, match=message):
        exported(*given(tmp_path, robots), form, ExportOptions(**options))


def test_a_tolerance_is_for_corners_of_maps(tmp_path):
    with pytest.raises(ParameterError, match=r"tolerance: 0\.5; expected it with travel over a map"):
        exported(*given(tmp_path, ROVERS), "qgc", ExportOptions(tolerance=0.5))
    assert exported(*given(tmp_path, ROVERS, more=MAP), "qgc", ExportOptions(tolerance=0.5)).texts


@pytest.mark.parametrize("form", ["qgc", "geojson"])
@pytest.mark.parametrize(
    ("robots", "options"),
    [
        (BOTH, {"altitude": 60, "altitude_step": 5, "clearance": 1}),
        (DRONE, {"altitude_step": 5}),
        (f"{DRONE}, {{id: r1, position: [9, 9]}}", {"altitude": 60, "clearance": 1}),
    ],
)
def test_what_fits_a_robot_is_taken(tmp_path, form, robots, options):
    assert exported(*given(tmp_path, robots), form, ExportOptions(**options)).texts


@pytest.mark.parametrize(
    ("robots", "returns", "landing"),
    [
        (DRONE, "true", "d1: lands at its start"),
        (DRONE, "false", "d1: lands where its route ends, at task east, 50 m from its start; return_to_start: true"),
        (DRONE.replace("kind", "end_position: [0, 9], kind"), "true", "d1: lands at its end_position, 9 m from its"),
        (ROVERS, "true", None),
    ],
)
def test_where_each_drone_lands_is_told(tmp_path, robots, returns, landing):
    air = "kind: air" in robots
    messages = exported(*given(tmp_path, robots, returns), "qgc", ExportOptions(altitude=60 if air else None)).messages
    told = [message for message in messages if "lands" in message]
    assert [message[: len(landing)] for message in told] == [landing] if landing else told == []
