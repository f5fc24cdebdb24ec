"""What becomes of robots and missions when programs around them end: the controller itself, the master, its node."""

import json
import signal
import time
from contextlib import ExitStack

import pytest
from tests.muster_robots.ros1.conftest import NODES, alive, family, ros_in

FAR = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}]
tasks: [{id: t_1, position: [6, 0]}, {id: t_2, position: [9, 0]}]
"""
VERY_FAR = FAR.replace("[6, 0]", "[60, 0]").replace("[9, 0]", "[90, 0]")
QUICK = ("--time-limit", "0.2", "--format", "json")


def until_it_drives(carried):
    for line in carried.stderr:
        if "sets out" in line:
            return


def under_way(stack, folder, mission):
    """A master of its own, a robot that drives, and what carries the mission out there."""
    folder.mkdir()
    (folder / "m.yaml").write_text(mission, encoding="utf-8")
    ros = stack.enter_context(ros_in(folder))
    robot, user, carried = ros.robot("r_0", 0, 0), ros.user(), ros.muster("m.yaml", *QUICK)
    user.until(NODES.issubset, nodes=True)  # one that begins without a master does not stay
    until_it_drives(carried)
    return ros, robot, carried


def velocities(listener):
    return [data for topic, data in listener.so_far() if topic == "/r_0/cmd_vel"]


@pytest.mark.long
def test_masters_that_go_away_end_the_whole_and_one_that_is_started_anew_does_not(rospy_there, tmp_path):
    """One hangs, one refuses connections, one is back in time: each under a mission of its own, for each takes long."""
    with ExitStack() as stack:
        lost = []
        for end in (signal.SIGSTOP, signal.SIGKILL):
            ros, robot, carried = under_way(stack, tmp_path / end.name, VERY_FAR)
            lost.append((ros, robot, carried, family(carried)))
            ros.master.send_signal(end)
        ros, _, carried = under_way(stack, tmp_path / "anew", FAR)
        ros.master.stop()
        time.sleep(1.0)  # it is looked for meanwhile
        ros.master.start()
        out, err = carried.communicate(timeout=40)
        assert carried.returncode == 0, err
        assert json.loads(out)["tasks_done"] == ["t_1", "t_2"]
        assert "Traceback" not in err
        for ros, robot, carried, children in lost:
            out, err = carried.communicate(timeout=30)
            assert (carried.returncode, out) == (2, "")
            line = f"ROS master: {ros.master.address}: no answer for 5 s; expected it to stay"
            assert line in err.splitlines()  # beside it rospy may say a word of its own, and robots how they stand
            assert alive(children) == []
            assert robot.poll() is None


@pytest.mark.long
def test_robots_stand_when_their_controller_ends_or_another_takes_its_place(ros):
    (ros.folder / "far.yaml").write_text(VERY_FAR, "utf-8")
    ros.robot("r_0", 0, 0)
    listener = ros.listener("/r_0/cmd_vel=geometry_msgs/Twist", "/r_0/odom=nav_msgs/Odometry")

    # a second takes the place of the first, which ends with a line
    first = ros.muster("far.yaml", *QUICK, "--on-start")
    user = ros.user()
    user.until(lambda status: status["state"] == "waiting", last="/muster/status")
    assert user.call("/command_interface/start")[0]
    until_it_drives(first)
    second = ros.muster("far.yaml", *QUICK, "--resume")
    _, err = first.communicate(timeout=20)
    assert first.returncode == 2
    assert err.splitlines()[-1].startswith("node /muster: it was shut down, or another took its name; ")
    assert "muster/cli" not in err  # no traceback of the program; rospy may say what it met in its threads

    # the second is interrupted, and tells robots to stand
    until_it_drives(second)
    before = len(velocities(listener))
    time.sleep(0.5)
    second.send_signal(signal.SIGINT)
    _, err = second.communicate(timeout=20)
    assert second.returncode == 130, err
    told = velocities(listener)[before:]
    assert max(twist["linear"]["x"] for twist in told) > 1
    assert not any((*told[-1]["linear"].values(), *told[-1]["angular"].values()))

    # the third is killed; robots stand when they have heard nothing for a while
    third = ros.muster("far.yaml", *QUICK, "--resume")
    until_it_drives(third)
    time.sleep(0.5)
    third.kill()
    time.sleep(1.5)
    speeds = [data["twist"]["twist"]["linear"]["x"] for topic, data in listener.heard() if topic == "/r_0/odom"]
    assert velocities(listener)[-1]["linear"]["x"] > 1
    assert speeds[-10:] == [0.0] * 10


@pytest.mark.long
def test_who_reports_while_its_node_says_goodbye_does_not_complain(ros):
    """Topics are closed for a while before `rospy.is_shutdown`, and long where the machine is busy."""
    monitor = ros.start(ros.file("slow_goodbye.py"))
    _, err = monitor.communicate(timeout=30)
    assert (monitor.returncode, err) == (0, "")
