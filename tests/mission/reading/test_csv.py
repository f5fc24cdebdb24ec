"""Task-list CSV: what is written is read back, and what cannot be written is refused."""

from dataclasses import replace

import pytest
from hypothesis import given
from tests.mission.reading.csv_writer import write_csv
from tests.mission.strategies import examples, plain_missions

from muster.mission.errors import MissionError
from muster.mission.model import (
    Action,
    Event,
    Map,
    Mission,
    Robot,
    Rules,
    Task,
)
from muster.mission.reading.thesis_csv import read_csv, read_csv_for


def csv_files(folder):
    return folder / "tasks.csv", folder / "robots.csv", folder / "suitability.csv"


def through_csv(mission, folder):
    """The mission written as CSV and read back."""
    tasks, robots, suitability = csv_files(folder)
    table = None if mission.suitability is None else suitability
    write_csv(mission, tasks, robots, table)
    return read_csv(tasks, robots, table)


def filled(mission):
    """With a score of 0 for every type of task that a row lacks: a table in CSV has no gaps."""
    if mission.suitability is None:
        return mission
    columns = {kind for row in mission.suitability.values() for kind in row}
    table = {name: dict.fromkeys(columns, 0.0) | dict(row) for name, row in mission.suitability.items()}
    return replace(mission, suitability=table)


@examples(80)
@given(plain_missions())
def test_csv_is_read_back(folder, mission):
    assert through_csv(mission, folder) == filled(mission)


@examples(120)
@given(plain_missions(names="any"))
def test_csv_is_read_back_or_refused(folder, mission):
    """Names with spaces, commas and brackets: whatever is written means the same when it is read."""
    try:
        again = through_csv(mission, folder)
    except MissionError as error:
        again, refused = None, {finding.value for finding in error.findings}
    assert again == filled(mission) if again else refused == {"more than CSV can say"}


R, T = Robot(id="r_0", position=(0, 0)), Task(id="1", position=(4, 5))
PLAIN = Mission(name="tasks", robots=(R,), tasks=(T,))


@pytest.mark.parametrize(
    ("mission", "field"),
    [
        (replace(PLAIN, rules=Rules(objective="max")), "rules"),
        (replace(PLAIN, rules=Rules(travel="euclidean"), map=Map(ros_yaml="floor.yaml")), "map"),
        (replace(PLAIN, events=(Event(at_s=3, cancel_task="1"),)), "events"),
        (replace(PLAIN, robots=(replace(R, speed_mps=2),)), "robots"),
        (replace(PLAIN, robots=(replace(R, skills=("camera",)),)), "robots"),
        (replace(PLAIN, robots=(replace(R, end_position=(1, 1)),)), "robots"),
        (replace(PLAIN, tasks=(replace(T, requires=("camera",)),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, priority=2),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, needs={"lift_kg": 3}),)), "tasks"),
        (replace(PLAIN, starts_at="2027-03-01T08:00"), "starts_at"),
        (replace(PLAIN, tasks=(replace(T, action=Action(name="go-to-goal")),)), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id="a b"), Task(id="2", position=(1, 1), prerequisites=("a b",)))), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id="[7]"), Task(id="2", position=(1, 1), prerequisites=("[7]",)))), "tasks"),
        (replace(PLAIN, tasks=(replace(T, id=" 1"),)), "tasks"),
        (replace(PLAIN, robots=(replace(R, type="beta "),)), "robots"),
    ],
)
def test_what_csv_cannot_say_is_refused_and_nothing_is_written(mission, field, tmp_path):
    with pytest.raises(MissionError) as caught:
        write_csv(mission, *csv_files(tmp_path))
    assert field in [finding.field for finding in caught.value.findings]
    assert all(f.value == "more than CSV can say" for f in caught.value.findings)
    assert list(tmp_path.iterdir()) == []


