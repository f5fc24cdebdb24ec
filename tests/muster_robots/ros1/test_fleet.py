"""The fleet's parts where ROS fails, or says one thing and another: without a master, by stand-ins for rospy."""

import math
import threading
import time
from dataclasses import replace
from io import BytesIO
from types import SimpleNamespace

import pytest

from muster.mission.errors import NetworkError
from muster.mission.model import Map, Mission, Robot, Zone
from muster.motion.port import Waypoint
from muster_robots.fleet_settings import Ros1Settings
from muster_robots.steering import STILL

TEAM = tuple(Robot(id=f"r_{k}", position=(float(k), 0.0)) for k in range(3))


class Port:
    """Of a robot that is not there."""

    broken = missing = ""  # whose network fails; what is not there
    steerable = True

    def __init__(self, robot, topics, **_):
        self.body, self.robot, self.told = robot, robot.id, []

    def cancel(self):
        self._tell("cancel")

    def stand(self):
        self._tell("stand")

    def _tell(self, what):
        if self.robot == self.broken:
            raise OSError("no route to host")
        self.told.append(what)

    def steered(self, **_):
        if not self.steerable:
            raise ArithmeticError("steering is broken")

    def frames(self):
        return []

    def telemetry(self):
        return None

    def close(self):
        pass


@pytest.fixture
def fleet_of(rospy_there, monkeypatch):
    from muster_robots.ros1 import fleet

    silent = SimpleNamespace(publish=lambda _: None, unregister=lambda: None, close=lambda: None, name="map")
    monkeypatch.setattr(fleet, "rospy", SimpleNamespace(Publisher=lambda *_, **__: silent, is_shutdown=lambda: False))
    monkeypatch.setattr(fleet, "MapFrame", lambda _: silent)
    monkeypatch.setattr(fleet, "time_of_ros", lambda: time.monotonic)
    made = []

    def of(**port):
        monkeypatch.setattr(fleet, "Ros1Port", type("PortHere", (Port,), port))
        made.append(fleet.Ros1Fleet(Mission(robots=TEAM, tasks=()), Ros1Settings(known_only=True)))
        return made[-1]

    yield of
    for it in made:
        it.close()


def told(fleet):
    return {name: port.told for name, port in fleet.ports.items()}


def test_all_others_are_stopped_where_one_cannot_be_told(fleet_of):
    fleet = fleet_of(broken="r_1")
    with pytest.raises(NetworkError, match=r"not told to stand: r_1 \(no route to host\); expected"):
        fleet.stop()
    assert told(fleet) == {"r_0": ["cancel"], "r_1": [], "r_2": ["cancel"]}
    with pytest.raises(NetworkError, match="r_1"):
        fleet.pause()
    assert told(fleet) == {"r_0": ["cancel", "stand"], "r_1": [], "r_2": ["cancel", "stand"]}


def test_robots_stand_at_once_when_steering_fails_and_who_waits_for_poses_is_told(fleet_of):
    fleet = fleet_of(steerable=False, broken="r_1")
    until = time.monotonic() + 10
    while told(fleet)["r_2"] != ["stand"]:
        assert time.monotonic() < until
        time.sleep(0.01)
    assert told(fleet) == {"r_0": ["stand"], "r_1": [], "r_2": ["stand"]}
    with pytest.raises(ArithmeticError):
        fleet.robots_not_ready()
    with pytest.raises(ArithmeticError):
        fleet.advance(fleet.time_s + 0.1)


def test_a_robot_that_the_network_hid_is_met_later(rospy_there, monkeypatch):
    from muster_robots.ros1 import joining

    faults = [OSError("refused"), RuntimeError("fault of the master"), None]

    def robot_from_parameters(_, robot):
        fault = faults.pop(0)
        if fault is not None:
            raise fault
        return robot

    topics, said = [["/r_9/odom", "nav_msgs/Odometry"], ["/r_0/odom", "nav_msgs/Odometry"]], []
    monkeypatch.setattr(joining, "robot_from_parameters", robot_from_parameters)
    monkeypatch.setattr(joining.rospy, "get_published_topics", lambda: topics)

    def reach(robot):
        port = Port(robot, "")
        port.telemetry = lambda: SimpleNamespace(position=(4.0, 5.0, 0.0)) if said else None
        return port

    it = joining.Ros1Newcomers("", ["r_0"], reach, flat=True)
    assert [it.look() for _ in range(4)] == [[], [], [], []]
    assert faults == []  # asked for until that succeeded, and not again
    said.append("where it is")
    (port,) = it.look()
    assert port.body == Robot(id="r_9", position=(4.0, 5.0))
    assert it.look() == []


