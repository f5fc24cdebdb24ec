"""A record as messages of ROS: transforms, odometry, poses, plans, markers, events.

Frames by REP-105: `map`, and `<robot>/base_link` of each robot. A twist is in the frame of the body; it turns as fast
as its headings differ from moment to moment.
"""

from __future__ import annotations

import json
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from operator import attrgetter
from typing import Any

import numpy as np

from muster.motion.frames import enu_to_flu, wrapped
from muster.report.record import Recording
from muster.report.record import scene as scenes
from muster.report.record.json_messages import MAP_FRAME, body_frame, json_bytes
from muster.state import MissionState
from muster_robots.recordings.markers import Markers
from muster_robots.ros2.description import Message
from muster_robots.ros2.message_types import (
    Header,
    MarkerArray,
    Odometry,
    Path,
    Point,
    Pose,
    PoseStamped,
    PoseWithCovariance,
    Quaternion,
    String,
    TFMessage,
    Time,
    Transform,
    TransformStamped,
    Twist,
    TwistWithCovariance,
    Vector3,
)
from muster_robots.ros2.names import ros_names


@dataclass(frozen=True)
class TimedMessage:
    """A message with its topic and its time on the mission's clock."""

    topic: str
    time_s: float
    message: Message


def ros_messages(recording: Recording, begins_s: float = 0.0) -> list[TimedMessage]:
    """All messages of a record, in the order of time.

    Parameters
    ----------
    begins_s
        the time of the stamps' clock at which the mission's clock is 0.

    Raises
    ------
    ParameterError
        if two robots have the same name in ROS.
    """
    names = ros_names(recording.tracks.robots)
    told = [*_plans(recording, names, begins_s), *_events(recording, begins_s), *_steps(recording, names, begins_s)]
    return sorted(told, key=attrgetter("time_s"))


def _steps(recording: Recording, names: dict[str, str], begins_s: float) -> Iterator[TimedMessage]:
    tracks = recording.tracks
    turning = _yaw_rates(tracks.times_s, tracks.headings)
    for row, now in enumerate(tracks.times_s.tolist()):
        stamp, transforms = Time.of(begins_s + now), []
        header = Header(stamp=stamp, frame_id=MAP_FRAME)
        for k, robot in enumerate(tracks.robots):
            place, heading = tracks.positions[row, k], float(tracks.headings[row, k])
            if not np.isfinite(place).all():
                continue
            name, frame = names[robot], body_frame(names[robot])
            pose = Pose(Point(*place.tolist()), _turned(heading))
            velocity = enu_to_flu(tracks.velocities[row, k], heading).tolist()
            twist = Twist(Vector3(*velocity), Vector3(0.0, 0.0, float(turning[row, k])))
            odometry = Odometry(header, frame, PoseWithCovariance(pose), TwistWithCovariance(twist))
            yield TimedMessage(f"/{name}/odom", now, odometry)
            yield TimedMessage(f"/{name}/pose", now, PoseStamped(header, pose))
            moved = Transform(Vector3(*place.tolist()), pose.orientation)
            transforms.append(TransformStamped(header, frame, moved))
        yield TimedMessage("/tf", now, TFMessage(tuple(transforms)))


def _yaw_rates(times: Any, headings: Any) -> Any:
    """(m, n) rad/s: how headings differ from the moment before; 0 at first."""
    rates = np.zeros_like(headings)
    if len(times) > 1:
        rates[1:] = wrapped(np.diff(headings, axis=0)) / np.maximum(np.diff(times), 1e-9)[:, None]
    return np.nan_to_num(rates)


def _turned(heading: float) -> Quaternion:
    return Quaternion(0.0, 0.0, math.sin(heading / 2), math.cos(heading / 2))


def _plans(recording: Recording, names: dict[str, str], begins_s: float) -> Iterator[TimedMessage]:
    """The routes of each plan: `<robot>/plan`."""
    for version in recording.plans:
        header = Header(stamp=Time.of(begins_s + version.time_s), frame_id=MAP_FRAME)
        for robot, line in version.lines.items():
            poses = tuple(PoseStamped(header, Pose(Point(*_in_space(point)))) for point in line)
            yield TimedMessage(f"/{names[robot]}/plan", version.time_s, Path(header, poses))


def _in_space(point: Sequence[float]) -> Sequence[float]:
    return (*map(float, point), 0.0)[:3]


def _events(recording: Recording, begins_s: float) -> Iterator[TimedMessage]:
    """Each event as JSON, and the markers that it changes; first those of the beginning."""
    mission, mission_state = recording.mission, MissionState(recording.mission, forgets=False)
    markers = Markers(ros_names(recording.tracks.robots))
    tasks = [scenes.task_entity(0.0, task, mission_state.stage(task.id)) for task in mission.tasks]
    robots = [scenes.robot_entity(0.0, robot, k) for k, robot in enumerate(mission.robots)]
    first = markers.of([*scenes.map_entities(mission.map), *tasks, *robots], begins_s)
    yield TimedMessage("/markers", 0.0, MarkerArray(first))
    for event in recording.events:
        text = json.dumps({"time_s": event.time_s, "kind": event.kind, "data": json.loads(json_bytes(event.data))})
        yield TimedMessage("/muster/event", event.time_s, String(text))
        entities = scenes.changed_entities(0.0, mission_state, event)
        if entities:
            yield TimedMessage("/markers", event.time_s, MarkerArray(markers.of(entities, begins_s + event.time_s)))
