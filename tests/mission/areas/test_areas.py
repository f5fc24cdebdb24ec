"""Areas in missions: what is wrong with them is said in the words of the file; split ones become tasks."""

import pytest

from muster.mission.errors import MissionError
from muster.mission.model import Action, Camera, Event, Mission, Robot, Task
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.yaml_writer import yaml_text

FIELD = "area: [[0, 0], [40, 0], [40, 30], [0, 30]], width_m: 2"
HEAD = """schema: muster/1
origin_wgs84: {lat_deg: 47.4, lon_deg: 8.5}
robots:
  - {id: a, position: [0, 0], camera: {fov_deg: 60, tilt_deg: 90}}
  - {id: b, position: [0, 0], camera: {fov_deg: 80, tilt_deg: 90}}
tasks:
"""


def mission(*lines, tmp_path):
    return parse_yaml(HEAD + "".join(f"  - {line}\n" for line in lines), tmp_path / "field.yaml")


def complaints(*lines, tmp_path):
    with pytest.raises(MissionError) as caught:
        mission(*lines, tmp_path=tmp_path)
    return [(f.line, f.field, f"{f.value}; expected {f.expected}") for f in caught.value.findings]


def field(keys, more=""):
    return f"{{id: field, action: {{name: coverage, {keys}}}{more}}}"


@pytest.mark.parametrize(
    ("keys", "at", "message"),
    [
        (
            "area: [[0, 0], [10, 10], [10, 0], [0, 10]], width_m: 1",
            "area",
            "crosses itself at (5, 5); expected a polygon whose sides meet at its corners alone",
        ),
        (
            "area: [[0, 0], [5, 5], [10, 10]], width_m: 1",
            "area",
            "corners on one line; expected a polygon whose sides meet at its corners alone",
        ),
        (
            "area: [[0, 0], [10, 0]], width_m: 1",
            "area",
            "[[0, 0], [10, 0]]; expected a list of at least 3, each [x, y] in metres, or {lat_lon: [[lat, lon], ...]}",
        ),
        (
            f"{FIELD}, holes: [[[35, 10], [45, 10], [45, 20]]]",
            "holes[0]",
            "outside the area at (43.75, 17.5); expected a polygon inside the area",
        ),
        (
            f"{FIELD}, holes: [[[0, 0], [40, 0], [40, 30], [0, 30]]]",
            "holes",
            "holes that leave nothing of the area; expected holes that leave something to be seen",
        ),
        (
            f"{FIELD}, holes: [[[10, 0], [12, 0], [12, 30], [10, 30]]]",
            "holes",
            "holes that cut the area into 2 parts; expected holes around which a robot gets everywhere, "
            "or cross_holes: true",
        ),
        (
            "area: [[0, 0], [40, 0], [40, 1], [0, 1]], width_m: 2",
            "width_m",
            "2, of an area that is 1 m wide; expected a tool narrower than its area",
        ),
        (
            "area: [[0, 0], [40, 0], [40, 30]]",
            "height_m",
            "missing; expected height_m, from which the camera looks; or width_m, the width of a tool",
        ),
        (f"{FIELD}, height_m: 3, fov_deg: 60", "fov_deg", "60.0; expected width_m or fov_deg, not both"),
        (f"{FIELD}, part: 2", "part", "2; expected split beside it: into how many parts the area is split"),
        (f"{FIELD}, part: 3, split: 2", "part", "3; expected a whole number from 1 to split (2)"),
        (
            "area: [[0, 0], [40, 0], [40, 30]], height_m: 9, split: 2",
            "split",
            "robots with different cameras: a and b; expected fov_deg, or only_robots with one camera: "
            "all parts are made of the same lanes",
        ),
    ],
)
def test_what_is_wrong_with_an_area(keys, at, message, tmp_path):
    assert complaints(field(keys), tmp_path=tmp_path) == [(7, f"tasks[0].action.{at}", message)]


def test_faults_in_degrees_are_told_in_degrees(tmp_path):
    corners = "[47.4, 8.5], [47.401, 8.501], [47.401, 8.5], [47.4, 8.501]"
    found = complaints(field(f"area: {{lat_lon: [{corners}]}}, width_m: 1"), tmp_path=tmp_path)
    assert [(line, at) for line, at, _ in found] == [(7, "tasks[0].action.area")]
    assert "crosses itself" in found[0][2]
    found = complaints(field(f"area: {{lat_lon: [{corners}, [47.4, 200]]}}, width_m: 1"), tmp_path=tmp_path)
    assert [at for _, at, _ in found] == ["tasks[0].action.area.lat_lon[4][1]"]
    hole = "{lat_lon: [[47.4, 8.5], [91, 8.5], [47.4, 8.501]]}"
    found = complaints(field(f"{FIELD}, holes: [{hole}]"), tmp_path=tmp_path)
    assert [at for _, at, _ in found] == ["tasks[0].action.holes[0].lat_lon[1][0]"]
    found = complaints(field("area: {lat_lon: [[47.4, 8.5]]}, width_m: 1"), tmp_path=tmp_path)
    assert [at for _, at, _ in found] == ["tasks[0].action.area"]


