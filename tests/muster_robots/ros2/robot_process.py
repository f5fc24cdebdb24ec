"""A robot in a process of its own, by cyclonedds alone: goes straight to its goal, and publishes its pose.

Its types are written out here, so that they are not those of the bridge: `python robot_process.py NAME X Y SAYS`.
At SIGUSR1 somebody pushes it by `PUSHED_M`: it goes on from there.
"""

# ruff: noqa: N801 - names of DDS

import math
import os
import signal
import sys
import time
from dataclasses import dataclass

from cyclonedds.domain import DomainParticipant
from cyclonedds.idl import IdlStruct
from cyclonedds.idl.types import array, float64, int32, uint32
from cyclonedds.pub import DataWriter
from cyclonedds.qos import Policy, Qos
from cyclonedds.sub import DataReader
from cyclonedds.topic import Topic


@dataclass
class Time_(IdlStruct, typename="builtin_interfaces::msg::dds_::Time_"):
    sec: int32
    nanosec: uint32


@dataclass
class Header_(IdlStruct, typename="std_msgs::msg::dds_::Header_"):
    stamp: Time_
    frame_id: str


@dataclass
class Point_(IdlStruct, typename="geometry_msgs::msg::dds_::Point_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Quaternion_(IdlStruct, typename="geometry_msgs::msg::dds_::Quaternion_"):
    x: float64
    y: float64
    z: float64
    w: float64


@dataclass
class Vector3_(IdlStruct, typename="geometry_msgs::msg::dds_::Vector3_"):
    x: float64
    y: float64
    z: float64


@dataclass
class Pose_(IdlStruct, typename="geometry_msgs::msg::dds_::Pose_"):
    position: Point_
    orientation: Quaternion_


@dataclass
class PoseStamped_(IdlStruct, typename="geometry_msgs::msg::dds_::PoseStamped_"):
    header: Header_
    pose: Pose_


@dataclass
class PoseWithCovariance_(IdlStruct, typename="geometry_msgs::msg::dds_::PoseWithCovariance_"):
    pose: Pose_
    covariance: array[float64, 36]


@dataclass
class Twist_(IdlStruct, typename="geometry_msgs::msg::dds_::Twist_"):
    linear: Vector3_
    angular: Vector3_


@dataclass
class TwistWithCovariance_(IdlStruct, typename="geometry_msgs::msg::dds_::TwistWithCovariance_"):
    twist: Twist_
    covariance: array[float64, 36]


@dataclass
class Odometry_(IdlStruct, typename="nav_msgs::msg::dds_::Odometry_"):
    header: Header_
    child_frame_id: str
    pose: PoseWithCovariance_
    twist: TwistWithCovariance_


PUSHED_M = -1.5, 2.0


def main(name, x, y, says):
    quality = Qos(Policy.DataRepresentation(use_cdrv0_representation=True), Policy.Reliability.Reliable(10**8))
    participant = DomainParticipant(int(os.environ["ROS_DOMAIN_ID"]))
    goals = DataReader(participant, Topic(participant, f"rt/{name}/goal_pose", PoseStamped_), qos=quality)
    kind = PoseStamped_ if says == "pose" else Odometry_
    told = DataWriter(participant, Topic(participant, f"rt/{name}/{says}", kind), qos=quality)
    place, goal, speed, dt = [float(x), float(y)], None, 4.0, 0.02
    still, nothing = Vector3_(0.0, 0.0, 0.0), [0.0] * 36
    pushes = []
    signal.signal(signal.SIGUSR1, lambda *_: pushes.append(PUSHED_M))
    while True:
        for sample in goals.take(10):
            assert sample.header.frame_id == "map"
            goal = (sample.pose.position.x, sample.pose.position.y)
        while pushes:
            place = [c + by for c, by in zip(place, pushes.pop(), strict=True)]
        moved = 0.0
        if goal is not None:
            rest = math.dist(place, goal)
            moved = min(rest, speed * dt)
            if rest > 0:
                place = [here + (there - here) * moved / rest for here, there in zip(place, goal, strict=True)]
        header = Header_(Time_(0, 0), "map")
        pose = Pose_(Point_(*place, 0.0), Quaternion_(0.0, 0.0, 0.0, 1.0))
        if says == "pose":
            told.write(PoseStamped_(header, pose))
        else:
            twist = Twist_(Vector3_(moved / dt, 0.0, 0.0), still)
            unsure = PoseWithCovariance_(pose, nothing), TwistWithCovariance_(twist, nothing)
            told.write(Odometry_(header, name, *unsure))
        time.sleep(dt)


if __name__ == "__main__":
    main(*sys.argv[1:])
