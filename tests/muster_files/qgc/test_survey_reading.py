"""Surveys of plan files, our own and QGroundControl's, as areas to cover."""

import copy
import json

import numpy as np
import pytest

from muster import export, load, solve, verify
from muster.mission.errors import MissionError
from muster.motion.actions.area_coverage import swath_of

FIELD = """schema: muster/1
origin_wgs84: {lat_deg: 47.4, lon_deg: 8.5, alt_m: 400}
robots: [{id: d, position: [0, 0, 0], kind: air, speed_mps: 4}]
tasks:
  - id: field
    action: {name: coverage, area: [[0, 5], [90, 5], [120, 65], [0, 65]], width_m: 12, height_m: 20, heading_deg: 30}
  - {id: post, position: [-20, 5, 10], duration_s: 4}
"""
SURVEY = {
    "TransectStyleComplexItem": {
        "CameraCalc": {
            "AdjustedFootprintFrontal": 25.0,
            "AdjustedFootprintSide": 22.5,
            "CameraName": "Sony ILCE-QX1",
            "DistanceMode": 1,
            "DistanceToSurface": 50,
            "FocalLength": 16,
            "FrontalOverlap": 70,
            "ImageHeight": 3632,
            "ImageWidth": 5456,
            "Landscape": True,
            "SensorHeight": 15.4,
            "SensorWidth": 23.2,
            "SideOverlap": 60,
            "version": 2,
        },
        "Items": [],
        "Refly90Degrees": False,
        "TurnAroundDistance": 10,
        "VisualTransectPoints": [[47.4001, 8.5001], [47.4009, 8.5009]],
        "version": 2,
    },
    "angle": 30,
    "complexItemType": "survey",
    "polygon": [[47.4, 8.5], [47.4, 8.501], [47.401, 8.501], [47.401, 8.5]],
    "type": "ComplexItem",
    "version": 5,
}


def plan_file(folder, survey, landing=None):
    """A flight over one survey; it lands at a place, else returns."""
    end = [0] * 7 if landing is None else [0, 0, 0, None, *landing, 0]
    command = 20 if landing is None else 21
    last = {"type": "SimpleItem", "command": command, "frame": 3, "params": end}
    mission = {
        "hoverSpeed": 5,
        "items": [survey, last],
        "plannedHomePosition": [47.4, 8.5, 400],
        "vehicleType": 2,
        "version": 2,
    }
    path = folder / "flight.plan"
    path.write_text(json.dumps({"fileType": "Plan", "mission": mission, "version": 1}), encoding="utf-8")
    return path


def test_an_area_that_was_exported_is_read_back(tmp_path):
    (tmp_path / "field.yaml").write_text(FIELD, encoding="utf-8")
    mission = load(tmp_path / "field.yaml")
    (tmp_path / "plans").mkdir()
    for name, text in export(mission, solve(mission, iterations=100, seed=1), "qgc").texts.items():
        (tmp_path / "plans" / name).write_text(text, encoding="utf-8")
    again = load(tmp_path / "plans")
    (before,) = [task.action for task in mission.tasks if task.action]
    (after,) = [task.action for task in again.tasks if task.action]
    start = next(k for k, corner in enumerate(after.area) if np.hypot(*corner) < 5.1)  # a ring begins anywhere
    ring = [after.area[(start - k) % len(after.area)] for k in range(len(after.area))]  # and was turned to clockwise
    assert np.abs(np.array(ring) - before.area).max() < 0.01
    assert (after.width_m, after.height_m) == pytest.approx((12, 20), abs=0.01)
    assert after.heading_deg == pytest.approx(30)
    (post,) = [task for task in again.tasks if not task.action]
    assert post.position == pytest.approx((-20, 5, 10), abs=0.01)
    plan = solve(again, iterations=100, seed=1)
    assert verify(again, plan).valid
    assert not plan.unassigned


def test_a_survey_with_a_camera_has_the_lanes_of_its_overlap(tmp_path):
    mission = load(plan_file(tmp_path, SURVEY))
    (task,) = mission.tasks
    action = task.action
    assert (task.id, action.height_m, action.overlap, action.front_overlap) == ("flight-1", 50, 0.6, 0.7)
    assert action.heading_deg == 60
    seen_m = 50 * 23.2 / 16
    assert swath_of(action, mission.robots[0]).width_m == pytest.approx(0.4 * seen_m)
    camera = mission.robots[0].camera
    assert camera.height_px / camera.width_px == pytest.approx(3632 / 5456, rel=1e-3)
    assert action.area[2] == pytest.approx((75.5, 111.2), abs=0.1)
    assert mission.robots[0].return_to_start


def test_a_portrait_camera_sees_the_height_of_its_sensor_across(tmp_path):
    survey = copy.deepcopy(SURVEY)
    survey["TransectStyleComplexItem"]["CameraCalc"]["Landscape"] = False
    mission = load(plan_file(tmp_path, survey))
    assert swath_of(mission.tasks[0].action, mission.robots[0]).width_m == pytest.approx(0.4 * 50 * 15.4 / 16)


def test_a_flight_that_lands_where_its_survey_ends_may_end_anywhere(tmp_path):
    assert load(plan_file(tmp_path, SURVEY, [47.4009, 8.5009])).robots[0].end_position is None
    assert load(plan_file(tmp_path, SURVEY, [47.4, 8.5009])).robots[0].end_position is not None


INNER = "TransectStyleComplexItem"


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda s: s.pop(INNER), f"{INNER}: missing; expected a mapping"),
        (lambda s: s.update(angle="north"), 'angle: "north"; expected degrees clockwise from north'),
        (lambda s: s.update(polygon=3), "polygon: 3; expected a list of corners"),
        (lambda s: s["polygon"].__delitem__(slice(2)), "expected at least 3 corners"),
        (lambda s: s["polygon"].__setitem__(1, [200, 8]), "polygon[1]: [200, 8, 0.0]; expected a latitude"),
        (lambda s: s[INNER].update(Refly90Degrees=True), f"{INNER}.Refly90Degrees: true; expected false, and a second"),
        (lambda s: s[INNER].update(FollowTerrain=True), f"{INNER}.FollowTerrain: true; expected false, and heights"),
        (lambda s: s[INNER].pop("VisualTransectPoints"), f"{INNER}.VisualTransectPoints: missing"),
        (lambda s: s[INNER]["CameraCalc"].update(DistanceMode=3), "CameraCalc.DistanceMode: 3; expected 1: heights"),
        (lambda s: s[INNER]["CameraCalc"].update(DistanceToSurface=0), "DistanceToSurface: 0; expected metres above 0"),
        (lambda s: s[INNER]["CameraCalc"].pop("AdjustedFootprintSide"), "AdjustedFootprintSide: missing"),
        (lambda s: s[INNER]["CameraCalc"].pop("FocalLength"), "CameraCalc.FocalLength: missing; expected a number"),
        (lambda s: s[INNER]["CameraCalc"].update(SideOverlap=100), "CameraCalc.SideOverlap: 100; expected percent"),
        (
            lambda s: s.update(complexItemType="CorridorScan"),
            '.type: "CorridorScan"; expected "SimpleItem", or a survey',
        ),
    ],
)
def test_a_survey_that_is_wrong_is_refused_in_a_line(change, said, tmp_path):
    survey = copy.deepcopy(SURVEY)
    change(survey)
    with pytest.raises(MissionError) as error:
        load(plan_file(tmp_path, survey))
    assert "flight.plan: mission.items[0]" in str(error.value)
    assert said in str(error.value)
    assert "\n" not in str(error.value)
