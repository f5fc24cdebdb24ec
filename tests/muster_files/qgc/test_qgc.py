"""QGroundControl plan files: the documented format, latitude first, and the way back to a mission."""

import json

import jsonschema
import numpy as np
import pytest
from tests.muster_files.bay import ALT, BAY, LAT, LON, bay
from tests.muster_files.documented import PLAN

from muster import load
from muster.mission.errors import MissionError
from muster.mission.geodesy import wgs84_to_enu
from muster_files.earth import Earth
from muster_files.qgc.writer import PlanFiles

ORIGIN = (LAT, LON, ALT)
WRITTEN_M = 2e-4
"""Places are written to a tenth of a millimetre."""


@pytest.fixture
def files(tmp_path):
    return files_of(*bay(tmp_path))


def files_of(mission, verdict, team, firmware="px4"):
    plans = PlanFiles(mission, Earth.of(mission, "a test"), team, firmware)
    return {i.robot.id: plans.plan(i) for i in team if len(i.passages) > 1}


def items(plan):
    return plan["mission"]["items"]


def way_points(plan):
    return [item["params"] for item in items(plan) if item["command"] == 16]


def metres(place):
    """[lat, lon, height above a home at the origin's level] in the map frame."""
    return wgs84_to_enu([(*place[:2], ALT + (place[2] if len(place) > 2 else 0.0))], ORIGIN)[0]


@pytest.mark.parametrize("firmware", ["px4", "ardupilot"])
def test_files_are_as_documented(firmware, tmp_path):
    for plan in files_of(*bay(tmp_path), firmware).values():
        jsonschema.validate(json.loads(json.dumps(plan, allow_nan=False)), PLAN)
        assert [item["doJumpId"] for item in items(plan)] == list(range(1, len(items(plan)) + 1))


@pytest.mark.parametrize(
    ("robot", "commands"),
    [
        ("d1", [22, 178, *[16] * 9, 20]),
        ("d2", [22, 178, 16, 21]),
        ("d3", [22, 178, 16, 21]),
        ("rover", [178, 16]),
    ],
)
def test_commands_of_each_robot(robot, commands, files):
    assert [item["command"] for item in items(files[robot])] == commands


def test_latitude_comes_first(files):
    for plan in files.values():
        home = plan["mission"]["plannedHomePosition"]
        placed = [item["params"][4:6] for item in items(plan) if item["command"] in (16, 21, 22)]
        corners = [corner for fence in plan["geoFence"]["polygons"] for corner in fence["polygon"]]
        for lat, lon, *_ in (home, *placed, *corners, *plan["rallyPoints"]["points"]):
            assert lat == pytest.approx(LAT, abs=0.01)
            assert lon == pytest.approx(LON, abs=0.01)


def test_way_points_are_where_the_tasks_are(files):
    (point,) = way_points(files["d2"])
    assert metres(point[4:]) == pytest.approx((100, 40, 20), abs=WRITTEN_M)
    assert point[:4] == [10, 0, 0, None]
    north_east = metres(way_points(files["d1"])[1][4:])
    assert north_east == pytest.approx((50, 80, 25), abs=WRITTEN_M)  # end of the southern lane, 10 m above the task


def test_a_rover_waits_for_a_drone(files):
    arrives = np.hypot(10, 25)
    ends = np.linalg.norm([97, 40, 20]) / 4 + 10
    ((hold, *_),) = way_points(files["rover"])
    assert hold == pytest.approx(ends - arrives, abs=1e-3)


def test_takeoff_is_at_the_start_to_the_height_of_the_first_way_point(files):
    takeoff = items(files["d1"])[0]
    assert metres(takeoff["params"][4:]) == pytest.approx((0, 0, 25), abs=0.01)
    assert takeoff["Altitude"] == takeoff["params"][6]


def test_speeds_are_those_of_the_robot(files):
    assert items(files["d2"])[1]["params"] == [1, 4, -1, 0, 0, 0, 0]
    assert files["d2"]["mission"]["cruiseSpeed"] == files["d2"]["mission"]["hoverSpeed"] == 4


