"""Robots with move_base: processes that know nothing of Muster, only rospy (`move_base.py`)."""

import json
import re
import time

import pytest
from tests.muster_robots.ros1.conftest import own_words

MISSION = """
schema: muster/1
robots:
  - {id: r_0, position: [0, 0], speed_mps: 3, radius_m: 0.2}
  - {id: r_1, position: [0, 3], speed_mps: 3, radius_m: 0.2}
tasks:
  - {id: t_1, position: [4, 0]}
  - {id: t_2, position: [8, 0], duration_s: 1}
  - {id: t_3, position: [8, 3], prerequisites: [t_1]}
  - {id: t_4, position: [4, 3]}
  - {id: t_5, position: [4, 6], duration_s: 1}
  - {id: t_6, position: [8, 6], prerequisites: [t_5]}
"""
TASKS = {f"t_{k}" for k in range(1, 7)}
QUICK = ("--time-limit", "0.3", "--format", "json")


def started(ros, name, x, y, *words):
    return ros.start(ros.file("move_base.py"), name, x, y, *words)


@pytest.fixture
def mission(tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION, encoding="utf-8")
    return "m.yaml"


def done(carried, told=""):
    """The report, and what was told."""
    out, err = carried.communicate(timeout=90)
    assert carried.returncode in (0, 4, 5), err
    return json.loads(out), told + err


def told_until(carried, words):
    told = []
    for line in carried.stderr:
        told.append(line)
        if words in line:
            break
    return "".join(told)


def test_messages_are_those_of_move_base_msgs(rospy_there):
    """MD5 sums of move_base_msgs 1.14, by which nodes of ROS 1 match."""
    from muster_robots.ros1.action_types import move_base_types

    sums = [kind._md5sum for kind in move_base_types()]
    assert sums == [
        "660d6895a1b9a16dce51fbdd9a64a56b",
        "7d1870ff6e0decea702b943b5af0b42e",
        "1eb06eeff08fa7ea874431638cb52332",
    ]


@pytest.mark.long
def test_two_robots_do_all_tasks_and_what_one_is_refused_the_other_does(ros, mission):
    started(ros, "r_0", 0, 0, "abort=8,3")
    started(ros, "r_1", 0, 3)
    report, told = done(ros.muster(mission, *QUICK, "--profile", "move_base"))
    assert set(report["tasks_done"]) == TASKS, told
    rows = {row["task"]: row["robot"] for row in report["tasks"]}
    assert rows["t_3"] == "r_1"
    assert "begins at" not in told


@pytest.mark.long
@pytest.mark.parametrize(
    ("how", "words"),
    [("abort", "aborted (Failed to find a valid plan)"), ("reject", "rejected (Quaternion has length close to zero)")],
)
def test_a_task_that_move_base_refuses_is_lost_with_its_words_and_the_others_are_done(ros, tmp_path, how, words):
    alone = "".join(line for line in MISSION.splitlines(keepends=True) if "id: r_1" not in line)
    (tmp_path / "m.yaml").write_text(alone, encoding="utf-8")
    started(ros, "r_0", 0, 0, f"{how}=4,3")
    report, told = done(ros.muster("m.yaml", *QUICK, "--profile", "move_base"))
    assert set(report["tasks_done"]) == TASKS - {"t_4"}
    assert f"r_0 cannot do task t_4: move_base: {words}" in told


@pytest.mark.long
def test_robots_that_take_simple_goals_and_are_localised_by_amcl_pose_alone(ros, mission):
    started(ros, "r_0", 0, 0, "simple", "amcl")
    started(ros, "r_1", 0, 3, "simple", "amcl")
    asked = ("--drive", "move_base_simple", "--arrival", "0.2")
    report, told = done(ros.muster(mission, *QUICK, "--profile", "move_base", *asked))
    assert set(report["tasks_done"]) == TASKS, told


