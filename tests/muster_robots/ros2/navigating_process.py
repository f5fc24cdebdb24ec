"""A robot with navigation of its own, in a process, by cyclonedds alone: NAME X Y WORD...

It knows nothing of Muster: its types are written out from the definitions of ROS 2. Its odometry begins where it
starts, turned by a right angle (REP-105); it goes straight, 3 m/s.

`nav2=humble`, `jazzy`, `kilted`: it serves NavigateToPose as rmw_cyclonedds does, with the results of that version.
`goals`: it goes where goal_pose says. `tf`: it ties its odometry to the map on /tf; `own_tf`: on <robot>/tf, by frames
without prefix. `amcl`: it says amcl_pose once a second. `quiet`: it publishes no odometry. `body`: its body is on /tf.
`abort=X,Y`, `reject=X,Y`: what it does with goals there. `clock=TIMES`: it says /clock, so many times real time.
"""

# ruff: noqa: N801 - names of DDS

import cmath
import math
import os
import sys
import time
from collections import deque
from dataclasses import dataclass

from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float32, int8, int16, int32, int64, sequence, uint8, uint16, uint32, uint64
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic
from robot_process import (
    Header_,
    Odometry_,
    Point_,
    Pose_,
    PoseStamped_,
    PoseWithCovariance_,
    Quaternion_,
    Time_,
    Twist_,
    TwistWithCovariance_,
    Vector3_,
)

NAV2, ACTIONS, SPEED, DT = "nav2_msgs::action::dds_::NavigateToPose", "action_msgs::msg::dds_", 3.0, 0.02
ACCEPTED, EXECUTING, SUCCEEDED, CANCELED, ABORTED = 1, 2, 4, 5, 6


