"""Robots with navigation of their own on ROS 2 over DDS: processes with types of their own (`navigating_process`)."""

import json
import time
from pathlib import Path

import pytest

from muster.cli.main import run
from muster.mission.model import Mission, Robot
from muster.motion.port import Waypoint

pytest.importorskip("cyclonedds")

from muster_robots.fleet_settings import Ros2Settings
from muster_robots.ros2 import dds_actions
from muster_robots.ros2.action_message_types import GetResultReply, words_of
from muster_robots.ros2.dds import DdsMiddleware
from muster_robots.ros2.dds_endpoints import Endpoint
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.message_types import Header, Point, Pose, PoseStamped, Quaternion

pytestmark = pytest.mark.usefixtures("loopback")
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
QUICK = ("--by", "dds", "--time-limit", "0.3", "--format", "json")


@pytest.fixture
def mission(tmp_path):
    (tmp_path / "m.yaml").write_text(MISSION, encoding="utf-8")
    return str(tmp_path / "m.yaml")


@pytest.fixture
def robot(start):
    """Starts robots: `robot("r_0", 0, 0, "nav2=jazzy")`."""

    def started(name, x, y, *words):
        return start(Path(__file__).with_name("navigating_process.py"), name, x, y, *words)

    return started


@pytest.fixture
def fleet_of():
    """A fleet of r_0 by its settings, once nothing is missing; closed with the test."""
    made = []

    def of(**settings):
        there = Mission(robots=(Robot(id="r_0", position=(0.0, 0.0)),), tasks=())
        made.append(Ros2Fleet(there, Ros2Settings(by="dds", known_only=True, **settings)))
        until(made[-1], lambda: not made[-1].robots_not_ready())
        return made[-1]

    yield of
    for fleet in made:
        fleet.close()


def wait_for_topics(*names):
    listens, end = DdsMiddleware(), time.monotonic() + 20.0
    while not set(names) <= {topic for topic, _ in listens.topics()}:
        assert time.monotonic() < end, "this did not come about"
        listens.wait(0.05)
    listens.close()


def until(fleet, true, most_s=30.0):
    end = time.monotonic() + most_s
    while not true():
        assert time.monotonic() < end, "this did not come about"
        fleet.advance(fleet.time_s + 0.05)


@pytest.mark.long
@pytest.mark.parametrize(
    ("version", "says"),
    [
        ("jazzy", "aborted (error 9003)"),
        pytest.param("humble", "aborted", marks=pytest.mark.long),
        pytest.param("kilted", "aborted (no way)", marks=pytest.mark.long),
    ],
)
def test_a_goal_is_reached_and_one_that_is_aborted_or_rejected_is_refused_with_its_words(
    robot, fleet_of, version, says
):
    robot("r_0", 0, 0, f"nav2={version}", "tf", "abort=2,2", "reject=3,3")
    fleet = fleet_of(profile="nav2")
    port = fleet.ports["r_0"]
    port.send([Waypoint((1.0, 0.0, 0.0)), Waypoint((1.0, 1.0, 0.0))])
    until(fleet, lambda: port.telemetry().passed == 2)
    for place, refused in (((2.0, 2.0, 0.0), says), ((3.0, 3.0, 0.0), "rejected")):
        order = port.send([Waypoint(place)])
        until(fleet, lambda order=order: port.telemetry().order == order and port.telemetry().refused)
        assert port.telemetry().refused == f"navigate_to_pose: {refused}"
    port.send([Waypoint((0.0, 0.0, 0.0))])  # the robot goes on to what it can reach
    until(fleet, lambda: port.telemetry().passed == 1)


