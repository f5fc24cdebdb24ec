"""The thesis' nodes beside `/muster` (TCF, Table 5.1), each a process, on a real ROS master."""

import json
import os
import signal
import time
from itertools import groupby, pairwise
from pathlib import Path

import pytest
from tests.muster_robots.ros1.conftest import NODES, alive, family, own_words

QUICK = ("--time-limit", "0.2", "--format", "json")
ROBOT = "{id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}"


def mission(name, *tasks):
    rows = "\n".join(f"  - {{id: {task}, position: [{x}, {y}]}}" for task, x, y in tasks)
    return f"schema: muster/1\nname: {name}\nrobots:\n  - {ROBOT}\ntasks:\n{rows}\n"


NEAR = mission("near", ("t_1", 1, 0), ("t_2", 2, 0))
FAR = mission("far", ("t_1", 50, 0), ("t_2", 90, 0))
LOAD, START, PAUSE, CANCEL = (f"/command_interface/{verb}" for verb in ("load", "start", "pause", "cancel"))


def state_is(user, *states):
    return user.until(lambda status: status["state"] in states, last="/muster/status")


def gone(user):
    """All nodes of Muster have said goodbye to the master."""
    return not NODES & set(user.do(nodes=True))


def ctrl_c(process):
    """As a terminal does: to all of its group."""
    os.killpg(process.pid, signal.SIGINT)


@pytest.mark.long
def test_missions_are_loaded_carried_out_as_they_change_and_follow_one_another(ros):
    ros.robot("r_0", 0, 0)
    topics = ("/muster/events", "/mission_planner/plan", "/muster/status")
    heard = ros.listener(*(f"{topic}=std_msgs/String" for topic in topics))
    carried = ros.muster(*QUICK, "--stay")
    user = ros.user()
    user.until(NODES.issubset, nodes=True)
    assert user.until(bool, publishers="/mission_planner/plan") == ["/mission_planner"]
    assert user.until(bool, publishers="/system_monitor/robots") == ["/system_monitor"]

    # nothing is there yet, and that is what is said
    assert user.call(START) == (False, "no mission; expected one that was loaded and waits, or is paused")
    assert user.call(PAUSE) == (False, "no mission; expected one that is carried out")
    assert user.call(CANCEL) == (False, "no mission; expected one that waits or is under way")
    succeeded, message = user.call(LOAD)
    assert (succeeded, message.startswith("/command_interface/mission: missing; expected a mission in YAML")) == (
        False,
        True,
    )

    # a mission that is wrong never gets there
    user.do(set="/command_interface/mission", to=NEAR.replace("[1, 0]", "[1, here]"))
    assert user.call(LOAD) == (
        False,
        '/command_interface/mission:6: tasks[0].position[1]: "here"; expected a finite number',
    )
    user.do(set="/command_interface/mission", to="31T-6R5")
    succeeded, message = user.call(LOAD)
    assert not succeeded
    assert "no such file or mission" in message

    # one that is right is carried out when it is started, pauses and goes on when told, and gets more tasks
    user.do(set="/command_interface/mission", to=NEAR)
    assert user.call(LOAD) == (True, "mission near: 1 robots, 2 tasks; start begins it")
    assert user.do(last="/muster/status")["state"] == "waiting"
    for text in ('{"id": "more", "position": [12, 0]}', '{"id": "wrong", "position": "here"}'):
        user.do(publish="/command_interface/add_task", text=text)
    time.sleep(0.5)  # topics have no answer
    assert user.call(START) == (True, "mission near begins")
    user.until(lambda plan: "more" in plan["task_sequences"]["r_0"], last="/mission_planner/plan")
    user.do(publish="/command_interface/add_task", text='{"id": "late", "position": [13, 0]}')
    assert user.call(PAUSE) == (True, "mission near is paused; the robots were told to stand")
    time.sleep(1.2)  # longer than it takes to say again how it stands
    assert carried.poll() is None
    assert user.call(START) == (True, "mission near goes on")
    first = json.loads(read_json(carried))
    assert set(first["tasks_done"]) == {"t_1", "t_2", "more", "late"}
    assert state_is(user, "ended")["tasks_done"] == 4
    judge_what_was_said([(topic, json.loads(data["data"])) for topic, data in heard.heard()])
    succeeded, message = user.call(START)
    assert (succeeded, message.split(";")[0]) == (False, "mission near is ended")

    # and so is the next, of which a file is named, until it is cancelled
    (ros.folder / "far.yaml").write_text(FAR, encoding="utf-8")
    user.do(set="/command_interface/mission", to="far.yaml")
    assert user.call(LOAD)[0]
    assert user.call(START)[0]
    state_is(user, "carrying-out")
    user.until(lambda row: row["position"][0] > 15 and row["activity"] == "driving", last="/r_0/status")  # driven anew
    assert user.call(START) == (
        False,
        "mission far is carrying-out; expected one that was loaded and waits, or is paused",
    )
    assert user.call(LOAD) == (False, "mission far is carrying-out; expected none under way: cancel it first")
    assert user.call("/mission_planner/plan")[0] is False
    assert user.call(PAUSE) == (True, "mission far is paused; the robots were told to stand")
    assert user.call(PAUSE)[0] is False
    assert user.call(CANCEL) == (True, "mission far is cancelled; the robots were told to stand")
    assert json.loads(read_json(carried))["tasks_done"] == []
    assert state_is(user, "ended")["reason"] == "cancelled"

    children = family(carried)
    assert len(children) == 3
    ctrl_c(carried)
    assert carried.wait(timeout=20) == 130
    assert gone(user)
    assert alive(children) == []


