"""What the map and the form change in a mission's text."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.reading.circles import enclosing
from muster_control.work.editing import changes
from muster_control.work.editing.edits import EditError, data_of

TEXT = """\
schema: muster/1
name: yard   # ours
map:
  boundary: [[0, 0], [9, 0], [9, 9]]
  zones:
    - {polygon: [[1, 1], [2, 1], [2, 2]]}
robots:
  - {id: r_0, position: [0, 0, 2.5], speed_mps: 2}   # the quick one
  - {id: far, lat_lon: [35.5, 24.1]}
tasks:
  - {id: 7, type: D, position: [5, 5, 0], only_robots: [r_0]}
  - {id: 8, position: [6, 6, 0], prerequisites: [7, 9]}
  - {id: 9, position: [7, 7, 0], prerequisites: [7]}
"""
PLACES = st.floats(-1e4, 1e4).map(lambda x: round(x, 3))


@given(x=PLACES, y=PLACES)
def test_what_is_dragged_is_there_and_keeps_its_height(x: float, y: float) -> None:
    data = data_of(changes.move(TEXT, {"what": "robot", "id": "r_0"}, x, y))
    assert data["robots"][0]["position"] == [x, y, 2.5]
    data = data_of(changes.move(TEXT, {"what": "task", "id": "8"}, x, y))
    assert data["tasks"][1]["position"] == [x, y, 0]
    data = data_of(changes.move(TEXT, {"what": "zone", "id": 0, "corner": 2}, x, y))
    assert data["map"]["zones"][0]["polygon"] == [[1, 1], [2, 1], [x, y]]


def test_a_place_in_degrees_is_not_moved_in_metres() -> None:
    with pytest.raises(EditError, match="degrees"):
        changes.move(TEXT, {"what": "robot", "id": "far"}, 1, 2)


def test_what_is_added_is_like_the_last_with_a_name_of_its_own() -> None:
    data = data_of(changes.add(TEXT, "task", 1.5, 2))
    assert data["tasks"][-1] == {"id": 10, "position": [1.5, 2, 0]}
    data = data_of(changes.add(TEXT.replace("  - {id: far, lat_lon: [35.5, 24.1]}\n", ""), "robot", 3, 4))
    assert data["robots"][-1] == {"id": "r_1", "position": [3, 4, 2.5], "speed_mps": 2}


def test_a_task_that_goes_is_no_prerequisite_any_more() -> None:
    tasks = data_of(changes.drop(TEXT, "task", "7"))["tasks"]
    assert tasks == [{"id": 8, "position": [6, 6, 0], "prerequisites": [9]}, {"id": 9, "position": [7, 7, 0]}]
    assert "only_robots" not in data_of(changes.drop(TEXT, "robot", "r_0"))["tasks"][0]
    with pytest.raises(EditError, match="no such one"):
        changes.drop(TEXT, "task", "77")


def test_relations_and_lags_let_go_of_a_task_that_goes() -> None:
    text = (
        TEXT
        + """\
  - {id: a, position: [7, 7, 0], prerequisites: [8, {task: 7, after_s: 5}], same_robot_as: 7}
  - {id: b, position: [7, 7, 0], other_robot_than: [7, 8], starts_with: [7]}