def test_suitability_without_a_file_for_it_is_refused(tmp_path):
    table = {"beta": {"D": 0.9}}
    mission = replace(PLAIN, suitability=table, robots=(replace(R, type="beta"),), tasks=(replace(T, type="D"),))
    with pytest.raises(MissionError, match="suitability: more than CSV can say"):
        write_csv(mission, *csv_files(tmp_path)[:2])


def test_csv_as_people_write_it(tmp_path):
    """Spaces, empty lines, every form of a list and of an unlimited capacity, columns in another order."""
    tasks, robots, _ = csv_files(tmp_path)
    tasks.write_text(
        'type, index ,x,y,prerequisites,actuation_cost\r\n\r\nD,1, 4 ,5,[],\r\nD,2,4,5,1,2.5\r\n,3,4,5,"[1, 2]",0\r\n'
        "D,4,4,5,1 2 3,0\r\nD,5,4,5,1;2,0\r\nD,6,4,5,,0\r\n",
        encoding="utf-8-sig",
    )
    robots.write_text("id,type,x,y,work_capacity\nr_0,,0,0,inf\nr_1,,1e1,0,\nr_2,,0,-.5,INF\nr_3,,0,0,50\n", "utf-8")
    mission = read_csv(tasks, robots)
    assert mission.name == "tasks"
    assert [task.prerequisites for task in mission.tasks] == [(), ("1",), ("1", "2"), ("1", "2", "3"), ("1", "2"), ()]
    assert [task.actuation_cost for task in mission.tasks] == [0, 2.5, 0, 0, 0, 0]
    assert [task.type for task in mission.tasks] == ["D", "D", None, "D", "D", "D"]
    assert [robot.work_capacity for robot in mission.robots] == [None, None, None, 50]
    assert mission.robots[1].position == (10, 0)


@pytest.mark.parametrize(("header", "row", "size"), [("x,y", "1,2", 2), ("x,y,z", "1,2,3", 3)])
def test_a_task_list_alone_is_for_robots_from_elsewhere(tmp_path, header, row, size):
    file = tmp_path / "six.csv"
    file.write_text(f"index,{header},type,actuation_cost,prerequisites\n7,{row},D,4,\n", encoding="utf-8")
    asked = []

    def robots(dimensions):
        asked.append(dimensions)
        return [{"id": "r_0", "position": [0.0] * dimensions}]

    mission = read_csv_for(robots, file)
    assert asked == [size]
    assert (mission.name, [task.id for task in mission.tasks]) == ("six", ["7"])
    assert [robot.id for robot in mission.robots] == ["r_0"]


def test_times_of_a_task_list(tmp_path):
    tasks, robots, _ = csv_files(tmp_path)
    head = "index,x,y,type,actuation_cost,prerequisites,duration_s,window_s,deadline_s,due_s,robots_needed\n"
    tasks.write_text(head + '1,0,0,,,,30,"[600,1200]",1500,900,2\n2,1,0,,,1,,2000 inf; 600 1200,,,\n')
    robots.write_text("id,type,x,y,work_capacity\nr_0,,0,0,\n")
    first, second = read_csv(tasks, robots).tasks
    times = {"duration_s": 30, "window_s": (600, 1200), "deadline_s": 1500, "due_s": 900, "robots_needed": 2}
    assert first == Task(id="1", position=(0, 0), **times)
    assert second.window_s == ((600, 1200), (2000, None))


def test_a_wrong_time_of_a_task_list_is_named(tmp_path):
    tasks, robots, _ = csv_files(tmp_path)
    head = "index,x,y,type,actuation_cost,prerequisites,window_s,robots_needed\n"
    tasks.write_text(head + "1,0,0,,,,600,\n2,1,0,,,1,,two\n")
    robots.write_text("id,type,x,y,work_capacity\nr_0,,0,0,\n")
    with pytest.raises(MissionError) as caught:
        read_csv(tasks, robots)
    assert [(f.line, f.field, f.value) for f in caught.value.findings] == [
        (2, "tasks[0].window_s[0]", "[600.0]"),
        (3, "tasks[1].robots_needed", '"two"'),
    ]
