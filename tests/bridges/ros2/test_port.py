"""The port of a robot on ROS 2, with the test's own time and wire: what it hears, and what it tells the robot."""

import math

import pytest

from muster.bridges.ros2.goals import Nav2Goals, PoseGoals
from muster.bridges.ros2.messages import (
    Header,
    Odometry,
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from muster.bridges.ros2.port import Arrival, Ros2Port
from muster.bridges.ros2.wire import Outcome
from muster.mission.model import Robot
from muster.motion.port import Waypoint


class Heard(list):
    def take(self):
        taken = self[:]
        self.clear()
        return taken


class Wire:
    """Readers by their topics, to which a test appends."""

    def __init__(self):
        self.heard = {}

    def reader(self, topic, _):
        return self.heard.setdefault(topic, Heard())


class Navigation(Heard):
    """Feedback is appended."""

    outcome = None

    def cancel(self):
        self.outcome = Outcome("canceled")


class Navigator:
    ready = True

    def __init__(self):
        self.given = []

    def go(self, goal):
        self.given.append((goal, Navigation()))
        return self.given[-1][1]


class Told(list):
    listeners = 1

    def write(self, goal):
        self.append((goal.pose.position.x, goal.pose.position.y))


def pose(x, y=0.0, heading=0.0):
    return Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)))


def posed(*at, frame="map"):
    return PoseStamped(Header(frame_id=frame), pose(*at))


def moved(*at, ahead=0.0):
    twist = TwistWithCovariance(Twist(Vector3(ahead, 0.0, 0.0), Vector3()))
    return Odometry(Header(frame_id="odom"), "base_link", PoseWithCovariance(pose(*at)), twist)


class There:
    """A port, and what the robot says on its topics."""

    def __init__(self, goals):
        wire = Wire()
        self.port = Ros2Port(Robot(id="r", position=(0.0, 0.0)), wire, "/r", goals, Arrival(), flat=True)
        self.poses, self.odometry = wire.heard["/r/pose"], wire.heard["/r/odom"]

    def hear(self, now):
        return self.port.hear(now)


@pytest.fixture
def navigator():
    return Navigator()


def test_nav2_with_odometry_only_is_heard_after_its_goal_and_holds_to_the_end(navigator):
    robot = There(Nav2Goals(navigator))
    robot.odometry.append(moved(0.0))
    robot.hear(0.0)
    robot.port.send([Waypoint((5.0, 0.0, 0.0), hold_s=8.0), Waypoint((5.0, 5.0, 0.0))])
    feedback = navigator.given[0][1]
    feedback.append(posed(4.9))
    robot.hear(1.0)
    feedback.outcome = Outcome("succeeded")
    for now in range(2, 12):
        robot.odometry.append(moved(4.9))
        robot.hear(float(now))
        assert robot.port.telemetry().time_s == now
        assert robot.port.telemetry().passed == (now >= 9)
    assert len(navigator.given) == 2


def test_a_hold_ends_by_time_where_nothing_is_heard_and_times_stand_still(navigator):
    robot = There(Nav2Goals(navigator))
    robot.odometry.append(moved(5.0))
    robot.hear(0.0)
    robot.port.send([Waypoint((5.0, 0.0, 0.0), hold_s=2.0)])
    navigator.given[0][1].outcome = Outcome("succeeded")
    assert not robot.hear(1.0)
    assert not robot.hear(2.9)
    assert robot.hear(3.0)
    said = robot.port.telemetry()
    assert (said.time_s, said.order, said.passed) == (0.0, 1, 1)


def test_where_poses_stop_odometry_goes_on_from_the_last(navigator):
    robot = There(Nav2Goals(navigator))
    robot.odometry.append(moved(10.0, 0.0, 0.0))
    robot.poses.append(posed(1.0, 2.0, math.pi / 2))
    robot.hear(0.0)
    robot.odometry.append(moved(10.5, 0.0, 0.0))
    robot.hear(0.5)
    assert robot.port.telemetry().position == (1.0, 2.0, 0.0)  # by its pose, of half a second ago
    robot.odometry.append(moved(12.0, 0.0, 0.0, ahead=1.0))
    robot.hear(2.0)
    said = robot.port.telemetry()
    assert said.position == pytest.approx((1.0, 4.0, 0.0))
    assert said.heading == pytest.approx(math.pi / 2)
    assert said.velocity == pytest.approx((0.0, 1.0, 0.0))
    robot.poses.append(posed(7.0, 7.0))
    robot.hear(2.1)
    assert robot.port.telemetry().position == (7.0, 7.0, 0.0)


def test_odometry_that_begins_after_the_pose_is_tied_to_it(navigator):
    robot = There(Nav2Goals(navigator))
    robot.poses.append(posed(1.0, 2.0))
    robot.hear(0.0)
    robot.odometry.append(moved(0.0))
    robot.hear(2.0)
    robot.odometry.append(moved(0.5))
    robot.hear(2.1)
    assert robot.port.telemetry().position == pytest.approx((1.5, 2.0, 0.0))


def test_poses_in_other_frames_and_such_as_are_none_do_not_count():
    robot = There(PoseGoals(Told()))
    robot.poses += [posed(9.0, frame="odom"), posed(math.nan)]
    robot.odometry += [moved(math.inf), moved(3.0)]
    robot.hear(0.0)
    assert robot.port.telemetry().position == (3.0, 0.0, 0.0)