@pytest.fixture
def hear(rospy_there, monkeypatch):
    """By topics, what says a pose there, (x, frame), as if it came on the wire."""
    from muster_robots.ros1 import pose_listener
    from muster_robots.ros1.ros import Odometry, PoseStamped

    said = {}

    def subscriber(topic, _, callback, callback_args, **__):
        def say(x, name="map"):
            message = Odometry() if callback_args == "odom" else PoseStamped()
            pose = message.pose.pose if callback_args == "odom" else message.pose
            message.header.frame_id, pose.position.x, pose.orientation.w = name, x, 1.0
            buffer = BytesIO()
            message.serialize(buffer)
            header = {"type": message._type}
            callback(SimpleNamespace(_connection_header=header, _buff=buffer.getvalue()), callback_args)

        said[topic] = say

    monkeypatch.setattr(pose_listener.rospy, "Subscriber", subscriber)
    monkeypatch.setattr(pose_listener.rospy, "logwarn_throttle", lambda *_: None)  # a node's clock throttles it
    return said


def to_map(name, matrix):
    return None if name == "lost" else matrix


FRAME = SimpleNamespace(
    name="map", to_map=to_map, watch=lambda *_: None, untied=lambda topic, frame: f"{topic} is in frame {frame}"
)


def test_who_is_localised_goes_by_odometry_until_such_a_pose_counts(hear, monkeypatch):
    from muster_robots.ros1 import system_monitor

    monkeypatch.setattr(system_monitor, "_READ_S", 0.0)
    robot = system_monitor.WatchedRobot("/r_0", FRAME)

    def say(topic, x, name="map"):
        hear[f"/r_0/{topic}"](x, name)
        return robot.place[0]

    assert say("odom", 1.0) == 1.0
    assert say("pose", 7.0, "lost") == 1.0
    assert say("odom", 2.0) == 2.0  # the monitor and the fleet alike: nothing ties that pose to the map
    assert say("pose", math.nan) == 2.0
    assert say("odom", 3.0) == 3.0
    assert say("pose", 8.0) == 8.0
    assert say("odom", 4.0) == 8.0
    assert say("pose", 9.0) == 9.0
    assert robot.odometer.metres == pytest.approx(8.0)


class Told(list):
    """Places of goals, or velocities, and how many listen."""

    listeners = 1


@pytest.fixture
def port_of(hear, monkeypatch):
    """A port by its drive, and what it says: places of goals, or velocities."""
    from muster_robots.ros1 import orders, port
    from muster_robots.ros1.clock import MissionClock

    def of(drive):
        told = Told()
        stats = SimpleNamespace(
            get_stats_info=lambda: [(1, "/robot", "o", "TCPROS", "/r_0", True, "")] * told.listeners
        )
        publisher = SimpleNamespace(publish=told.append, get_num_connections=lambda: told.listeners, impl=stats)
        monkeypatch.setattr(orders.rospy, "Publisher", lambda *_, **__: publisher)
        monkeypatch.setattr(orders, "hear", lambda *_, **__: None)  # goals of others
        monkeypatch.setattr(orders, "pose_stamped", lambda _, place, __: place[:2])
        monkeypatch.setattr(orders, "twist_of", lambda velocity: velocity)
        own = {"frame": FRAME, "flat": True, "arrival_m": 0.1, "lock": threading.RLock(), "on_pass": lambda: None}
        return port.Ros1Port(TEAM[0], "/r_0", drive=drive, clock=MissionClock(), **own), told

    return of


def test_who_has_a_pose_that_counts_for_nothing_is_missing_that(port_of, hear):
    port, _ = port_of("cmd_vel")
    assert port.missing == "nothing on /r_0/odom or /r_0/pose or /r_0/amcl_pose"
    hear["/r_0/odom"](1.0, "lost")
    assert port.missing == "/r_0/odom is in frame lost"
    hear["/r_0/odom"](1.0)
    assert port.missing == ""