def test_an_area_in_degrees_is_the_one_in_metres(tmp_path):
    corners = "[47.4, 8.5], [47.4, 8.501], [47.401, 8.501], [47.401, 8.5]"
    hole = "[47.4004, 8.5004], [47.4004, 8.5006], [47.4006, 8.5006]"
    keys = f"area: {{lat_lon: [{corners}]}}, holes: [{{lat_lon: [{hole}]}}], width_m: 5"
    found = mission(field(keys), tmp_path=tmp_path)
    action = found.tasks[0].action
    assert action.area[0] == pytest.approx((0, 0), abs=1e-6)
    assert action.area[2] == pytest.approx((75.5, 111.2), abs=0.3)
    assert action.holes[0][0] == pytest.approx((30.2, 44.5), abs=0.2)
    assert parse_yaml(yaml_text(found), tmp_path / "again.yaml").tasks == found.tasks


def test_the_position_of_a_task_is_the_middle_of_its_area(tmp_path):
    flat = mission(field(FIELD), tmp_path=tmp_path)
    assert flat.tasks[0].position == pytest.approx((20, 15))
    text = HEAD.replace("[0, 0]", "[0, 0, 1]") + f"  - {field(FIELD)}\n"
    assert parse_yaml(text, tmp_path / "field.yaml").tasks[0].position == pytest.approx((20, 15, 0))


def test_a_split_task_becomes_its_parts(tmp_path):
    found = mission(
        field(f"{FIELD}, split: 3", ", prerequisites: [gate], priority: 2"),
        "{id: gate, position: [0, -5]}",
        "{id: after, position: [0, 0], prerequisites: [{task: field, after_s: 5}], other_robot_than: field}",
        tmp_path=tmp_path,
    )
    assert [task.id for task in found.tasks] == ["field.1", "field.2", "field.3", "gate", "after"]
    assert [task.action.part for task in found.tasks[:3]] == [1, 2, 3]
    assert all(task.prerequisites == ("gate",) and task.priority == 2 for task in found.tasks[:3])
    after = found.tasks[-1]
    assert after.prerequisites == after.other_robot_than == ("field.1", "field.2", "field.3")
    assert {name: lag.after_s for name, lag in after.lags.items()} == {f"field.{k}": 5 for k in (1, 2, 3)}
    assert parse_yaml(yaml_text(found), tmp_path / "again.yaml") == found


def test_findings_of_parts_have_the_place_of_the_task_in_the_file(tmp_path):
    found = mission(field(f"{FIELD}, split: 3"), "{id: gate, position: [0, -5]}", tmp_path=tmp_path)
    assert [found.source.place(("tasks", k))[1] for k in range(4)] == [7, 7, 7, 8]
    assert found.source.path(("tasks", 3, "position")) == ("tasks", 1, "position")


def test_a_mission_built_in_python_is_split_too():
    action = Action(name="coverage", area=((0, 0), (40, 0), (40, 30)), width_m=2, split=2)
    team = (Robot(id="a", position=(0, 0)),)
    tasks = (Task(id="field", position=(0, 0), action=action), Task(id="x", position=(1, 1), prerequisites=("field",)))
    events = (Event(at_s=3, cancel_task="field"), Event(at_s=9, cancel_task="x"))
    made = Mission(robots=team, tasks=tasks, events=events)
    assert [task.id for task in made.tasks] == ["field.1", "field.2", "x"]
    assert made.tasks[2].prerequisites == ("field.1", "field.2")
    assert [event.cancel_task for event in made.events] == ["field.1", "field.2", "x"]


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        (
            [field(f"{FIELD}, split: 2"), "{id: field.2, position: [0, 0]}"],
            '"field"; expected an id whose parts have ids of their own: there is a field.2',
        ),
        (
            [field(f"{FIELD}, split: 2", ", duration_s: 60")],
            "60.0; expected nothing here beside split: each part is a task",
        ),
    ],
)
def test_what_cannot_be_split(lines, told, tmp_path):
    assert [message for _, _, message in complaints(*lines, tmp_path=tmp_path)] == [told]


def test_areas_do_not_move_and_what_comes_later_is_one_task():
    action = Action(name="coverage", area=((0, 0), (40, 0), (40, 30)), width_m=2)
    team = (Robot(id="a", position=(0, 0), camera=Camera(fov_deg=60, tilt_deg=90)),)
    task = Task(id="field", position=(0, 0), action=action)
    with pytest.raises(MissionError, match="a task without an area"):
        Mission(robots=team, tasks=(task,), events=(Event(at_s=1, move_task={"task": "field", "position": [1, 1]}),))
    with pytest.raises(MissionError, match="what comes later is one task"):
        Event(at_s=1, new_task={"id": "n", "position": [0, 0], "action": {**vars_of(action), "split": 2}})


def vars_of(action):
    return {"name": action.name, "area": action.area, "width_m": action.width_m}


def test_degrees_in_the_wrong_order_are_far_away(tmp_path):
    corners = "[8.5, 47.4], [8.501, 47.4], [8.501, 47.401]"
    found = complaints(field(f"area: {{lat_lon: [{corners}]}}, width_m: 1"), tmp_path=tmp_path)
    assert [at for _, at, _ in found] == [f"tasks[0].action.area.lat_lon[{k}]" for k in range(3)]
    assert "4944 km from origin_wgs84; expected a place within 1000 km of it: latitude comes first" in found[0][2]