@dataclass
class PoseWithCovarianceStamped_(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovarianceStamped_"):
    header: Header_
    pose: PoseWithCovariance_


@dataclass
class Transform_(IdlStruct, typename="geometry_msgs::msg::dds_::Transform_"):
    translation: Vector3_
    rotation: Quaternion_


@dataclass
class TransformStamped_(IdlStruct, typename="geometry_msgs::msg::dds_::TransformStamped_"):
    header: Header_
    child_frame_id: str
    transform: Transform_


@dataclass
class TFMessage_(IdlStruct, typename="tf2_msgs::msg::dds_::TFMessage_"):
    transforms: sequence[TransformStamped_]


@dataclass
class Clock_(IdlStruct, typename="rosgraph_msgs::msg::dds_::Clock_"):
    clock: Time_


@dataclass
class UUID_(IdlStruct, typename="unique_identifier_msgs::msg::dds_::UUID_"):
    uuid: array[uint8, 16]


@dataclass
class GoalInfo_(IdlStruct, typename=f"{ACTIONS}::GoalInfo_"):
    goal_id: UUID_
    stamp: Time_


@dataclass
class GoalStatus_(IdlStruct, typename=f"{ACTIONS}::GoalStatus_"):
    goal_info: GoalInfo_
    status: int8


@dataclass
class GoalStatusArray_(IdlStruct, typename=f"{ACTIONS}::GoalStatusArray_"):
    status_list: sequence[GoalStatus_]


@dataclass
class Duration_(IdlStruct, typename="builtin_interfaces::msg::dds_::Duration_"):
    sec: int32
    nanosec: uint32


@dataclass
class Feedback_(IdlStruct, typename=f"{NAV2}_Feedback_"):
    current_pose: PoseStamped_
    navigation_time: Duration_
    estimated_time_remaining: Duration_
    number_of_recoveries: int16
    distance_remaining: float32


@dataclass
class FeedbackMessage_(IdlStruct, typename=f"{NAV2}_FeedbackMessage_"):
    goal_id: UUID_
    feedback: Feedback_


@dataclass
class Goal_(IdlStruct, typename=f"{NAV2}_Goal_"):
    pose: PoseStamped_
    behavior_tree: str


@dataclass
class RequestHeader(IdlStruct, typename="rmw::cdds_request_header_t"):
    guid: uint64
    seq: int64


@dataclass
class SendGoalRequest(IdlStruct, typename=f"{NAV2}_SendGoal_Request_"):
    header: RequestHeader
    goal_id: UUID_
    goal: Goal_


@dataclass
class SendGoalResponse(IdlStruct, typename=f"{NAV2}_SendGoal_Response_"):
    header: RequestHeader
    accepted: bool
    stamp: Time_


@dataclass
class GetResultRequest(IdlStruct, typename=f"{NAV2}_GetResult_Request_"):
    header: RequestHeader
    goal_id: UUID_


@dataclass
class Empty_(IdlStruct, typename="std_msgs::msg::dds_::Empty_"):
    structure_needs_at_least_one_member: uint8


@dataclass
class HumbleResult(IdlStruct, typename=f"{NAV2}_GetResult_Response_"):
    header: RequestHeader
    status: int8
    result: Empty_


@dataclass
class JazzyResult(IdlStruct, typename=f"{NAV2}_GetResult_Response_"):
    header: RequestHeader
    status: int8
    error_code: uint16


@dataclass
class KiltedResult(IdlStruct, typename=f"{NAV2}_GetResult_Response_"):
    header: RequestHeader
    status: int8
    error_code: uint16
    error_msg: str


@dataclass
class CancelRequest(IdlStruct, typename="action_msgs::srv::dds_::CancelGoal_Request_"):
    header: RequestHeader
    goal_info: GoalInfo_


@dataclass
class CancelResponse(IdlStruct, typename="action_msgs::srv::dds_::CancelGoal_Response_"):
    header: RequestHeader
    return_code: int8
    goals_canceling: sequence[GoalInfo_]


RESULTS = {
    "humble": (HumbleResult, lambda code, text: (Empty_(0),)),
    "jazzy": (JazzyResult, lambda code, text: (code,)),
    "kilted": (KiltedResult, lambda code, text: (code, text)),
}


class Wire:
    """Writers and readers of one participant, with the qualities of service of ROS 2."""

    def __init__(self):
        old, self._kept = Policy.DataRepresentation(use_cdrv0_representation=True), Policy.History.KeepLast(10)
        self._participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
        self._quality = Qos(old, Policy.Reliability.Reliable(10**8), self._kept)

    def writer(self, name, kind):
        return DataWriter(self._participant, Topic(self._participant, name, kind), qos=self._quality)

    def reader(self, name, kind):
        return DataReader(self._participant, Topic(self._participant, name, kind), qos=self._quality)


class Service:
    """One service, as rmw_cyclonedds has it: replies have the header of their requests."""

    def __init__(self, wire, name, request, response):
        self._requests, self._response = wire.reader(f"rq/{name}Request", request), response
        self._replies = wire.writer(f"rr/{name}Reply", response)

    def take(self):
        return self._requests.take(10)

    def reply(self, request, *values):
        self._replies.write(self._response(request.header, *values))


class Nav2:
    """The server of the action: a new goal preempts the one before, which ends as aborted."""

    def __init__(self, wire, name, version, abort, reject):
        action, (result, self._values) = f"{name}/navigate_to_pose/_action", RESULTS[version]
        self._sends = Service(wire, f"{action}/send_goal", SendGoalRequest, SendGoalResponse)
        self._results = Service(wire, f"{action}/get_result", GetResultRequest, result)
        self._cancels = Service(wire, f"{action}/cancel_goal", CancelRequest, CancelResponse)
        self._feedback = wire.writer(f"rt/{action}/feedback", FeedbackMessage_)
        self._states = wire.writer(f"rt/{action}/status", GoalStatusArray_)
        self._abort, self._reject, self._waiting, self._ended = abort, reject, [], {}
        self.goal = None  # its id and place

    def look(self, place):
        """Take requests; returns where the robot is to go."""
        for request in self._sends.take():
            assert request.goal.pose.header.frame_id == "map"
            at = (request.goal.pose.pose.position.x, request.goal.pose.pose.position.y)
            accepted = not near(at, self._reject)
            self._sends.reply(request, accepted, Time_(0, 0))
            if accepted:
                self._end(ABORTED, 1, "preempted")
                self.goal = bytes(request.goal_id.uuid), at
                self._say(EXECUTING)
        self._waiting += self._results.take()
        for request in self._cancels.take():
            own = self.goal is not None and bytes(request.goal_info.goal_id.uuid) == self.goal[0]
            self._cancels.reply(request, 0, [request.goal_info] if own else [])
            if own:
                self._end(CANCELED)
        if self.goal is not None:
            self._go_on(place)
        for request in [one for one in self._waiting if bytes(one.goal_id.uuid) in self._ended]:
            self._waiting.remove(request)
            status, *words = self._ended[bytes(request.goal_id.uuid)]
            self._results.reply(request, status, *self._values(*words))
        return None if self.goal is None else self.goal[1]

    def _go_on(self, place):
        if near(self.goal[1], self._abort):
            self._end(ABORTED, 9003, "no way")
        elif near(self.goal[1], place, 0.05):
            self._end(SUCCEEDED)
        else:
            nothing = Duration_(0, 0)
            said = Feedback_(stamped("map", *place, 0.0), nothing, nothing, 0, math.dist(place, self.goal[1]))
            self._feedback.write(FeedbackMessage_(UUID_(list(self.goal[0])), said))

    def _end(self, status, code=0, words=""):
        if self.goal is not None:
            self._ended[self.goal[0]] = status, code, words
            self._say(status)
            self.goal = None

    def _say(self, status):
        info = GoalInfo_(UUID_(list(self.goal[0])), Time_(0, 0))
        self._states.write(GoalStatusArray_([GoalStatus_(info, status)]))


def near(place, other, within=0.1):
    return other is not None and math.dist(place, other) < within


def turned(heading):
    return Quaternion_(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))


