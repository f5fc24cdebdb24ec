"""Real ROS 1: a master, robots and `muster ros` as processes of their own, and a listener that is none of ours."""

import json
import math
import signal
import time

import pytest
from tests.bridges.ros1.conftest import own_words
from tests.times_and_teams import judge, tasks_of

from muster import Mission, Robot

MISSION = """
schema: muster/1
robots:
  - {id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}
  - {id: r_1, position: [0, 3], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}
tasks:
  - {id: t_1, position: [4, 0]}
  - {id: t_2, position: [8, 0], duration_s: 1}
  - {id: t_3, position: [8, 3], prerequisites: [t_1]}
  - {id: t_4, position: [4, 3]}
  - {id: t_5, position: [4, 6], duration_s: 1}
  - {id: t_6, position: [8, 6], prerequisites: [t_5]}
"""
QUICK = ("--time-limit", "0.3", "--format", "json")


@pytest.fixture
def mission(tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION, encoding="utf-8")
    return "m.yaml"


def test_robots_are_discovered_driven_and_one_that_dies_is_planned_for(ros, mission):
    robots = {"r_0": ros.robot("r_0", 0, 0), "r_1": ros.robot("r_1", 0, 3), "r_2": ros.robot("r_2", 8, 8)}
    heard = ros.listener(
        *(f"/{robot}/cmd_vel=geometry_msgs/Twist" for robot in robots),
        *(f"/{robot}/odom=nav_msgs/Odometry" for robot in robots),
        "/r_0/task_sequence=std_msgs/String",
        "/system_monitor/robots=std_msgs/String",
        "/muster/events=std_msgs/String",
        "/tf=tf2_msgs/TFMessage",
    )
    carried = ros.muster(mission, *QUICK)
    for line in carried.stderr:
        if "sets out: robot r_1" in line:
            robots["r_1"].kill()  # in the middle of its way
            break
    out, rest = carried.communicate(timeout=40)
    assert carried.returncode == 0, rest
    report = json.loads(out)
    assert set(report["tasks_done"]) == {f"t_{k}" for k in range(1, 7)}
    assert {row["robot"] for row in report["tasks"]} <= {"r_0", "r_2"}
    said = heard.heard()
    events = [json.loads(data["data"]) for topic, data in said if topic == "/muster/events"]
    kinds = [event["kind"] for event in events]
    assert {"robot_joins", "robot_silent", "replanned", "mission_ended"} <= set(kinds)
    assert [event["robot"] for event in events if event["kind"] == "robot_silent"] == ["r_1"]
    twists = [data for topic, data in said if topic == "/r_0/cmd_vel"]
    assert max(twist["linear"]["x"] for twist in twists) > 1
    assert all(abs(twist["linear"]["x"]) <= 3.0001 and abs(twist["angular"]["z"]) <= 6.0001 for twist in twists)
    assert any(json.loads(data["data"]) for topic, data in said if topic == "/r_0/task_sequence")
    rows = [json.loads(data["data"]) for topic, data in said if topic == "/system_monitor/robots"][-1]
    assert {row["robot"]: row["activity"] for row in rows}["r_1"] == "out"
    places = [data["pose"]["pose"]["position"] for topic, data in said if topic == "/r_0/odom"]
    assert math.dist((places[0]["x"], places[0]["y"]), (0, 0)) < 0.01
    frames = {one["child_frame_id"] for topic, data in said if topic == "/tf" for one in data["transforms"]}
    assert {"r_0/base_link", "muster/r_0", "muster/r_0/goal", "muster/r_2"} <= frames


def test_goals_are_given_to_robots_that_find_their_way(ros, mission):
    ros.robot("r_0", 0, 0, "--kinematics", "holonomic")
    ros.robot("r_1", 0, 3, "--kinematics", "holonomic")
    heard = ros.listener("/r_0/WP=geometry_msgs/PoseStamped", "/r_0/cmd_vel=geometry_msgs/Twist")
    carried = ros.muster(mission, *QUICK, "--drive", "goals", "--known-only")
    out, err = carried.communicate(timeout=40)
    assert carried.returncode == 0, err
    done = [row for row in json.loads(out)["tasks"] if row["robot"] == "r_0"]
    said = heard.heard()
    goals = [data["pose"]["position"] for topic, data in said if topic == "/r_0/WP"]
    places = {"t_1": (4, 0), "t_2": (8, 0), "t_3": (8, 3), "t_4": (4, 3), "t_5": (4, 6), "t_6": (8, 6)}
    assert done
    for row in done:
        assert any(math.dist((goal["x"], goal["y"]), places[row["task"]]) < 1e-6 for goal in goals)
    assert {data["header"]["frame_id"] for topic, data in said if topic == "/r_0/WP"} == {"map"}
    assert not [data for topic, data in said if topic == "/r_0/cmd_vel"]


def test_robots_wait_for_a_window_and_begin_together(ros):
    """Of points: robots with bodies that meet at one place may stand off on a busy machine."""
    opens_s = 6.0
    places = {f"r_{k}": (0.0, 3.0 * k) for k in range(3)}
    drive = {"speed_mps": 3.0, "yaw_rate_radps": 6.0, "kinematics": "differential-drive"}
    robots = tuple(Robot(id=name, position=place, **drive) for name, place in places.items())
    Mission(robots=robots, tasks=tasks_of(opens_s)).save(ros.folder / "together.yaml")
    for name, place in places.items():
        ros.robot(name, *place)
    carried = ros.muster("together.yaml", *QUICK)
    out, err = carried.communicate(timeout=60)
    assert carried.returncode == 0, err
    judge(json.loads(out), opens_s)


def test_ctrl_c_lets_robots_stand(ros, mission):
    ros.robot("r_0", 0, 0)
    ros.robot("r_1", 0, 3)
    heard = ros.listener("/r_0/cmd_vel=geometry_msgs/Twist", "/r_1/cmd_vel=geometry_msgs/Twist")
    carried = ros.muster(mission, *QUICK)
    for line in carried.stderr:
        if "sets out" in line:
            break
    time.sleep(0.5)
    carried.send_signal(signal.SIGINT)
    _, rest = carried.communicate(timeout=20)
    assert carried.returncode == 130, rest
    said = heard.heard()
    for robot in ("r_0", "r_1"):
        last = [data for topic, data in said if topic == f"/{robot}/cmd_vel"][-1]
        assert not any(last["linear"].values())
        assert not any(last["angular"].values())


def test_a_robot_without_a_pose_is_one_line(ros, mission):
    carried = ros.muster(mission, "--wait", "0.5")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    said = "robot r_0: nothing on /r_0/odom or /r_0/pose within 0.5 s (and 1 more); expected its pose\n"
    assert own_words(err) == said


def test_no_master_is_one_line(ros, mission):
    carried = ros.muster(mission, "--master", "http://127.0.0.1:9")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    assert err.startswith("ROS master: http://127.0.0.1:9: it does not answer; expected")
    assert err.count("\n") == 1
