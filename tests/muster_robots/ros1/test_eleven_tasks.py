"""The TCF thesis' 11T-2R on a real ROS master: robots are processes, one joins, one is killed, all tasks are done.

Its work is as shipped: tasks, prerequisites, types, suitability, the ground patrol, bodies. Robots are faster.
"""

import json
import math
import re
from itertools import pairwise

import pytest

from muster import load
from muster.cli.exits import DONE, STILL_MOVING
from muster.library.shipped import mission_path

SPEED, YAW_RATE, RADIUS = 3.0, 6.0, 0.3
ROBOTS = {"r_0": (-2.021, 1.461, "beta"), "r_1": (-2.023, -0.661, "epsilon"), "r_2": (-2.0, 0.4, "tau")}
"""The third is in no mission file: it is discovered. Its type can do what the two others can, but for the patrol."""


@pytest.fixture
def mission(tmp_path):
    text = mission_path("11T-2R-actions").read_text(encoding="utf-8")
    quick = f"radius_m: {RADIUS}, speed_mps: {SPEED}, yaw_rate_radps: {YAW_RATE}"
    text, changed = re.subn(r"radius_m: 0.3, speed_mps: 0.26, yaw_rate_radps: 1.82", quick, text)
    assert changed == 2
    (tmp_path / "eleven.yaml").write_text(text, encoding="utf-8")
    return load(tmp_path / "eleven.yaml")


def said(heard, topic):
    """What was said on a topic in JSON, each once."""
    found = [json.loads(data["data"]) for name, data in heard if name == topic]
    return [one for k, one in enumerate(found) if k == 0 or one != found[k - 1]]


@pytest.mark.long
def test_eleven_tasks_are_done_by_two_after_the_third_was_killed(own_ros, mission):
    """While two are there that say of themselves what they cannot mean, and do not join."""
    ros = own_ros
    for k, (name, says) in enumerate({"wrong": {"speed_mps": -1.0}, "text": "fast"}.items()):
        ros.set(f"/{name}/muster", says)
        ros.start(ros.file("robot.py"), name, 20 + k, 20)
    own = ("--speed", SPEED, "--yaw-rate", YAW_RATE, "--radius", RADIUS)
    robots = {
        name: ros.start("-m", "muster_robots.ros1.simulated_robot", name, "--at", x, y, "--type", kind, *own)
        for name, (x, y, kind) in ROBOTS.items()
    }
    listener = ros.listener(
        *(f"/{robot}/cmd_vel=geometry_msgs/Twist" for robot in robots),
        *(f"/{robot}/task_sequence=std_msgs/String" for robot in robots),
        "/r_0/odom=nav_msgs/Odometry",
        "/tf=tf2_msgs/TFMessage",
        "/muster/events=std_msgs/String",
        "/system_monitor/robots=std_msgs/String",
    )
    carried, told = ros.muster("eleven.yaml", "--time-limit", "0.5", "--format", "json"), []
    for line in carried.stderr:
        told.append(line)
        if "r_1 has done" in line:  # in the middle: it has done a task, and has others before it
            robots["r_1"].kill()
            break
    out, rest = carried.communicate(timeout=180)
    assert carried.returncode in (DONE, STILL_MOVING), rest  # r_1 may have driven when it was last heard
    report, heard = json.loads(out), listener.heard()

    assert sorted(report["tasks_done"], key=int) == [task.id for task in mission.tasks]
    assert report["tasks_lost"] == []
    for task in mission.tasks:
        for earlier in task.prerequisites:
            assert report["ends_s"][earlier] <= report["starts_s"][task.id]
    did = {row["task"]: row["robot"] for row in report["tasks"]}
    assert set(did.values()) == set(ROBOTS)
    for task, robot in did.items():
        row, kind = mission.suitability[ROBOTS[robot][2]], next(one.type for one in mission.tasks if one.id == task)
        assert row[kind] >= 0.65

    events = said(heard, "/muster/events")
    killed = next(event for event in events if event["kind"] == "robot_silent")
    assert [event["robot"] for event in events if event["kind"] == "robot_silent"] == ["r_1"]
    assert {"robot_joins", "replanned", "mission_ended"} <= {event["kind"] for event in events}
    told += rest.splitlines()
    assert [line.split()[-2] for line in told if line.rstrip().endswith(" joins")] == ["r_2"]
    text, wrong = sorted(line for line in told if "does not join" in line)
    assert "text does not join: /text/muster" in text
    assert "wrong does not join: /wrong/muster: speed_mps: -1.0; expected" in wrong
    begun = [event["time_s"] for event in events if event["kind"] == "starts" and event["robot"] == "r_1"]
    assert max(begun) < killed["time_s"]
    before, after = said(heard, "/r_1/task_sequence")[-2:]
    left = [task for task in before if task not in after]
    assert left
    assert {did[task] for task in after} == {"r_1"}
    others = [tasks for robot in ("r_0", "r_2") for tasks in said(heard, f"/{robot}/task_sequence")[-1:]]
    assert all(any(task in tasks for tasks in others) for task in left)

    for robot in robots:
        twists = [data for topic, data in heard if topic == f"/{robot}/cmd_vel"]
        assert max(twist["linear"]["x"] for twist in twists) > 0.5
        assert all(abs(twist["linear"]["x"]) <= SPEED + 1e-9 for twist in twists)
        assert all(abs(twist["angular"]["z"]) <= YAW_RATE + 1e-9 for twist in twists)
        assert all(abs(twist["linear"][axis]) < 1e-9 for twist in twists for axis in "yz")
    rows = {row["robot"]: row for row in said(heard, "/system_monitor/robots")[-1]}
    assert [robot for robot in robots if rows[robot]["activity"] == "out"] == ["r_1"]
    start = next(data["pose"]["pose"]["position"] for topic, data in heard if topic == "/r_0/odom")
    assert math.dist((start["x"], start["y"]), ROBOTS["r_0"][:2]) < 0.01
    frames = {one["child_frame_id"] for topic, data in heard if topic == "/tf" for one in data["transforms"]}
    assert {"r_0/base_link", "muster/r_0", "muster/r_0/goal", "muster/r_2"} <= frames
    times = [event["time_s"] for event in events]
    assert all(a <= b for a, b in pairwise(times))
