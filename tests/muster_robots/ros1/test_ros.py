"""Real ROS 1: a master, robots and `muster ros` as processes of their own, and a listener that is none of ours."""

import json
import math

import pytest
from tests.muster_robots.ros1.conftest import own_words
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


@pytest.mark.long
def test_robots_are_given_goals_wait_for_a_window_and_begin_together(ros):
    """Of points that find their way: robots with bodies that meet at one place may stand off on a busy machine."""
    opens_s = 2.0
    places = {f"r_{k}": (0.0, 3.0 * k) for k in range(3)}
    robots = tuple(Robot(id=name, position=place, speed_mps=3.0) for name, place in places.items())
    tasks = tasks_of(opens_s)
    Mission(robots=robots, tasks=tasks).save(ros.folder / "together.yaml")
    for name, place in places.items():
        ros.robot(name, *place, "--kinematics", "holonomic")
    heard = ros.listener(
        *(f"/{name}/WP=geometry_msgs/PoseStamped" for name in places),
        *(f"/{name}/cmd_vel=geometry_msgs/Twist" for name in places),
    )
    carried = ros.muster("together.yaml", *QUICK, "--drive", "goals", "--known-only")
    out, err = carried.communicate(timeout=60)
    assert carried.returncode == 0, err
    report = json.loads(out)
    judge(report, opens_s)
    said = heard.heard()
    assert {topic.rpartition("/")[2] for topic, _ in said} == {"WP"}
    assert {data["header"]["frame_id"] for _, data in said} == {"map"}
    where = {task.id: task.position for task in tasks}
    for row in report["tasks"]:
        for name in row.get("team", [row["robot"]]):
            goals = [data["pose"]["position"] for topic, data in said if topic == f"/{name}/WP"]
            assert any(math.dist((goal["x"], goal["y"]), where[row["task"]]) < 1e-6 for goal in goals)


@pytest.mark.long
def test_a_robot_without_a_pose_is_one_line(ros, mission):
    carried = ros.muster(mission, "--wait", "0.5")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    said = (
        "robot r_0: nothing on /r_0/odom or /r_0/pose or /r_0/amcl_pose within 0.5 s (and 1 more); expected its pose\n"
    )
    assert own_words(err) == said


def test_no_master_is_one_line(ros, mission):
    carried = ros.muster(mission, "--master", "http://127.0.0.1:9")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    assert err.startswith("ROS master: http://127.0.0.1:9: it does not answer; expected")
    assert err.count("\n") == 1