def test_a_heading_is_a_compass_heading(tmp_path):
    scene = bay(tmp_path)
    observed = items(files_of(*scene)["d1"])[-2]
    assert observed["params"][3] == 60  # 30 degrees from east, anticlockwise
    *_, yaw, point, _ = items(files_of(*scene, "ardupilot")["d1"])
    assert (point["params"][3], yaw["command"], yaw["params"][0]) == (None, 115, 60)


def test_landing_is_where_the_route_ends(files):
    assert metres(items(files["d2"])[-1]["params"][4:]) == pytest.approx((10, -30, 2), abs=WRITTEN_M)
    assert metres(items(files["d3"])[-1]["params"][4:6])[:2] == pytest.approx((-40, 60), abs=0.01)


def test_the_fence_is_that_of_the_robot_and_clockwise(files):
    corners = {
        name: [(p["inclusion"], len(p["polygon"])) for p in f["geoFence"]["polygons"]] for name, f in files.items()
    }
    assert corners["d1"] == [(True, 4), (False, 4), (False, 4)]
    assert corners["d2"] == [(True, 4), (False, 4)]  # it flies over the zone with a ceiling
    assert corners["rover"] == [(True, 4), (False, 4), (False, 4), (False, 3)]
    for plan in files.values():
        for fence in plan["geoFence"]["polygons"]:
            lat, lon = np.array(fence["polygon"]).T
            assert np.sum(lon * np.roll(lat, -1) - np.roll(lon, -1) * lat) < 0


def test_drones_rally_where_drones_start(files):
    points = files["d2"]["rallyPoints"]["points"]
    assert [metres(point)[0] for point in points] == pytest.approx([0, 3, 6], abs=WRITTEN_M)
    assert {point[2] for point in points} == {items(files["d2"])[0]["Altitude"]}
    assert files["rover"]["rallyPoints"]["points"] == []


def test_least_heights_are_above_the_start_and_end_on_the_ground(tmp_path):
    mission, verdict, team = bay(tmp_path, BAY.replace("[3, 0, 0]", "[3, 0, 1]"))
    raised = files_of(mission, verdict, [i.at_least(30) for i in team])["d2"]
    assert raised["mission"]["plannedHomePosition"][2] == pytest.approx(ALT + 1, abs=1e-3)
    assert [item["params"][6] for item in items(raised) if item["command"] in (16, 22)] == pytest.approx(
        [30, 30], abs=0.01
    )
    assert items(raised)[-1]["params"][6] == pytest.approx(1, abs=0.01)


def test_ends_come_back(files, tmp_path):
    for name, plan in files.items():
        (tmp_path / f"{name}.plan").write_text(json.dumps(plan), encoding="utf-8")
    d1, d2, d3, rover = load(tmp_path).robots
    assert d1.return_to_start
    assert d2.end_position == pytest.approx((10, -30, 2), abs=0.01)
    assert (d3.end_position, d3.return_to_start, rover.end_position) == (None, None, None)


def test_one_file_is_a_mission_about_its_home(files, tmp_path):
    (tmp_path / "d2.plan").write_text(json.dumps(files["d2"]), encoding="utf-8")
    mission = load(tmp_path / "d2.plan")
    assert mission.name == "d2"
    assert mission.robots[0].position == (0, 0, 0)
    assert [task.id for task in mission.tasks] == ["d2-3"]
    assert mission.tasks[0].position == pytest.approx((97, 40, 20), abs=0.01)