def judge_what_was_said(said):
    """Of a mission of two tasks that got two more, was paused, went on and has ended."""
    status = [data for topic, data in said if topic == "/muster/status"]
    states = [state for state, _ in groupby(data["state"] for data in status)]
    begun = ["waiting", "gathering", "planning", "carrying-out"]
    assert states[states.index("waiting") :] == [*begun, "paused", "carrying-out", "ended"]
    under_way = [data for data in status if data["state"] in ("carrying-out", "paused")]
    assert [done for done, _ in groupby(data["tasks_done"] for data in under_way)] == [0, 1, 2, 3, 4]
    times = [data["time_s"] for data in under_way]
    assert times[0] == 0.0
    assert times == sorted(times)
    assert all(b - a < 1.5 for a, b in pairwise(times))
    ends = [data["time_s"] for topic, data in said if topic == "/muster/events" and data["kind"] == "ends"]
    assert max(times) >= ends[-1] > 1.0
    assert status[-1] | {"time_s": 0} == {"state": "ended", "mission": "near", "tasks_done": 4, "time_s": 0}
    events = [data for topic, data in said if topic == "/muster/events"]
    assert [event["reason"].split(";")[0] for event in events if event["kind"] == "event_refused"] == [
        'add_task: position: "here"'
    ]
    plans = [data["task_sequences"]["r_0"] for topic, data in said if topic == "/mission_planner/plan"]
    assert plans[0] == ["t_1", "t_2"]
    assert ["t_1", "t_2", "more"] in plans
    assert "late" in plans[-1]


def read_json(process):
    """One mapping of several lines, which `json_text` ends with a brace alone."""
    text = ""
    for line in process.stdout:
        text += line
        if line == "}\n":
            return text
    raise AssertionError(process.stderr.read())


SIX = """index,x,y,type,actuation_cost,prerequisites
1,1,0,D,0.5,
2,2,0,D,0.5,[1]
3,3,0,E,0.5,"[1,2]"
"""
SUITABILITY = "robot_type,D,E\nbeta,0.9,0.9\nzeta,0.9,0.0\n"


