"""`muster ros2` over DDS: simulated robots, and the command, as processes of their own, on this computer alone."""

import json
import os
import signal
import sys
import threading
import time

import pytest
from tests.muster_robots.ros2 import fake_rclpy

from muster.cli.main import run

pytest.importorskip("cyclonedds")

from muster_robots.ros2.dds import DdsMiddleware
from muster_robots.ros2.message_types import (
    Header,
    Odometry,
    PoseStamped,
    TFMessage,
    Time,
    Transform,
    TransformStamped,
    Vector3,
)

pytestmark = pytest.mark.usefixtures("loopback")
MISSION = """
schema: muster/1
robots:
  - {id: r_0, position: [0, 0], speed_mps: 3, radius_m: 0.2}
  - {id: r-1, position: [0, 3], speed_mps: 3, radius_m: 0.2}
tasks:
  - {id: t_1, position: [4, 0]}
  - {id: t_2, position: [8, 0], duration_s: 1}
  - {id: t_3, position: [8, 3], prerequisites: [t_1]}
  - {id: t_4, position: [4, 3]}
  - {id: t_5, position: [4, 6], duration_s: 1}
  - {id: t_6, position: [8, 6], prerequisites: [t_5]}
"""
TASKS = {f"t_{k}" for k in range(1, 7)}
QUICK = ("--by", "dds", "--time-limit", "0.3", "--format", "json")


@pytest.fixture
def mission(tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION, encoding="utf-8")
    return str(tmp_path / "m.yaml")


def newest(participant, reader):
    """The last of what was heard since it was last asked for."""
    until = time.monotonic() + 10
    while not (taken := reader.take()):
        assert time.monotonic() < until
        participant.wait(0.05)
    return taken[-1].pose.pose.position


@pytest.mark.long
def test_robots_of_a_namespace_carry_a_mission_out_one_joins_and_one_that_dies_is_planned_for(
    simulated, start, mission, tmp_path
):
    team = ("--namespace", "team")
    simulated("r_0", 0, 0, *team)
    killed = simulated("r_1", 0, 3, *team)
    record = tmp_path / "r.mcap"
    carried = start("-m", "muster.cli", "ros2", mission, *QUICK, *team, "--record", record)
    told = []
    for line in carried.stderr:
        told.append(line)
        if "r-1 sets out" in line:
            killed.kill()  # in the middle of its way
            break
    simulated("r_2", 8, 8, *team)
    out, rest = carried.communicate(timeout=40)
    assert carried.returncode == 4, rest  # r-1 may go on to its last goal
    ends = rest.splitlines()[-3:]
    assert [line.split(";")[0].split(" for")[0] for line in ends] == [
        "r_0: stands",
        "r-1: not answering",
        "r_2: stands",
    ]
    report = json.loads(out)
    assert set(report["tasks_done"]) == TASKS
    assert {row["robot"] for row in report["tasks"]} <= {"r_0", "r_2"}
    said = "".join(told) + rest
    assert "r-1" in next(line for line in said.splitlines() if "is not heard any more" in line)
    assert "r_2" in next(line for line in said.splitlines() if "joins" in line)
    assert record.stat().st_size > 0


@pytest.mark.long
def test_a_mission_that_was_killed_goes_on_and_robots_are_brought_home(simulated, start, mission):
    simulated("r_0", 0, 0)
    simulated("r_1", 0, 3)
    killed = start("-m", "muster.cli", "ros2", mission, *QUICK)
    done = []
    for line in killed.stderr:
        done += [line.split()[-1]] if "has done task" in line else []
        if len(done) == 2:
            break
    killed.kill()
    killed.communicate(timeout=20)

    refused = start("-m", "muster.cli", "ros2", mission, *QUICK)
    _, err = refused.communicate(timeout=40)
    assert refused.returncode in (2, 4), err  # they may still drive to their last goals
    assert "did not end (2 tasks done), and has left r_0: " in err

    resumed = start("-m", "muster.cli", "ros2", mission, *QUICK, "--resume")
    out, err = resumed.communicate(timeout=60)
    assert resumed.returncode == 0, err
    assert set(json.loads(out)["tasks_done"]) == TASKS
    assert not any(f"sets out for task {task}\n" in err for task in done)

    home = start("-m", "muster.cli", "ros2", mission, *QUICK, "--recover")
    out, err = home.communicate(timeout=60)
    assert home.returncode == 0, err
    assert json.loads(out)["not_home"] == {}
    listens = DdsMiddleware()
    places = {name: newest(listens, listens.reader(f"/{name}/odom", Odometry)) for name in ("r_0", "r_1")}
    listens.close()
    assert (places["r_0"].x, places["r_0"].y) == pytest.approx((0.0, 0.0), abs=0.5)
    assert (places["r_1"].x, places["r_1"].y) == pytest.approx((0.0, 3.0), abs=0.5)


