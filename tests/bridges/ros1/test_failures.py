"""What becomes of robots and missions when programs around them end: the controller itself, the master, its node."""

import json
import signal
import time

import pytest
from tests.bridges.ros1.conftest import NODES

FAR = """
schema: muster/1
robots: [{id: r_0, position: [0, 0], speed_mps: 3, yaw_rate_radps: 6, radius_m: 0.2, kinematics: differential-drive}]
tasks: [{id: t_1, position: [6, 0]}, {id: t_2, position: [9, 0]}]
"""
QUICK = ("--time-limit", "0.2", "--format", "json")


@pytest.fixture
def far(tmp_path):
    (tmp_path / "m.yaml").write_text(FAR, encoding="utf-8")
    return "m.yaml"


def until_it_drives(carried):
    for line in carried.stderr:
        if "sets out" in line:
            return


def velocities(listener):
    return [data for topic, data in listener.so_far() if topic == "/r_0/cmd_vel"]


def test_a_master_that_is_started_anew_does_not_stop_a_mission(own_ros, far):
    own_ros.robot("r_0", 0, 0)
    user = own_ros.user()
    carried = own_ros.muster(far, *QUICK)
    user.until(NODES.issubset, nodes=True)  # one that begins without a master does not stay
    until_it_drives(carried)
    own_ros.master.stop()
    time.sleep(1.0)  # it is looked for meanwhile
    own_ros.master.start()
    out, err = carried.communicate(timeout=40)
    assert carried.returncode == 0, err
    assert json.loads(out)["tasks_done"] == ["t_1", "t_2"]
    assert "Traceback" not in err


def test_robots_stand_when_their_controller_ends_or_another_takes_its_place(ros):
    (ros.folder / "far.yaml").write_text(FAR.replace("[6, 0]", "[60, 0]").replace("[9, 0]", "[90, 0]"), "utf-8")
    ros.robot("r_0", 0, 0)
    listener = ros.listener("/r_0/cmd_vel=geometry_msgs/Twist", "/r_0/odom=nav_msgs/Odometry")

    # a second takes the place of the first, which ends with a line
    first = ros.muster("far.yaml", *QUICK, "--on-start")
    assert ros.user().call("/command_interface/start")[0]
    until_it_drives(first)
    second = ros.muster("far.yaml", *QUICK)
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
    third = ros.muster("far.yaml", *QUICK)
    until_it_drives(third)
    time.sleep(0.5)
    third.kill()
    time.sleep(1.5)
    speeds = [data["twist"]["twist"]["linear"]["x"] for topic, data in listener.heard() if topic == "/r_0/odom"]
    assert velocities(listener)[-1]["linear"]["x"] > 1
    assert speeds[-10:] == [0.0] * 10


def test_who_reports_while_its_node_says_goodbye_does_not_complain(ros):
    """Topics are closed for a while before `rospy.is_shutdown`, and long where the machine is busy."""
    monitor = ros.start(ros.file("slow_goodbye.py"))
    _, err = monitor.communicate(timeout=30)
    assert (monitor.returncode, err) == (0, "")