def stamped(frame, x, y, heading):
    return PoseStamped_(Header_(Time_(0, 0), frame), Pose_(Point_(x, y, 0.0), turned(heading)))


def link(parent, child, place, heading, now):
    header = Header_(Time_(int(now), int(now % 1 * 1e9)), parent)
    return TransformStamped_(header, child, Transform_(Vector3_(place.real, place.imag, 0.0), turned(heading)))


def point(text):
    return tuple(map(float, text.split(","))) if text else None


class Robot:
    """Where it is on the map, and where by its odometry, in the complex plane."""

    def __init__(self, wire, name, x, y, given):
        self._given, self._place, self._start = given, complex(x, y), complex(x, y)
        own = "own_tf" in given
        self._odom, self._body = ("odom", "base_link") if own else (f"{name}/odom", f"{name}/base_link")
        self._odometry = wire.writer(f"rt/{name}/odom", Odometry_)
        self._fixes = wire.writer(f"rt/{name}/amcl_pose", PoseWithCovarianceStamped_)
        self._tf = wire.writer(f"rt/{name}/tf" if own else "rt/tf", TFMessage_)
        self._turn, self._fixed_s = math.pi / 2, -math.inf

    @property
    def place(self):
        return self._place.real, self._place.imag

    def move(self, goal, seconds):
        """Go on to a goal, if there is one; returns how fast it was."""
        if goal is None:
            return 0.0
        rest = complex(*goal) - self._place
        step = min(abs(rest), SPEED * seconds)
        self._place += step * rest / abs(rest) if rest else 0
        return step / seconds

    def say(self, now, speed):
        there = (self._place - self._start) * cmath.rect(1.0, -self._turn)
        nothing = [0.0] * 36
        if "quiet" not in self._given:
            pose = PoseWithCovariance_(Pose_(Point_(there.real, there.imag, 0.0), turned(-self._turn)), nothing)
            twist = TwistWithCovariance_(Twist_(Vector3_(speed, 0.0, 0.0), Vector3_(0.0, 0.0, 0.0)), nothing)
            self._odometry.write(Odometry_(Header_(Time_(0, 0), self._odom), self._body, pose, twist))
        links = []
        if {"tf", "own_tf"} & set(self._given):
            links.append(link("map", self._odom, self._start, self._turn, now))
        if "body" in self._given:
            links.append(link(self._odom, self._body, there, -self._turn, now))
        if links:
            self._tf.write(TFMessage_(links))
        if "amcl" in self._given and now - self._fixed_s >= 1.0:
            self._fixed_s = now
            pose = PoseWithCovariance_(stamped("map", *self.place, 0.0).pose, nothing)
            self._fixes.write(PoseWithCovarianceStamped_(Header_(Time_(0, 0), "map"), pose))


def main(name, x, y, *words):
    given = dict(word.partition("=")[::2] for word in words)
    wire = Wire()
    robot = Robot(wire, name, float(x), float(y), given)
    served = (given.get("nav2", ""), point(given.get("abort")), point(given.get("reject")))
    nav2 = Nav2(wire, name, *served) if "nav2" in given else None
    goals = wire.reader(f"rt/{name}/goal_pose", PoseStamped_) if "goals" in given else None
    clock, times = wire.writer("rt/clock", Clock_) if "clock" in given else None, float(given.get("clock", 1))
    goal, begin = None, time.monotonic()
    while True:
        time.sleep(DT)
        now = 100.0 + times * (time.monotonic() - begin) if clock else time.time()
        if clock is not None:
            clock.write(Clock_(Time_(int(now), int(now % 1 * 1e9))))
        for sample in deque(goals.take(10) if goals is not None else [], maxlen=1):
            goal = sample.pose.position.x, sample.pose.position.y
        goal = nav2.look(robot.place) if nav2 is not None else goal
        robot.say(now, robot.move(goal, times * DT))


if __name__ == "__main__":
    main(*sys.argv[1:])