@pytest.mark.long
def test_without_a_mission_robots_are_watched_and_planned_for(ros):
    """And a task list is carried out by them: [tcf-thesis], 5.2: command_interface takes the name of one."""
    (ros.folder / "six.csv").write_text(SIX, encoding="utf-8")
    (ros.folder / "types.csv").write_text(SUITABILITY, encoding="utf-8")
    carried = ros.muster(*QUICK, "--allocator", "greedy")
    user = ros.user()
    user.until(NODES.issubset, nodes=True)
    user.do(set="/command_interface/mission", to="six.csv")
    told = "robots: none; expected some in the mission, or some that publish odom or pose"
    assert user.call(LOAD) == (False, told)

    ros.robot("r_0", 0, 0, "--type", "beta")
    ros.robot("r_7", 4, 5, "--heading", 90, "--type", "zeta")
    both = {"r_0", "r_7"}
    rows = user.until(
        lambda rows: {row["robot"] for row in rows if row["position"]} == both, last="/system_monitor/robots"
    )
    row = next(row for row in rows if row["robot"] == "r_7")
    assert row.pop("heard_ago_s") < 2
    assert row == {
        "robot": "r_7",
        "available": True,
        "activity": "idle",
        "position": [4.0, 5.0, 0.0],
        "heading": pytest.approx(1.5708),
        "usage_m": 0.0,
    }
    assert user.do(last="/r_7/status")["position"] == [4.0, 5.0, 0.0]

    assert user.call("/mission_planner/plan")[0] is False
    user.do(set="/mission_planner/mission", to=NEAR.replace("position: [0, 0]", "position: [9, 0]"))
    told = "mission near: 2 of 2 tasks by 1 robots, r_0 from where they stand"
    assert user.call("/mission_planner/plan") == (True, told)
    plan = user.do(last="/mission_planner/plan")
    assert plan == {"mission": "near", "time_s": 0.0, "task_sequences": {"r_0": ["t_1", "t_2"]}}  # [9, 0] would turn it
    assert user.do(last="/r_0/task_sequence") == ["t_1", "t_2"]

    # the thesis' GrdTA or GrdGenTA (Table 5.1, 3): by a parameter, for who does not start the command
    user.do(set="/mission_planner/planning", to={"allocator": "greedy+genetic", "iterations": 3})
    assert user.call("/mission_planner/plan") == (True, told)
    user.do(set="/mission_planner/planning", to={"allocator": "greedi"})
    succeeded, message = user.call("/mission_planner/plan")
    assert (succeeded, "greedi" in message, "greedy" in message) == (False, True, True)
    user.do(set="/mission_planner/planning", to={"allocator": "greedy"})

    # a mission that names no robots is for those that are heard
    nobody = NEAR.replace(f"robots:\n  - {ROBOT}\n", "robots: []\n")
    for node in ("command_interface", "mission_planner"):
        user.do(set=f"/{node}/mission", to=nobody)
    told = "mission near: 2 of 2 tasks by 2 robots, r_0, r_7 from where they stand"
    assert user.call("/mission_planner/plan") == (True, told)
    assert user.call(LOAD) == (True, "mission near: 2 robots, 2 tasks; start begins it")

    # and so is a task list
    for node in ("command_interface", "mission_planner"):
        user.do(set=f"/{node}/mission", to="six.csv")
    user.do(set="/command_interface/suitability", to="types.csv")
    assert user.call(LOAD) == (True, "mission six: 2 robots, 3 tasks; start begins it")
    assert user.call("/mission_planner/plan")[0]
    assert "3" in user.do(last="/r_0/task_sequence")  # r_7's type does no E
    assert user.call(START)[0]
    out, err = carried.communicate(timeout=30)
    assert carried.returncode == 0, err
    assert set(json.loads(out)["tasks_done"]) == {"1", "2", "3"}


@pytest.mark.long
def test_a_node_that_dies_ends_the_whole(ros):
    (ros.folder / "far.yaml").write_text(FAR, encoding="utf-8")
    ros.robot("r_0", 0, 0)
    user = ros.user()
    heard = ros.listener("/r_0/cmd_vel=geometry_msgs/Twist")
    carried = ros.muster("far.yaml", *QUICK, "--quiet", "--stay")
    state_is(user, "carrying-out")
    time.sleep(0.5)
    children = family(carried)
    victim = next(pid for pid in children if "mission_planner" in Path(f"/proc/{pid}/cmdline").read_text())
    os.kill(victim, signal.SIGKILL)
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    assert own_words(err) == "node /mission_planner: it has ended (SIGKILL); expected it to stay\n"
    assert alive(children) == []
    twists = [data for _, data in heard.heard()]
    assert max(twist["linear"]["x"] for twist in twists) > 1
    assert twists[-1]["linear"]["x"] == 0


@pytest.mark.long
def test_ctrl_c_while_planning_leaves_nobody_behind(ros):
    tasks = [(f"t_{k}", k % 7, 3 * k % 11) for k in range(60)]
    (ros.folder / "long.yaml").write_text(mission("long", *tasks), encoding="utf-8")
    ros.robot("r_0", 0, 0)
    carried = ros.muster("long.yaml", "--time-limit", "60", "--quiet")
    user = ros.user()
    state_is(user, "planning")
    children = family(carried)
    ctrl_c(carried)
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (130, "")
    assert own_words(err) == "interrupted; the robots were told to stand\n"
    assert alive(children) == []
    assert gone(user)


def test_a_plan_without_a_mission_is_one_line(ros):
    carried = ros.muster("--plan", "p.json")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    assert err == "--plan given without a MISSION; expected both\n"
