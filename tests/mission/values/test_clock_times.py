"""Clock times of files, and the seconds that they are read to."""

from pathlib import Path

import pytest

from muster.mission.errors import MissionError
from muster.mission.model import Lag, Task, TeamPart
from muster.mission.reading.yaml_reader import parse_yaml
from muster.mission.values.time_types import clock_text
from muster.mission.yaml_writer import yaml_text

FILE = Path("mission.yaml")


def mission(task="", robot="", starts_at="2027-03-01T08:00:00+01:00", further=""):
    return parse_yaml(
        f"schema: muster/1\nstarts_at: {starts_at}\n"
        f"robots: [{{id: r_0, position: [0, 0]{robot}}}]\n"
        f"tasks: [{{id: a, position: [1, 1]{task}}}]\n{further}",
        FILE,
    )


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ('["10:00", "14:00"]', ((7200, 21600),)),
        ("[10:00, 14:00:30]", ((7200, 21630),)),
        ('["8:00", "9:00"]', ((0, 3600),)),
        ('["22:00", "02:00"]', ((50400, 64800),)),  # the second is the next day's
        ('["07:00", "09:00"]', ((82800, 90000),)),  # both are the next day's
        ('["10:00", "24:00"]', ((7200, 57600),)),
        ('["10:00", null]', ((7200, None),)),
        ('[null, "10:00"]', ((0, 7200),)),
        ('[["14:00", "16:00"], ["10:00", "12:00"]]', ((7200, 14400), (21600, 28800))),
        ("[2027-03-01T07:00, 2027-03-01T10:00]", ((0, 7200),)),  # has begun
        ("[2027-03-03T08:00:00+01:00, null]", ((172800, None),)),
        ("[2027-03-01T08:00:00Z, null]", ((3600, None),)),  # another zone
    ],
)
def test_windows(written, read):
    assert mission(f", window: {written}").tasks[0].window_s == read


def test_deadline_and_due():
    task = mission(', deadline: "10:30", due: "07:59:59"').tasks[0]
    assert (task.deadline_s, task.due_s) == (9000, 86399)


@pytest.mark.parametrize(
    ("written", "read"),
    [
        ('["08:00", "16:00"]', (0, 28800)),
        ('["22:00", "06:00"]', (50400, 79200)),
        ('["09:00", null]', (3600, None)),
        ("[2027-02-28T22:00, 2027-03-01T10:00]", (0, 7200)),
    ],
)
def test_shifts(written, read):
    robot = mission(robot=f", shift: {written}").robots[0]
    assert (robot.available_from_s, robot.available_until_s) == read


def test_several_shifts():
    robot = mission(robot=', shift: [["08:00", "12:00"], ["12:30", "17:00"]]').robots[0]
    assert robot.shifts_s == ((0, 14400), (16200, 32400))
    assert (robot.available_from_s, robot.available_until_s) == (0, 32400)
    robot = mission(robot=', shift: [["09:00", "12:00"], ["12:00", "17:00"]]').robots[0]
    assert (robot.shifts_s, robot.available_from_s, robot.available_until_s) == ((), 3600, 32400)


def test_a_start_without_zone():
    task = mission(', window: ["10:00", 2027-03-01T11:00]', starts_at="2027-03-01T08:00").tasks[0]
    assert task.window_s == ((7200, 10800),)


def test_the_day_begins_in_the_zone_of_the_start():
    assert mission(', due: "00:30"', starts_at="2027-03-01T23:30:00-05:00").tasks[0].due_s == 3600


def test_tasks_and_robots_of_events_and_of_tags():
    found = mission(
        robot=", camera: {fov_deg: 60}",
        further="""
events:
  - {at_s: 1, new_task: {id: b, position: [1, 1], window: ["10:00", "11:00"], robots_needed: 2}}
  - {at_s: 2, robot_joins: {id: r_1, position: [1, 1], shift: ["09:00", "10:00"]}}
found: [{becomes: {deadline: "09:00"}}]
""",
    )
    assert found.events[0].new_task.window_s == ((7200, 10800),)
    assert found.events[1].robot_joins.available_until_s == 7200
    assert found.found[0].becomes.deadline_s == 3600


def test_what_is_written_has_seconds_and_reads_back_equal():
    first = mission(', window: ["10:00", "14:00"], due: "11:00"', ', shift: ["08:00", "16:00"]')
    text = yaml_text(first)
    assert "window_s: [7200, 21600]" in text
    assert parse_yaml(text, FILE) == first


@pytest.mark.parametrize(
    ("seconds", "text"),
    [
        (0, "08:00:00"),
        (7230, "10:00:30"),
        (57600, "+1 00:00:00"),
        (1e5, "+1 11:46:40"),
        (86400e9, "+1000000000 08:00:00"),
    ],
)
def test_clock_text(seconds, text):
    assert clock_text(seconds, "2027-03-01T08:00:00+01:00") == text


def test_lags_stand_inside_prerequisites():
    text = """schema: muster/1
robots: [{id: r_0, position: [0, 0]}]
tasks:
  - {id: a, position: [1, 1]}
  - {id: b, position: [1, 1]}
  - {id: c, position: [1, 1], prerequisites: [b, {task: a, after_s: 5, within_s: 60}]}
  - {id: d, position: [1, 1], prerequisites: [{task: a}, {task: b, within_s: 9}]}
"""
    read = parse_yaml(text, FILE)
    c, d = read.tasks[2:]
    assert (c.prerequisites, c.lags) == (("b", "a"), {"a": Lag(after_s=5, within_s=60)})
    assert (d.prerequisites, d.lags) == (("a", "b"), {"b": Lag(within_s=9)})
    assert "prerequisites: [b, {task: a, after_s: 5, within_s: 60}]" in yaml_text(read)
    assert "prerequisites: [a, {task: b, within_s: 9}]" in yaml_text(read)
    assert parse_yaml(yaml_text(read), FILE) == read


def test_faults_of_prerequisites_with_lags_are_told_where_the_task_has_others():
    text = """schema: muster/1
robots: [{id: r_0, position: [0, 0]}]
tasks:
  - {id: a, position: [1, here], prerequisites: [{task: b, after_s: 5}]}
"""
    with pytest.raises(MissionError) as refused:
        parse_yaml(text, FILE)
    assert [(one.field, one.value) for one in refused.value.findings] == [
        ("tasks[0].position[1]", '"here"'),
        ("tasks[0].prerequisites[0]", '"b"'),
    ]


def test_in_python_lags_stand_beside_or_inside_prerequisites():
    beside = Task(id="b", position=(0, 0), prerequisites=("a",), lags={"a": Lag(after_s=2)})
    assert beside == Task(id="b", position=(0, 0), prerequisites=[{"task": "a", "after_s": 2}])
    assert beside.lag("a") == Lag(after_s=2)
    assert beside.waiting_for(()).lags == {}
    assert beside.waiting_for(("a",)) == beside
    with pytest.raises(MissionError, match=r"lags\.z.*one of its prerequisites"):
        Task(id="b", position=(0, 0), prerequisites=("a",), lags={"z": Lag(after_s=2)})


def test_who_is_for_a_team():
    task = Task(id="a", position=(0, 0))
    assert not task.is_for_team
    assert not Task(id="a", position=(0, 0), robots_needed=1).is_for_team
    assert Task(id="a", position=(0, 0), robots_needed=2).is_for_team
    assert Task(id="a", position=(0, 0), team=(TeamPart(count=2), {"kind": "air"})).is_for_team
    assert Task(id="a", position=(0, 0), needs={"lift_kg": 3}).is_for_team
