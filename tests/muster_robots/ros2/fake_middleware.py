"""A wire of the tests, without a network: what robots say is appended, and what they are told is written down."""

import math

from muster.mission.errors import NetworkError
from muster_robots.navigation import Outcome
from muster_robots.ros2.message_types import (
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


class Heard(list):
    def take(self):
        taken = self[:]
        self.clear()
        return taken


class Middleware:
    """Readers by their topics, to which a test appends; what was told on topics. Time goes on by waiting alone."""

    def __init__(self):
        self.heard, self.told, self.now_s = {}, {}, 0.0

    def now(self):
        return self.now_s

    def reader(self, topic, _, latched=False):
        return self.heard.setdefault(topic, Heard())

    def others(self, topic, _):
        return self.heard.setdefault(topic, Heard())

    def writer(self, topic, _):
        return self.told.setdefault(topic, Told())

    def topics(self):
        return []

    def wait(self, seconds):
        self.now_s += seconds

    def close(self):
        pass


class Navigation(Heard):
    """Feedback is appended."""

    outcome = None

    def cancel(self):
        self.outcome = Outcome("canceled")


class Navigator:
    ready = True
    unfit = foreign = ""

    def __init__(self):
        self.given = []

    def go(self, goal):
        self.given.append((goal, Navigation()))
        return self.given[-1][1]


class Told(list):
    """Places of goals."""

    listeners = 1

    breaks = 0

    def write(self, goal):
        """The first ones may not get through."""
        if self.breaks:
            self.breaks -= 1
            raise NetworkError("timed out")
        self.append((goal.pose.position.x, goal.pose.position.y))


def pose(x, y=0.0, heading=0.0):
    return Pose(Point(x, y, 0.0), Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2)))


def posed(*at, frame="map"):
    return PoseStamped(Header(frame_id=frame), pose(*at))


def moved(*at, ahead=0.0, frame="odom"):
    twist = TwistWithCovariance(Twist(Vector3(ahead, 0.0, 0.0), Vector3()))
    return Odometry(Header(frame_id=frame), "base_link", PoseWithCovariance(pose(*at)), twist)
