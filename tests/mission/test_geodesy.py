"""Degrees and metres: there and back within a millimetre, and missions whose places are in degrees."""

import math
import subprocess
import sys

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.formats import FILE

from muster.mission.errors import MissingExtraError, MissionError
from muster.mission.geodesy import enu_to_wgs84, wgs84_to_enu
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text

origins = st.tuples(st.floats(-89, 89), st.floats(-180, 180), st.floats(-400, 5000))
offsets = st.lists(st.tuples(*[st.floats(-7000, 7000)] * 3), min_size=1, max_size=5)

HEAD = "schema: muster/1\norigin_wgs84: {lat_deg: 35.53, lon_deg: 24.06, alt_m: 12}\n"
A, B = "[35.531, 24.061]", "[35.529, 24.062]"


@given(origin=origins, points=offsets)
def test_there_and_back_within_a_millimetre_over_10_km(origin, points):
    back = wgs84_to_enu(enu_to_wgs84(points, origin), origin)
    assert np.linalg.norm(back - points, axis=1).max() < 1e-3


@given(origin=origins)
def test_the_origin_is_zero(origin):
    np.testing.assert_allclose(wgs84_to_enu([origin], origin), [[0, 0, 0]], atol=1e-6)


@given(origin=origins, step=st.floats(-1e-3, 1e-3))
def test_a_small_step_north_follows_the_meridians_radius(origin, step):
    """M = a (1 - e^2) / (1 - e^2 sin^2 lat)^1.5 of the WGS84 ellipsoid, from its defining numbers."""
    lat, lon, alt = origin
    e2 = (2 - 1 / 298.257223563) / 298.257223563
    radius = 6378137.0 * (1 - e2) / (1 - e2 * math.sin(math.radians(lat)) ** 2) ** 1.5 + alt
    east, north, _ = wgs84_to_enu([(lat + step, lon, alt)], origin)[0]
    assert east == pytest.approx(0, abs=1e-6)
    assert north == pytest.approx(radius * math.radians(step), rel=1e-4, abs=1e-6)


def test_places_in_degrees_are_metres_in_the_mission():
    mission = parse_yaml(
        HEAD + f"robots: [{{id: r_0, lat_lon: {A}, end_position: {{lat_lon: {B}}}}}, {{id: r_1, position: [3, 4]}}]\n"
        f"tasks: [{{id: 1, lat_lon: {B}, entry: {{lat_lon: {A}}}, exit: [1, 2],"
        f" action: {{name: delivery, pickup: {{lat_lon: {A}}}}}}}]\n"
        f"events:\n  - {{at_s: 1, robot_joins: {{id: r_2, lat_lon: {A}}}}}\n"
        f"  - {{at_s: 1, new_task: {{id: 2, lat_lon: {A}}}}}\n  - {{at_s: 2, move_task: {{task: 1, lat_lon: {A}}}}}\n",
        FILE,
    )
    (a, b) = wgs84_to_enu([(35.531, 24.061, 12), (35.529, 24.062, 12)], (35.53, 24.06, 12))[:, :2].tolist()
    robot, task, joins, new, moves = mission.robots[0], mission.tasks[0], *mission.events
    assert (robot.position, robot.end_position, mission.robots[1].position) == (tuple(a), tuple(b), (3, 4))
    assert (task.position, task.entry, task.exit, task.action.pickup) == (tuple(b), tuple(a), (1, 2), tuple(a))
    assert joins.robot_joins.position == new.new_task.position == moves.move_task.position == tuple(a)
    assert mission.dimensions == 2
    assert parse_yaml(yaml_text(mission), FILE) == mission


def test_with_an_altitude_a_place_is_in_space():
    mission = parse_yaml(
        HEAD + "robots: [{id: r_0, lat_lon: [35.53, 24.06, 12]}]\ntasks: [{id: 1, lat_lon: [35.53, 24.06, 42]}]\n", FILE
    )
    assert mission.dimensions == 3
    np.testing.assert_allclose(mission.robots[0].position, [0, 0, 0], atol=1e-6)
    np.testing.assert_allclose(mission.tasks[0].position, [0, 0, 30], atol=1e-6)


def test_a_place_by_an_alias_is_a_place_each_time():
    mission = parse_yaml(
        HEAD + f"robots: [{{id: r_0, end_position: &p {{lat_lon: {A}}}, position: [0, 0]}}]\n"
        "tasks: [{id: 1, position: [0, 0], entry: *p, exit: *p}]\n",
        FILE,
    )
    assert mission.robots[0].end_position == mission.tasks[0].entry == mission.tasks[0].exit
    assert len(mission.tasks[0].exit) == 2


def test_without_pymap3d_the_extra_is_named(monkeypatch):
    monkeypatch.setitem(sys.modules, "pymap3d", None)
    with pytest.raises(MissingExtraError, match=r"a place in degrees \(lat_lon\) needs .*\[map\]"):
        parse_yaml(HEAD + f"robots: [{{id: r_0, lat_lon: {A}}}]\ntasks: []\n", FILE)


def test_missions_in_metres_do_not_load_pymap3d():
    script = "import sys, muster; muster.load('6T-2R'); sys.exit('pymap3d' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", script], check=False).returncode == 0


def test_areas_and_nodes_in_degrees_are_metres_in_the_mission():
    mission = parse_yaml(
        HEAD + "map:\n  boundary: {lat_lon: [[35.52, 24.05], [35.52, 24.07], [35.54, 24.07]]}\n"
        "  zones: [{polygon: {lat_lon: [[35.53, 24.06], [35.53, 24.061], [35.531, 24.061]]}}]\n"
        "lanes: {nodes: {a: {lat_lon: [35.53, 24.06]}, b: [9, 9]}, edges: [{from: a, to: b}]}\n"
        "robots: [{id: r_0, position: [0, 0]}]\ntasks: []\n",
        FILE,
    )
    corners = [(35.53, 24.06, 12), (35.53, 24.061, 12), (35.531, 24.061, 12)]
    np.testing.assert_allclose(mission.map.zones[0].polygon, wgs84_to_enu(corners, (35.53, 24.06, 12))[:, :2])
    assert (len(mission.map.boundary), mission.lanes.nodes["a"]) == (3, (0, 0))
    assert parse_yaml(yaml_text(mission), FILE) == mission


@pytest.mark.parametrize(
    ("area", "message"),
    [
        ("[[35.5, 24.0], [97, 24.0], [35.6, 24.1]]", r"boundary.lat_lon\[1\]\[0\]: 97; expected a finite number"),
        ("[[35.5, 24.0], [35.5, 24.0, 3], [35.6, 24.1]]", r"lat_lon\[1\]: .*; expected \[lat, lon\] in degrees$"),
        (
            "[[35.5, 24.0]]",
            r"map.boundary: .*lat_lon.*; expected a list of at least 3, .*, or \{lat_lon: .*\}$",
        ),
        ("3", r"map.boundary: .*lat_lon.*; expected a list of at least 3"),
    ],
)
def test_a_wrong_area_in_degrees_is_named_once(area, message):
    with pytest.raises(MissionError, match=message) as caught:
        parse_yaml(
            HEAD + f"map: {{boundary: {{lat_lon: {area}}}}}\nrobots: [{{id: r, position: [0, 0]}}]\ntasks: []\n", FILE
        )
    assert len(caught.value.findings) == 1