@pytest.mark.long
def test_ctrl_c_lets_robots_stay_where_they_are(simulated, start, mission):
    simulated("r_0", 0, 0)
    simulated("r_1", 0, 3)
    carried = start("-m", "muster.cli", "ros2", mission, *QUICK)
    for line in carried.stderr:
        if "r_0 sets out" in line:
            break
    time.sleep(0.5)
    carried.send_signal(signal.SIGINT)
    _, err = carried.communicate(timeout=20)
    assert carried.returncode == 130
    assert "told to stay where they are" in err
    listens = DdsMiddleware()
    heard = listens.reader("/r_0/odom", Odometry)
    time.sleep(1.0)  # by when they stand
    before = newest(listens, heard)
    listens.wait(0.5)
    after = newest(listens, heard)
    assert (before.x, before.y) == pytest.approx((after.x, after.y), abs=0.01)
    assert 0.1 < after.x < 7.9  # of 8 m and more
    listens.close()


def test_what_is_published_is_known_until_its_publisher_leaves():
    one, other = DdsMiddleware(), DdsMiddleware()
    writers = [one.writer("/there/pose", PoseStamped), one.writer("/there/odom", Odometry)]
    known = {("/there/pose", "geometry_msgs/PoseStamped"), ("/there/odom", "nav_msgs/Odometry")}
    until = time.monotonic() + 10

    def wait_for(what):
        while {found for found in other.topics() if found[0].startswith("/there")} != what:
            assert time.monotonic() < until
            other.wait(0.05)

    wait_for(known)
    del writers
    one.close()
    wait_for(set())
    other.close()


@pytest.mark.long
def test_a_simulated_robot_in_no_domain_is_one_line(start):
    out, err = start("-m", "muster_robots.ros2.simulated_participant", "r_0", "--domain", "300").communicate(timeout=20)
    assert (out, err) == ("", "domain: '300'; expected a number from 0 to 232\n")


@pytest.mark.long
def test_what_is_missing_is_one_line(start, mission):
    carried = start("-m", "muster.cli", "ros2", mission, *QUICK, "--wait", "0.3")
    out, err = carried.communicate(timeout=20)
    assert (carried.returncode, out) == (2, "")
    nothing = "nothing on /r_0/pose or /r_0/odom or /r_0/amcl_pose"
    assert err == f"robot r_0: {nothing} within 0.3 s (and 1 more); expected its pose\n"


@pytest.mark.parametrize(
    ("options", "said"),
    [
        (("--domain", "300"), "domain: 300; expected a whole number of at least 0, at most 232"),
        (("--profile", "move_base"), 'profile: "move_base"; expected nav2 or amcl or mocap'),
    ],
)
def test_bad_options_are_one_line(mission, options, said, capsys):
    assert run(["ros2", mission, *QUICK, *options]) == 2
    err = capsys.readouterr().err
    assert err.startswith(said)
    assert err.count("\n") == 1


def test_without_the_extra_it_is_one_line(mission, monkeypatch, capsys):
    monkeypatch.setitem(sys.modules, "cyclonedds", None)
    assert run(["ros2", mission, *QUICK]) == 2
    assert capsys.readouterr().err == "ROS 2 by DDS needs an optional part: pip install 'muster-robotics[ros2]'\n"