@pytest.mark.long
def test_a_server_that_is_killed_and_comes_back_gets_its_goal_again(ros, tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION.replace("[8, 6]", "[60, 6]"), encoding="utf-8")
    started(ros, "r_0", 0, 0)
    robot = started(ros, "r_1", 0, 3)
    carried = ros.muster("m.yaml", *QUICK, "--profile", "move_base")
    told = told_until(carried, "sets out for task t_6")
    robot.kill()
    robot.wait()
    time.sleep(0.5)
    started(ros, "r_1", 0, 3)
    report, told = done(carried, told)
    assert set(report["tasks_done"]) == TASKS, told


@pytest.mark.long
@pytest.mark.parametrize(
    ("by", "topic", "words", "why"),
    [
        (
            "action",
            "move_base/goal",
            (),
            r"move_base(: canceled by somebody else| has goal /rviz-\d+-12.5, which is not)",
        ),
        ("topic", "move_base_simple/goal", ("simple",), "a goal on /r_1/move_base_simple/goal is not Muster's"),
    ],
    ids=["action", "topic"],
)
def test_a_robot_that_another_station_sends_away_does_its_tasks_when_it_has_been_there(
    ros, tmp_path, by, topic, words, why
):
    (tmp_path / "m.yaml").write_text(MISSION.replace("[8, 6]", "[60, 6]"), encoding="utf-8")
    for k in range(2):
        started(ros, f"r_{k}", 0, 3 * k, *words)
    hear = 2 if words else 1  # of a topic Muster, too
    station = ros.start(ros.file("other_station.py"), f"/r_1/{topic}", by, 10, 12, hear)
    assert station.stdout.readline() == "there\n"
    asked = ("--drive", "move_base_simple", "--arrival", "0.2") if words else ()
    carried = ros.muster("m.yaml", *QUICK, "--profile", "move_base", *asked)
    told = told_until(carried, "r_1 sets out for task")
    station.stdin.write("\n")
    station.stdin.flush()
    report, told = done(carried, told)
    assert re.search(f"another station: {why}", told)  # by what comes first, where it has a goal of Muster's
    assert set(report["tasks_done"]) == TASKS, told


@pytest.mark.long
def test_all_tasks_are_done_where_the_master_is_started_anew(own_ros, mission):
    started(own_ros, "r_0", 0, 0)
    started(own_ros, "r_1", 0, 3)
    carried = own_ros.muster(mission, *QUICK, "--profile", "move_base")
    told = told_until(carried, "sets out for task")
    own_ros.master.stop()
    own_ros.master.start()
    report, told = done(carried, told)
    assert set(report["tasks_done"]) == TASKS, told


@pytest.mark.long
@pytest.mark.parametrize(
    ("words", "said"),
    [
        (
            ("poses",),
            "nobody receives its orders{}; expected an action server of /r_1/move_base (move_base_msgs/MoveBaseAction)",
        ),
        (
            ("untied",),
            "/r_1/odom is in frame r_1/odom, which tf does not tie to map{}; expected tf from map to r_1/odom, or a "
            "pose in map, or --odometry start",
        ),
    ],
)
def test_what_a_robot_lacks_is_named_before_the_mission_begins(ros, mission, words, said):
    started(ros, "r_0", 0, 0)
    started(ros, "r_1", 0, 3, *words)
    time.sleep(1.0)
    carried = ros.muster(mission, *QUICK, "--profile", "move_base", "--wait", "4")
    out, err = carried.communicate(timeout=40)
    assert (carried.returncode, out) == (2, "")
    assert own_words(err) == f"robot r_1: {said.format(' within 4 s')}\n"
    assert f"robot r_1: {said.format('')}; it is waited for up to 4 s" in err


@pytest.mark.long
def test_muster_which_hears_goals_on_a_topic_does_not_count_as_the_one_that_receives_them(ros, mission):
    started(ros, "r_0", 0, 0, "simple")
    started(ros, "r_1", 0, 3, "poses")
    time.sleep(1.0)
    asked = ("--profile", "move_base", "--drive", "move_base_simple", "--wait", "4")
    carried = ros.muster(mission, *QUICK, *asked)
    out, err = carried.communicate(timeout=40)
    assert (carried.returncode, out) == (2, "")
    expected = "a subscriber of /r_1/move_base_simple/goal (geometry_msgs/PoseStamped)"
    assert own_words(err) == f"robot r_1: nobody receives its orders within 4 s; expected {expected}\n"