def test_a_goal_of_another_client_takes_the_robot_until_it_is_there(robot, fleet_of, monkeypatch):
    """The other client is a fleet whose goals have ids of their own."""
    robot("r_0", 0, 0, "nav2=jazzy", "tf")
    fleet = fleet_of(profile="nav2")
    port = fleet.ports["r_0"]
    port.send([Waypoint((100.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().position[0] > 1.0)
    other = DdsMiddleware()
    navigator = other.navigator("/r_0/navigate_to_pose")
    until(fleet, lambda: other.wait(0.01) or navigator.ready)
    monkeypatch.setattr(dds_actions, "_OWN", b"rviz2")
    theirs = navigator.go(
        PoseStamped(Header(frame_id="map"), Pose(Point(0.0, 6.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0)))
    )
    monkeypatch.undo()
    until(fleet, lambda: other.wait(0.01) or port.telemetry().suspended)
    assert f"navigate_to_pose has goal {theirs._id.uuid.hex()}, which is not Muster's" in port.telemetry().suspended
    until(fleet, lambda: other.wait(0.01) or theirs.outcome is not None)
    assert theirs.outcome.status == "succeeded"
    port.send([Waypoint((2.0, 0.0, 0.0))])
    until(fleet, lambda: not port.telemetry().suspended)
    until(fleet, lambda: port.telemetry().passed == 1)
    other.close()


def test_a_fleet_that_has_heard_the_goals_of_others_receives_none_when_it_is_closed(fleet_of, robot):
    robot("r_0", 0, 0, "goals", "tf")
    fleet = fleet_of()
    other = DdsMiddleware()
    says = other.writer("/r_0/goal_pose", PoseStamped)
    until(fleet, lambda: says.listeners == 2)
    fleet.close()
    end = time.monotonic() + 10.0
    while says.listeners > 1:
        assert time.monotonic() < end, "this did not come about"
        other.wait(0.05)
    other.close()


def test_a_goal_of_another_station_on_goal_pose_takes_the_robot_until_it_has_stood(robot, fleet_of):
    robot("r_0", 0, 0, "goals", "tf")
    fleet = fleet_of()
    port = fleet.ports["r_0"]
    port.send([Waypoint((60.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().position[0] > 1.0)
    assert not port.telemetry().suspended  # its own goal is none of others
    other = DdsMiddleware()
    says = other.writer("/r_0/goal_pose", PoseStamped)
    until(fleet, lambda: says.listeners == 2)
    place = Pose(Point(0.0, 4.0, 0.0), Quaternion(0.0, 0.0, 0.0, 1.0))
    says.write(PoseStamped(Header(frame_id="map"), place))
    until(fleet, lambda: port.telemetry().suspended)
    assert port.telemetry().suspended == "another station: a goal on /r_0/goal_pose is not Muster's"
    until(fleet, lambda: not port.telemetry().suspended)
    assert port.telemetry().position[:2] == pytest.approx((0.0, 4.0), abs=0.1)
    other.close()


def test_a_goal_that_is_cancelled_ends_and_the_robot_stays(robot, fleet_of):
    robot("r_0", 0, 0, "nav2=jazzy", "tf")
    fleet = fleet_of(profile="nav2")
    port = fleet.ports["r_0"]
    port.send([Waypoint((100.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().position[0] > 1.0)
    port.cancel()
    until(fleet, lambda: port.at_rest)
    stands = port.telemetry().position
    before = port.telemetry().time_s
    until(fleet, lambda: port.telemetry().time_s > before + 0.3)
    assert port.telemetry().position == pytest.approx(stands, abs=0.2)


@pytest.mark.long
def test_a_goal_is_given_to_the_server_that_comes_in_place_of_one_that_was_killed(robot, fleet_of):
    server = robot("r_0", 0, 0, "nav2=humble", "tf")
    fleet = fleet_of(profile="nav2")
    port = fleet.ports["r_0"]
    port.send([Waypoint((30.0, 0.0, 0.0))])
    until(fleet, lambda: port.telemetry().position[0] > 1.0)
    server.kill()
    server.wait()
    robot("r_0", 25, 0, "nav2=jazzy", "tf")  # another version: types are those of the server that is there
    until(fleet, lambda: port.telemetry().passed == 1, 60.0)


@pytest.mark.parametrize(
    "words",
    [
        ("tf",),
        ("own_tf", "body", "quiet"),
        *(pytest.param(some, marks=pytest.mark.long) for some in (("own_tf",), ("amcl",), ("amcl", "quiet"))),
        pytest.param(("tf", "body", "quiet"), marks=pytest.mark.long),
    ],
    ids=" ".join,
)
def test_a_robot_is_where_tf_or_its_localisation_says(robot, fleet_of, words):
    """Its odometry begins where it starts, turned by a right angle."""
    robot("r_0", 3, 4, "goals", *words)
    fleet = fleet_of(profile="amcl")
    port = fleet.ports["r_0"]
    assert port.telemetry().position == pytest.approx((3.0, 4.0, 0.0))
    assert port.telemetry().heading == pytest.approx(0.0, abs=1e-6)
    port.send([Waypoint((5.0, 4.0, 0.0))])
    until(fleet, lambda: port.telemetry().passed == 1)
    assert port.telemetry().position == pytest.approx((5.0, 4.0, 0.0), abs=0.3)


def test_odometry_begins_at_the_start_of_the_mission_where_that_is_said(robot, fleet_of):
    robot("r_0", 3, 4, "goals")
    fleet = fleet_of(odometry="start")
    assert fleet.ports["r_0"].telemetry().position == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)


def test_a_mission_goes_by_a_simulators_clock(robot, fleet_of):
    robot("r_0", 0, 0, "goals", "tf", "clock=4")
    fleet = fleet_of(use_sim_time=True)
    begin, real = fleet.time_s, time.monotonic()
    until(fleet, lambda: fleet.time_s > begin + 4.0)
    assert fleet.simulated_time
    assert time.monotonic() - real < 4.0


def test_without_a_clock_it_is_one_line(robot, mission, capsys):
    robot("r_0", 0, 0, "goals", "tf")
    assert run(["ros2", mission, *QUICK, "--use-sim-time", "--wait", "0.3"]) == 2
    said = "robot r_0: use_sim_time is set, and nothing is on /clock within 0.3 s (and 1 more); expected a simulator\n"
    assert capsys.readouterr().err == said


@pytest.mark.long
@pytest.mark.parametrize(
    ("profile", "expected"),
    [
        ("amcl", "a subscriber of /r_1/goal_pose (geometry_msgs/PoseStamped)"),
        ("nav2", "an action server of /r_1/navigate_to_pose (nav2_msgs/NavigateToPose)"),
    ],
)
def test_a_robot_whose_orders_nobody_receives_is_named_before_the_mission_begins(
    robot, mission, capsys, caplog, profile, expected
):
    robot("r_0", 0, 0, "goals", "nav2=jazzy", "tf")
    robot("r_1", 0, 3, "tf")
    wait_for_topics("/r_0/odom", "/r_1/odom")
    assert run(["ros2", mission, *QUICK, "--profile", profile, "--wait", "6"]) == 2
    assert capsys.readouterr().err == f"robot r_1: nobody receives its orders within 6 s; expected {expected}\n"
    named = [record.getMessage() for record in caplog.records if record.name == "muster.running.live"]
    assert f"robot r_1: nobody receives its orders; expected {expected}; it is waited for up to 6 s" in named


def test_a_server_on_another_make_of_dds_is_named_and_not_called(robot, monkeypatch):
    robot("r_0", 0, 0, "nav2=jazzy", "tf")
    monkeypatch.setattr(Endpoint, "is_cyclone", property(lambda self: False))
    there = Mission(robots=(Robot(id="r_0", position=(0.0, 0.0)),), tasks=())
    fleet = Ros2Fleet(there, Ros2Settings(by="dds", profile="nav2"))
    until(fleet, lambda: "another make" in fleet.robots_not_ready().get("r_0", ""))
    said = fleet.robots_not_ready()["r_0"]
    assert said.endswith("expected RMW_IMPLEMENTATION=rmw_cyclonedds_cpp on the robot, or --by rclpy")
    assert not fleet.ports["r_0"].goals.ready
    fleet.close()


@pytest.mark.parametrize(
    ("reply", "words"),
    [
        (b"\4\0", ""),
        (b"\6\0\0\0", ""),
        (b"\6\0\x2b\x23", "error 9003"),
        (b"\6\0\x2b\x23\7\0\0\0no way\0\0", "no way"),
        (b"\6\0\0\0\1\0\0\0\0", ""),
    ],
)
def test_the_words_of_a_result_are_those_of_its_version(reply, words):
    header = b"\0\1\0\0" + bytes(16)
    assert words_of(header + reply) == words
    assert GetResultReply.NAME.endswith("_GetResult_Response")


@pytest.mark.long
@pytest.mark.parametrize("tf", ["tf", "own_tf"])
def test_two_robots_do_all_tasks_and_what_one_is_refused_the_other_does(robot, start, mission, tf):
    robot("r_0", 0, 0, "nav2=humble", tf, "amcl", "abort=8,3")
    robot("r_1", 0, 3, "nav2=jazzy", tf, "amcl")
    out, err = start("-m", "muster.cli", "ros2", mission, *QUICK, "--profile", "nav2").communicate(timeout=60)
    assert set(json.loads(out)["tasks_done"]) == TASKS, err
    assert {row["task"]: row["robot"] for row in json.loads(out)["tasks"]}["t_3"] == "r_1"


@pytest.mark.long
def test_what_a_robot_was_to_do_is_done_by_the_other_once_nobody_receives_its_orders(robot, start, mission, tmp_path):
    """Its poses go on, from another process: its navigation alone is killed, and comes back in vain: it is too late."""
    robot("r_0", 0, 0, "nav2=humble", "tf")
    server = robot("r_1", 0, 3, "nav2=jazzy", "quiet")
    robot("r_1", 0, 3, "tf")
    carried = start("-m", "muster.cli", "ros2", mission, *QUICK, "--profile", "nav2")
    told = []
    for line in carried.stderr:
        told.append(line)
        if "r_1 sets out" in line:
            server.kill()
            break
    out, rest = carried.communicate(timeout=90)
    said = "".join(told) + rest
    assert set(json.loads(out)["tasks_done"]) == TASKS, said
    assert {row["robot"] for row in json.loads(out)["tasks"]} == {"r_0"}
    assert "robot r_1: nobody receives its orders; expected an action server" in said
    assert "it counts as silent" in said