def test_two_robots_of_one_name_are_one_line(mission, tmp_path, capsys):
    (tmp_path / "m.yaml").write_text(MISSION.replace("r_0", "r.1"), encoding="utf-8")
    assert run(["ros2", mission, *QUICK]) == 2
    assert capsys.readouterr().err == "robots 'r.1' and 'r-1': both are r_1 in ROS; expected other ids\n"


def test_nav2_carries_a_mission_out_by_the_command(mission, monkeypatch, capsys):
    graph = fake_rclpy.install(monkeypatch)
    for name, y in (("r_0", 0.0), ("r_1", 3.0)):
        fake_rclpy.Nav2(graph, name, (0.0, y), speed=1.0)
    assert run(["ros2", mission, "--give", "nav2", "--time-limit", "0.3", "--format", "json", "-q"]) == 0
    assert set(json.loads(capsys.readouterr().out)["tasks_done"]) == TASKS


def test_without_nav2_it_says_so(mission, monkeypatch, capsys):
    graph = fake_rclpy.install(monkeypatch)
    fake_rclpy.Nav2(graph, "r_0", (0.0, 0.0))
    fake_rclpy.Nav2(graph, "r_1", (0.0, 3.0))
    del graph.servers["/r_1/navigate_to_pose"]
    assert run(["ros2", mission, "--give", "nav2", "--wait", "0.2"]) == 2
    expected = "an action server of /r_1/navigate_to_pose (nav2_msgs/NavigateToPose)"
    said = f"robot r-1: nobody receives its orders within 0.2 s; expected {expected}\n"
    assert capsys.readouterr().err == said


@pytest.fixture
def odometry(loopback):
    """Robots that say again and again that they are at (0, 0) of a frame; what tf says; goals that they get."""
    robots, over = DdsMiddleware(), threading.Event()
    tf = robots.writer("/tf", TFMessage)
    goals = {name: robots.reader(f"/{name}/goal_pose", PoseStamped) for name in ("r_0", "r_1")}
    says = []

    def speak():
        writers = {name: robots.writer(f"/{name}/odom", Odometry) for name in goals}
        while not over.wait(0.05):
            for name, frame, place in says:
                writers[name].write(Odometry(Header(frame_id=frame)))
                if place is not None:
                    header = Header(stamp=Time(1, 0), frame_id="map")
                    tf.write(TFMessage((TransformStamped(header, frame, Transform(Vector3(*place, 0.0))),)))

    speaker = threading.Thread(target=speak)
    speaker.start()
    yield says, goals
    over.set()
    speaker.join()
    robots.close()


def test_robots_in_a_frame_that_nothing_ties_to_the_map_are_refused_and_sent_nowhere(odometry, mission, capsys, caplog):
    says, goals = odometry
    says += [("r_0", "map", None), ("r_1", "r_1/odom", None)]
    assert run(["ros2", mission, *QUICK, "--wait", "2"]) == 2
    where = "robot r-1: /r_1/odom is in frame r_1/odom, which tf does not tie to map"
    expected = "tf from map to r_1/odom, or a pose in map, or --odometry start"
    assert capsys.readouterr().err == f"{where} within 2 s; expected {expected}\n"
    (named,) = [record.getMessage() for record in caplog.records if record.name == "muster.running.live"]
    assert named == f"{where}; expected {expected}; it is waited for up to 2 s"
    assert [reader.take() for reader in goals.values()] == [[], []]


def test_robots_are_where_tf_says_that_their_odometry_begins(odometry, mission, capsys):
    says, goals = odometry
    says += [("r_0", "r_0/odom", (1.0, 0.0)), ("r_1", "r_1/odom", (0.0, 4.5))]

    def end_when_a_goal_was_sent():
        while not any(reader.take() for reader in goals.values()):
            time.sleep(0.05)
        os.kill(os.getpid(), signal.SIGINT)

    ends = threading.Thread(target=end_when_a_goal_was_sent, daemon=True)
    ends.start()
    assert run(["ros2", mission, *QUICK, "--wait", "30"]) == 130
    said = capsys.readouterr().err
    assert "robot r_0 begins at (1.00, 0.00), where it stands, not at (0.00, 0.00)" in said
    assert "robot r-1 begins at (0.00, 4.50), where it stands, not at (0.00, 3.00)" in said
