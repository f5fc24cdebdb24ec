"""Events from users, with clock times where the mission says when it starts."""

import pytest
from tests.muster_control.runs.stage import performed

import muster
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster_control.runs.runner.user_events import event_given

START = "2027-03-01T09:59:30+01:00"
TIMED = {"id": "late", "position": [5, 0], "window": ["10:00", "14:00"], "deadline": "14:30", "due": "10:00:10"}
MISSION = Mission(
    starts_at=START,
    robots=(Robot(id="r", position=(0, 0), speed_mps=2.0),),
    tasks=(Task(id="first", position=(10, 0)),),
)


def test_clock_times_are_seconds_from_the_start():
    task = event_given({"new_task": TIMED}, 5.0, START).new_task
    assert (task.window_s, task.deadline_s, task.due_s) == (((30.0, 14430.0),), 16230.0, 40.0)
    robot = event_given(
        {"robot_joins": {"id": "x", "position": [0, 0], "shift": [None, "12:00"]}}, 5.0, START
    ).robot_joins
    assert (robot.available_from_s, robot.available_until_s) == (0.0, 7230.0)


def test_what_was_given_stays_as_it_was():
    given = {"new_task": dict(TIMED)}
    event_given(given, 5.0, START)
    assert given == {"new_task": TIMED}


@pytest.mark.parametrize("key", ["window", "deadline", "due"])
def test_without_a_start_the_refusal_says_what_is_missing(key):
    task = {name: TIMED[name] for name in ("id", "position", key)}
    with pytest.raises(ParameterError, match=rf"^new_task\.{key}: .*; expected starts_at in the mission"):
        event_given({"new_task": task}, 5.0, None)


@pytest.mark.parametrize(
    ("key", "value", "said"),
    [
        ("window", ["14:00"], r"new_task\.window: .*expected \[\"10:00\", \"14:00\"\]"),
        ("deadline", "25:00", r'new_task\.deadline: "25:00"; expected a clock time'),
        ("window_s", [0, 1], r"new_task\.window: .*expected window_s or window, not both"),
        ("robots_needed", 0, r"new_task\.robots_needed: 0; expected"),
    ],
)
def test_what_is_wrong_is_said_with_its_key(key, value, said):
    with pytest.raises(ParameterError, match=f"^{said}"):
        event_given({"new_task": {**TIMED, key: value}}, 5.0, START)


def test_a_task_that_comes_in_with_clock_times_is_begun_when_its_window_opens():
    kept = performed(MISSION, muster.solve(MISSION, "greedy"), [(2.0, "event", {"new_task": TIMED})])
    (command,) = [entry["data"] for entry in kept.log if entry["kind"] == "command"]
    assert command["outcome"] == "done"
    starts = {entry["data"]["task"]: entry["time_s"] for entry in kept.log if entry["kind"] == "starts"}
    assert starts["late"] == pytest.approx(30.0, abs=0.2)
