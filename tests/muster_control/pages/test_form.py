"""What is typed into the cells of a form, as the text of a mission holds it."""

import pytest
import yaml
from tests.timed_missions.missions import timed_mission

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Robot, Station, Task
from muster.mission.records import specified
from muster.mission.yaml_writer import yaml_text
from muster_control.pages.editing import form
from muster_control.pages.editing.cell_texts import number_of, text_of, value_of


@pytest.mark.parametrize(
    ("typed", "number"), [("1000", 1000), ("1.5", 1.5), ("0,5", 0.5), ("-0,125", -0.125), ("2.0", 2), ("1e3", 1000)]
)
def test_numbers(typed, number):
    found = number_of(typed, "x")
    assert (found, type(found)) == (number, type(number))


@pytest.mark.parametrize("typed", ["fast", "1,000", "-12,345", "1_000", "nan", "inf", "1e400", "1,000.5", "1.2.3"])
def test_what_is_no_number_or_may_be_two(typed):
    with pytest.raises(ParameterError, match=rf"^x: '{typed}'; expected a number, as 1000 or 1\.5$"):
        number_of(typed, "x")


@pytest.mark.parametrize(
    ("kind", "typed", "value"),
    [
        ("words", "30, 31 32", ["30", "31", "32"]),
        ("lagged", "30 31(5..60)", ["30", {"task": "31", "after_s": 5, "within_s": 60}]),
        ("lagged", "32(..9)", [{"task": "32", "within_s": 9}]),
        ("lagged", "a(2.5 ..)", [{"task": "a", "after_s": 2.5}]),
        ("spans", "600 to 1200", [600, 1200]),
        ("spans", "600 to 1200; 2000 to", [[600, 1200], [2000, None]]),
        ("clock spans", "10:00 to 14:00", ["10:00", "14:00"]),
        ("spans", "1,5 to 2,5, 3 to 4", [[1.5, 2.5], [3, 4]]),
        ("clock spans", "to 14:00", [None, "14:00"]),
        ("amounts", "lift_kg 20, water_l 1,5", {"lift_kg": 20, "water_l": 1.5}),
        ("amounts", "lift_kg: 20; water_l = 1", {"lift_kg": 20, "water_l": 1}),
        (
            "parts",
            "2 type=rover; 1 kind=air requires=camera+gripper",
            [{"count": 2, "type": "rover"}, {"count": 1, "kind": "air", "requires": ["camera", "gripper"]}],
        ),
        ("parts", "kind=air", [{"kind": "air"}]),
        ("loads", "3", 3),
        ("loads", "-1,5", -1.5),
        ("loads", "parcels 2, water_l 1,5", {"parcels": 2, "water_l": 1.5}),
        ("choice", "true", True),
        ("text", "  ", None),
    ],
)
def test_cells_of_every_kind(kind, typed, value):
    assert value_of(typed, "x", kind) == value
    assert value_of(text_of(value, kind), "x", kind) in (value, [{"count": 1, "kind": "air"}])


@pytest.mark.parametrize(
    ("kind", "typed", "expected"),
    [
        ("spans", "600-1200", "'600-1200'; expected spans, as 600 to 1200; 2000 to"),
        ("spans", "noon to 1200", "'noon'; expected a number"),
        ("amounts", "lift_kg", "'lift_kg'; expected a name and an amount"),
        ("parts", "two rovers", "'two'; expected parts, as 2 type=rover"),
        ("loads", "parcels", "'parcels'; expected a number"),
        ("lagged", "a(soon..)", "'soon'; expected a number"),
    ],
)
def test_what_cannot_be_read_says_what_was_expected(kind, typed, expected):
    with pytest.raises(ParameterError) as error:
        value_of(typed, "task a: window_s", kind)
    assert str(error.value).startswith("task a: window_s: ")
    assert expected in str(error.value)


def test_values_of_another_form_are_shown_as_they_are():
    assert text_of(["10:00"], "spans") == "10:00"
    assert text_of("soon", "spans") == "soon"
    assert text_of([1, [2]], "lagged") == "1 [2]"


TEXT_ALONE = {  # what is typed on the map, in a dialogue or in the text
    *("id", "position", "entry", "exit", "end_position", "return_to_start", "skill_quality", "efficiency"),
    *("heading_deg", "kinematics", "camera", "action", "only_robots", "across_partition", "lags", "avoidance_priority"),
    *("shifts_s", "longest_aboard_s", "either_or", "within_m"),
}


def test_every_key_of_robots_and_tasks_has_a_cell_or_is_known_to_have_none():
    keys = {one.name for model in (Robot, Task, Station) for one in specified(model)}
    assert keys - set(form._COLUMNS) <= TEXT_ALONE


@pytest.mark.parametrize("name", ["collapsed-building", *range(30)])
def test_all_cells_typed_again_as_they_are_shown_leave_the_mission_as_it_is(name, tmp_path):
    """Missions with all rules of time, teams and relations."""
    mission = muster.load(name) if isinstance(name, str) else timed_mission(name)
    data = yaml.safe_load(yaml_text(mission))
    data.pop("travel", None)  # in files beside it
    data["rules"].pop("travel", None)
    for item in (*data["robots"], *data["tasks"]):
        for key, shown in form._row(item).items():
            if key in form._COLUMNS and key not in form._AXES:
                item[key] = value_of(shown, key, form._COLUMNS[key].kind)
    file = tmp_path / "again.yaml"
    file.write_text(yaml.safe_dump(data))
    again = muster.load(file)
    assert (again.robots, again.tasks) == (mission.robots, mission.tasks)