"""
    )
    *_, a, b = data_of(changes.drop(text, "task", "7"))["tasks"]
    assert a == {"id": "a", "position": [7, 7, 0], "prerequisites": [8]}
    assert b == {"id": "b", "position": [7, 7, 0], "other_robot_than": [8]}


def test_a_corner_that_is_another_by_now_stays() -> None:
    corner = {"what": "zone", "id": 0, "corner": 1}
    data = data_of(changes.move(TEXT, {**corner, "from": [2.0, 1.0]}, 3, 4))
    assert data["map"]["zones"][0]["polygon"][1] == [3, 4]
    with pytest.raises(EditError, match="the corner of zone 1 is elsewhere by now"):
        changes.move(TEXT, {**corner, "from": [2.5, 1.0]}, 3, 4)


def test_a_zone_that_is_another_by_now_stays() -> None:
    assert data_of(changes.drop(TEXT, "zone", 0, [[1.0, 1], [2, 1], [2, 2]]))["map"]["zones"] == []
    with pytest.raises(EditError, match="another one by now"):
        changes.drop(TEXT, "zone", 0, [[3, 1], [2, 1], [2, 2]])
    with pytest.raises(EditError, match="nothing stands there"):
        changes.drop(TEXT, "zone", 1, [[1, 1], [2, 1], [2, 2]])


def test_cells_set_and_clear_keys() -> None:
    text = changes.set_cell(TEXT, ("robots", 0, "speed_mps"), 0.5)
    assert data_of(text)["robots"][0]["speed_mps"] == 0.5
    assert "speed_mps" not in data_of(changes.set_cell(text, ("robots", 0, "speed_mps"), None))["robots"][0]
    assert changes.set_cell(TEXT, ("robots", 0, "skills"), None) == TEXT
    assert data_of(changes.set_cell(TEXT, ("rules", "objective"), "max"))["rules"] == {"objective": "max"}
    assert data_of(changes.set_coordinate(TEXT, ("tasks", 0), 1, -3))["tasks"][0]["position"] == [5, -3, 0]
    assert "name: yard   # ours" in text


def test_cells_are_those_of_an_id_wherever_its_row_is_now() -> None:
    text = changes.drop(TEXT, "task", "7")
    tasks = data_of(changes.set_cell(text, ("tasks", 1, "priority"), 3, "8"))["tasks"]
    assert [(task["id"], task.get("priority")) for task in tasks] == [(8, 3), (9, None)]
    tasks = data_of(changes.set_coordinate(text, ("tasks", 2), 0, 1, "9"))["tasks"]
    assert [task["position"][0] for task in tasks] == [6, 1]
    for name in ("7", ""):
        with pytest.raises(EditError, match="no such one"):
            changes.set_cell(text, ("tasks", 0, "priority"), 3, name)
    with pytest.raises(EditError, match="more than one"):
        changes.set_cell(text.replace("id: 9", "id: 8"), ("tasks", 0, "priority"), 3, "8")
    nameless = text.replace("id: 9, ", "")
    assert data_of(changes.set_cell(nameless, ("tasks", 1, "priority"), 3, ""))["tasks"][1]["priority"] == 3


def test_a_mission_in_the_plane_is_made_3d_and_keeps_its_comments() -> None:
    flat = "robots:\n  - {id: a, position: [1, 2]}  # first\ntasks:\n  - id: 1\n    position:\n      - 3\n      - 4\n"
    text = changes.raised(flat)
    assert changes.is_in_space(data_of(text))
    assert not changes.is_in_space(data_of(flat))
    assert "[1, 2, 0]}  # first" in text
    assert data_of(text)["tasks"][0]["position"] == [3, 4, 0]
    assert changes.raised(text) == text
    assert data_of(changes.set_coordinate(flat, ("tasks", 0), 2, 5))["tasks"][0]["position"] == [3, 4, 5]


def test_places_that_others_share_are_not_raised_behind_their_backs() -> None:
    shared = "robots:\n  - {id: a, position: &p [1, 2]}\ntasks:\n  - {id: 1, position: *p, z: *p}\n"
    with pytest.raises(EditError, match="change it in the text itself"):
        changes.raised(shared)


def test_stations_are_placed_moved_set_and_dropped_like_tasks() -> None:
    text = changes.add(TEXT, "station", 1, 2)
    first = {"id": "station_0", "position": [1, 2, 2.5], "services": ["charge"], "charge_per_s": 1}
    assert data_of(text)["stations"] == [{**first, "position": [1, 2, 0]}]
    text = changes.set_cell(text, ("stations", 0, "slots"), 2, "station_0")
    text = changes.add_beside(text, "station")
    assert data_of(text)["stations"][1] == {**first, "id": "station_1", "position": [3, 2, 0], "slots": 2}
    text = changes.move(text, {"what": "station", "id": "station_1"}, 5, 6)
    assert data_of(text)["stations"][1]["position"] == [5, 6, 0]
    text = changes.set_cell(text, ("stations", 1, "id"), "rack", "station_1")
    text = changes.drop(text, "station", "station_0")
    assert [one["id"] for one in data_of(text)["stations"]] == ["rack"]


def test_a_delivery_lets_go_of_a_task_that_goes() -> None:
    text = changes.set_cell(TEXT, ("tasks", 1, "delivers"), "9", "8")
    assert "delivers" not in data_of(changes.drop(text, "task", "9"))["tasks"][1]


ROUND = """\
schema: muster/1
map:
  boundary: [[-9, -9], [9, -9], [9, 9], [-9, 9]]
  zones: [{circle: {center: [1, 2], radius_m: 3}}]
robots: [{id: r, position: [-8, -8]}]
tasks: [{id: a, position: [8, 8]}]
"""


def test_a_circle_is_taken_out_and_not_dragged():
    with pytest.raises(EditError, match="zone 1 is a circle; change that in the text"):
        changes.move(ROUND, {"what": "zone", "id": 0, "corner": 3}, 1, 1)
    assert "circle" not in changes.drop(ROUND, "zone", 0, enclosing((1, 2), 3))
    with pytest.raises(EditError, match="another one by now"):
        changes.drop(ROUND, "zone", 0, enclosing((1, 2), 4))