@pytest.mark.parametrize(
    ("drive", "topic"),
    [
        ("cmd_vel", "cmd_vel (geometry_msgs/Twist)"),
        ("goals", "WP (geometry_msgs/PoseStamped)"),
        ("move_base_simple", "move_base_simple/goal (geometry_msgs/PoseStamped)"),
    ],
)
def test_whose_orders_nobody_receives_counts_as_silent_until_somebody_does(port_of, hear, caplog, drive, topic):
    port, told = port_of(drive)
    hear["/r_0/odom"](0.0)
    assert port.missing == ""
    told.listeners = 0
    lost_s = port.telemetry().time_s
    hear["/r_0/odom"](1.0)
    said = port.telemetry()
    assert said.time_s == lost_s  # its time stands still
    assert said.position[0] == 1.0  # its place does not
    missing = f"nobody receives its orders; expected a subscriber of /r_0/{topic}"
    assert port.missing == missing
    assert [record.getMessage() for record in caplog.records] == [f"robot r_0: {missing}; it counts as silent"]
    told.listeners = 1
    assert port.telemetry().time_s > lost_s


def test_simple_goals_are_said_when_they_change_and_not_again(port_of, hear):
    port, told = port_of("move_base_simple")
    hear["/r_0/odom"](0.0)
    port.send([Waypoint((1.0, 0.0, 0.0)), Waypoint((1.0, 2.0, 0.0))])
    for _ in range(3):
        port.speak(port.steered(within_s=9, paused=False), STILL)
    hear["/r_0/odom"](1.0)
    for _ in range(3):
        port.speak(port.steered(within_s=9, paused=False), STILL)
    assert told == [(1.0, 0.0), (1.0, 2.0)]


@pytest.mark.parametrize("drive", ["cmd_vel", "goals"])
def test_who_was_never_sent_anywhere_is_not_even_told_to_stand(port_of, hear, drive):
    port, told = port_of(drive)
    hear["/r_0/odom"](0.0)
    port.stand()
    port.cancel()
    port.speak(port.steered(within_s=9, paused=False), STILL)
    assert told == []
    port.send([Waypoint((1.0, 0.0, 0.0))])
    port.stand()
    assert told == [STILL if drive == "cmd_vel" else (0.0, 0.0)]


def test_who_has_made_room_by_goals_stands_where_that_ends(port_of, hear):
    port, told = port_of("goals")

    def speak(**aim):
        del told[:]
        port.speak(replace(port.steered(within_s=9, paused=False), **aim), STILL)
        return list(told)

    hear["/r_0/odom"](0.0)
    port.send([Waypoint((1.0, 0.0, 0.0))])
    assert speak() == [(1.0, 0.0)]
    hear["/r_0/odom"](1.0)
    assert speak() == []  # there
    assert speak(aim=Waypoint((1.0, 2.0, 0.0))) == [(1.0, 2.0)]
    hear["/r_0/odom"](5.0)  # pushed: it makes room no more
    assert speak() == [(5.0, 0.0)]
    assert speak() == []


def test_who_makes_room_does_not_go_through_walls(rospy_there):
    from muster_robots.ros1.fleet import _free_ways

    wall = Zone(polygon=((4.9, 0.0), (5.1, 0.0), (5.1, 8.0), (4.9, 8.0)))
    arena = ((0.0, 0.0), (10.0, 0.0), (10.0, 10.0), (0.0, 10.0))
    body = Robot(id="r", position=(4.0, 4.0), radius_m=0.3)
    may_go = _free_ways(Mission(map=Map(boundary=arena, zones=(wall,)), robots=(body,), tasks=()))
    assert may_go(body, (4.0, 4.0, 0.0), (3.0, 4.0, 0.0))
    assert not may_go(body, (4.0, 4.0, 0.0), (6.0, 4.0, 0.0))  # both ends are free
    assert not may_go(body, (6.0, 4.0, 0.0), (4.0, 4.0, 0.0))
    assert may_go(body, (4.0, 9.0, 0.0), (6.0, 9.0, 0.0))  # beyond its end
    assert not may_go(body, (4.0, 4.0, 0.0), (4.7, 4.0, 0.0))  # no room for the body
    assert not may_go(body, (1.0, 1.0, 0.0), (-1.0, 1.0, 0.0))
