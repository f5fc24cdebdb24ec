"""Areas as survey items of QGroundControl: the keys that it reads, its way points those of the plan."""

import json
from dataclasses import replace

import numpy as np
import pytest
import shapely

import muster
from muster.mission.geodesy import wgs84_to_enu
from muster.motion.actions import plan as motion_of
from muster.planning.export_formats import ExportOptions
from muster_files.files import plan_files

ORIGIN = (47.4, 8.5, 400.0)
REQUIRED = {
    "version",
    "TurnAroundDistance",
    "CameraTriggerInTurnAround",
    "HoverAndCapture",
    "Refly90Degrees",
    "CameraCalc",
    "VisualTransectPoints",
    "Items",
    "CameraShots",
}
"""What `TransectStyleComplexItem::_load` of QGroundControl asks for."""
TEXT = """schema: muster/1
origin_wgs84: {lat_deg: 47.4, lon_deg: 8.5, alt_m: 400}
rules: {return_to_start: true}
robots:
  - {id: d0, position: [0, 0, 0], kind: air, speed_mps: 4}
  - {id: d1, position: [5, 0, 0], kind: air, speed_mps: 4}
  - {id: rover, position: [9, 0, 0], skills: [arm, big eye]}
tasks:
  - {id: field, action: {name: coverage, area: [[0, 5], [90, 5], [90, 65], [0, 65]],
     holes: [[[30, 30], [50, 30], [50, 40]]], height_m: 20, fov_deg: 60, front_overlap: 0.5,
     heading_deg: 30, split: 2}, only_robots: [d0, d1]}
  - {id: lawn, only_robots: [rover], action: {name: coverage, width_m: 2,
     area: [[0, -5], [20, -5], [20, -25], [0, -25]]}}
"""
POSTS = """\
  - {id: the post, position: [10, 70, 9], duration_s: 60, priority: 2, prerequisites: [field, lawn],
     requires: [arm, big eye]}
  - {id: last, position: [10, 75, 9], prerequisites: [the post], load: {parcels: 2}}
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("survey") / "field.yaml"
    path.write_text(TEXT, encoding="utf-8")
    mission = muster.load(path)
    plan = muster.solve(mission, iterations=200, seed=1)
    verdict = muster.verify(mission, plan)
    assert verdict.valid
    texts = plan_files(mission, verdict, ExportOptions(firmware="px4"), None).texts
    return mission, plan, {name: json.loads(text)["mission"]["items"] for name, text in texts.items()}


def surveys(items):
    return [item for item in items if item["type"] == "ComplexItem"]


def metres(places):
    return wgs84_to_enu([(place[0], place[1], 400.0) for place in places], ORIGIN)[:, :2]


def test_each_part_is_a_survey_that_qgroundcontrol_can_read(case):
    _, _, files = case
    for name in ("d0.plan", "d1.plan"):
        (survey,) = surveys(files[name])
        assert (survey["complexItemType"], survey["version"]) == ("survey", 5)
        inner = survey["TransectStyleComplexItem"]
        assert set(inner) == REQUIRED
        assert inner["version"] == 2
        assert inner["CameraCalc"]["DistanceToSurface"] == pytest.approx(20, abs=0.01)
        assert inner["CameraCalc"]["AdjustedFootprintSide"] == pytest.approx(0.9 * 40 * np.tan(np.pi / 6))
        assert survey["angle"] == pytest.approx(60)
        numbers = [item["doJumpId"] for item in [*files[name][:2], *inner["Items"], files[name][-1]]]
        assert numbers == list(range(1, len(numbers) + 1))


def test_the_way_points_are_those_of_the_plan(case):
    mission, plan, files = case
    robots = {robot.id: robot for robot in mission.robots}
    tasks = {task.id: task for task in mission.tasks}
    for route in plan.routes[:2]:
        (survey,) = surveys(files[f"{route.robot}.plan"])
        inner = survey["TransectStyleComplexItem"]
        (name,) = route.tasks
        points = np.array(motion_of(tasks[name], robots[route.robot]).points)[:, :2]
        assert metres(inner["VisualTransectPoints"]) == pytest.approx(points, abs=0.01)
        placed = [item["params"][4:6] for item in inner["Items"] if item["command"] == 16]
        assert metres(placed) == pytest.approx(points, abs=0.01)


def test_pictures_are_taken_at_the_distance_of_the_front_overlap(case):
    _, _, files = case
    (survey,) = surveys(files["d0.plan"])
    triggers = [item["params"][:3] for item in survey["TransectStyleComplexItem"]["Items"] if item["command"] == 206]
    front = 0.75 * 40 * np.tan(np.pi / 6)
    assert triggers == [[pytest.approx(0.5 * front), 0, 1], [0.0, 0, 0]]


def test_the_polygons_of_parts_cover_the_area_together(case):
    _, _, files = case
    parts = [shapely.Polygon(metres(survey["polygon"])) for items in files.values() for survey in surveys(items)]
    area = shapely.box(0, 5, 90, 65)
    assert len(parts) == 2
    assert shapely.union_all(parts).intersection(area).area > 0.99 * area.area
    assert all(part.area < 0.7 * area.area for part in parts)


def test_a_rover_has_way_points(case):
    _, _, files = case
    assert not surveys(files["rover.plan"])
    assert sum(item["command"] == 16 for item in files["rover.plan"]) >= 20


def test_areas_and_holes_are_polygons_of_maps_and_areas_to_survey_when_read_again(tmp_path):
    (tmp_path / "mission.yaml").write_text(TEXT + POSTS, encoding="utf-8")
    mission = muster.load(tmp_path / "mission.yaml")
    plan = muster.solve(mission, iterations=200, seed=1)
    muster.export(mission, plan, "geojson", tmp_path / "field.geojson")
    drawn = json.loads((tmp_path / "field.geojson").read_text(encoding="utf-8"))["features"]
    kinds = [one["geometry"]["type"] for one in drawn if one["properties"]["kind"] in ("area", "hole")]
    assert kinds == ["Polygon"] * 3
    muster.export(mission, plan, "kml", tmp_path / "field.kml")
    assert (tmp_path / "field.kml").read_text(encoding="utf-8").count("<Polygon>") == 3
    for file in (tmp_path / "field.geojson", tmp_path / "field.kml"):
        found = muster.read_site(file)
        assert {task.id for task in found.mission.tasks} == {task.id for task in mission.tasks}
        assert found.mission.map is None
        assert found.counts == (f"{file}: 2 areas to survey, 2 tasks, 3 robots",)
        assert "routes of a plan passed over: 3; Muster plans them anew" in found.notes
        assert not any("did you mean" in note for note in found.notes)
        assert [robot.skills for robot in found.mission.robots] == [robot.skills for robot in mission.robots]
        again = {task.id: task for task in found.mission.tasks}
        for task in mission.tasks:
            theirs = again[task.id]
            asked = ("load", "prerequisites", "requires", "duration_s", "priority", "only_robots")
            assert [getattr(theirs, key) for key in asked] == [getattr(task, key) for key in asked]
            if task.action is not None:
                assert_same_action(task.action, theirs.action)
                assert theirs.position[2] == pytest.approx(task.position[2], abs=0.01)


def assert_same_action(action, again):
    """The same, but for where it is and at which corner of the area its border begins."""
    assert replace(again, area=action.area, holes=action.holes) == action
    ours, theirs = (shapely.Polygon(one.area, one.holes) for one in (action, again))
    assert theirs.area == pytest.approx(ours.area, rel=1e-3)
    assert [len(hole) for hole in again.holes] == [len(hole) for hole in action.holes]