def test_rovers_alone_are_a_mission_in_the_plane(files, tmp_path):
    (tmp_path / "rover.plan").write_text(json.dumps(files["rover"]), encoding="utf-8")
    assert load(tmp_path / "rover.plan").dimensions == 2


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda p: p.update(fileType="Mission"), 'fileType: "Mission"; expected "Plan"'),
        (lambda p: p.pop("mission"), "mission: missing; expected a mapping"),
        (lambda p: p["mission"].update(version=1), "mission.version: 1; expected 2"),
        (lambda p: p["mission"].update(plannedHomePosition=[LON, LAT, 0]), "expected a latitude from -90 to 90"),
        (lambda p: p["mission"].pop("plannedHomePosition"), "mission.plannedHomePosition: missing"),
        (lambda p: items(p)[2].update(type="ComplexItem", complexItemType="fw"), 'mission.items[2].type: "fw"'),
        (
            lambda p: items(p)[2].update(command=17),
            "mission.items[2].command: MAV_CMD_NAV_LOITER_UNLIM (17); expected one of NAV_WAYPOINT, NAV_LOITER_TIME",
        ),
        (lambda p: items(p)[2].update(frame=10), "mission.items[2].frame: 10; expected one of 0, 3, 5, 6"),
        (lambda p: items(p)[2].update(params=[0] * 6), "mission.items[2].params"),
        (lambda p: items(p)[2]["params"].__setitem__(4, None), "mission.items[2].params[4:]"),
        (lambda p: items(p)[2]["params"].__setitem__(0, -3), "mission.items[2].params[0]: -3; expected seconds"),
        (lambda p: (items(p).pop(1), p["mission"].pop("hoverSpeed")), "mission.hoverSpeed: missing"),
        (lambda p: p["mission"].update(items=3), "mission.items: 3; expected a list of items"),
    ],
)
def test_a_file_that_is_wrong_is_refused_in_a_line(change, said, files, tmp_path):
    plan = files["d2"]
    change(plan)
    file = tmp_path / "x.plan"
    file.write_text(json.dumps(plan), encoding="utf-8")
    with pytest.raises(MissionError) as error:
        load(file)
    assert str(error.value).startswith(f"{file}: ")
    assert said in str(error.value)
    assert "\n" not in str(error.value)


@pytest.mark.parametrize("text", ["", "{", "[]", "3", '{"fileType": "Plan"', "[" * 100_000])
def test_no_plan_file_at_all(text, tmp_path):
    (tmp_path / "x.plan").write_text(text, encoding="utf-8")
    with pytest.raises(MissionError):
        load(tmp_path / "x.plan")


def fence(polygons, **others):
    return lambda plan: plan.update(geoFence={"polygons": polygons, "version": 2, **others})


SQUARE = {"inclusion": True, "polygon": [[LAT, LON], [LAT + 0.1, LON], [LAT, LON + 0.1]]}


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda p: p.update(geoFence=3), "geoFence: 3; expected a mapping with polygons"),
        (fence([], circles=[{"inclusion": True}]), "geoFence.circles[0].circle: missing; expected a mapping"),
        (fence([SQUARE, SQUARE]), "geoFence.polygons: not the mission's boundary; expected one polygon"),
        (fence([{**SQUARE, "inclusion": 1}]), "geoFence.polygons[0].inclusion: 1; expected true or false"),
        (fence([{"inclusion": True}]), "geoFence.polygons[0].polygon: missing; expected a list of corners"),
        (fence([{**SQUARE, "polygon": [[LON, LAT]] * 3}]), "geoFence.polygons[0].polygon[0]: "),
    ],
)
def test_a_fence_that_is_no_map_is_refused_in_a_line(change, said, files, tmp_path):
    change(files["d2"])
    file = tmp_path / "x.plan"
    file.write_text(json.dumps(files["d2"]), encoding="utf-8")
    with pytest.raises(MissionError) as error:
        load(file)
    assert f"{file}: {said}" in str(error.value)
    assert "\n" not in str(error.value)


def test_fences_are_of_one_mission(files, tmp_path):
    fence([SQUARE])(files["d2"])
    for name in ("d1", "d2"):
        (tmp_path / f"{name}.plan").write_text(json.dumps(files[name]), encoding="utf-8")
    with pytest.raises(MissionError, match="expected one polygon or circle with inclusion, the same in all files"):
        load(tmp_path)


def test_a_file_without_a_fence_is_a_mission_without_a_map(files, tmp_path):
    del files["d2"]["geoFence"]
    (tmp_path / "d2.plan").write_text(json.dumps(files["d2"]), encoding="utf-8")
    assert load(tmp_path / "d2.plan").map is None


def test_a_folder_without_plan_files(tmp_path):
    with pytest.raises(MissionError, match=r"Is a directory; expected a file to read, or a folder of \.plan files"):
        load(tmp_path)
