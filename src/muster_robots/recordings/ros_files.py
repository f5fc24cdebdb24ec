"""A record as files that the tools of ROS open: MCAP with messages of ROS 2, bags (v2.0) of ROS 1."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from muster.mission.system.extras import needs_extra
from muster.report.record import Recording
from muster.report.record.json_messages import nanoseconds
from muster.report.record.writer import require_mcap
from muster_robots.recordings.ros_messages import TimedMessage, ros_messages
from muster_robots.ros2.description import ROS1, ROS2, Message
from muster_robots.ros2.serialization import definition, md5_sum, to_cdr, to_ros1, type_name

_KEPT = ("/markers",)
"""Topics whose last message holds for who comes later: latched in ROS 1."""


def write_ros2(file: str | Path, recording: Recording, *, begins_s: float = 0.0) -> Mapping[str, int]:
    """Write an MCAP file of the profile `ros2`: schemas `ros2msg`, messages CDR.

    Parameters
    ----------
    begins_s
        what the mission's clock at 0 is on the file's clock, such as seconds since 1970.

    Returns
    -------
    How many messages each topic has.

    Raises
    ------
    MissingExtraError
        if the extra `record` is not installed.
    ParameterError
        if two robots have the same name in ROS.
    """
    require_mcap()
    from mcap.writer import Writer

    open_writer: Any = Writer
    sent = ros_messages(recording, begins_s)
    with Path(file).open("wb") as stream:
        writer = open_writer(stream)
        writer.start(profile="ros2", library="muster")
        schemas: dict[type[Message], int] = {}
        channels: dict[str, int] = {}
        counts: dict[str, int] = {}
        for one in sent:
            kind = type(one.message)
            if kind not in schemas:
                text = definition(kind, ROS2).encode()
                schemas[kind] = writer.register_schema(type_name(kind), "ros2msg", text)
            if one.topic not in channels:
                profiles = {"offered_qos_profiles": ""}  # which rosbag2 wants to be there
                channels[one.topic] = writer.register_channel(one.topic, "cdr", schemas[kind], profiles)
            time, counts[one.topic] = _time(one, begins_s), counts.get(one.topic, 0) + 1
            writer.add_message(channels[one.topic], time, to_cdr(one.message), time, counts[one.topic] - 1)
        writer.finish()
    return counts


def write_ros1(file: str | Path, recording: Recording, *, begins_s: float = 0.0) -> Mapping[str, int]:
    """Write a bag of ROS 1; as `write_ros2`, but that it needs the extra `bags`."""
    writer_of = _bag_writer()
    sent = ros_messages(recording, begins_s)
    Path(file).unlink(missing_ok=True)
    connections: dict[str, Any] = {}
    counts: dict[str, int] = {}
    with writer_of(Path(file)) as writer:
        for one in sent:
            if one.topic not in connections:
                connections[one.topic] = _connection(writer, one)
            writer.write(connections[one.topic], _time(one, begins_s), to_ros1(one.message))
            counts[one.topic] = counts.get(one.topic, 0) + 1
    return counts


def _connection(writer: Any, one: TimedMessage) -> Any:
    kind = type(one.message)
    return writer.add_connection(
        one.topic,
        type_name(kind),
        msgdef=definition(kind, ROS1),
        md5sum=md5_sum(kind),
        callerid="/muster",
        latching=int(one.topic in _KEPT),
    )


def _bag_writer() -> Any:
    with needs_extra("bags", "a bag of ROS 1"):
        from rosbags.rosbag1 import Writer
    return Writer


def _time(one: TimedMessage, begins_s: float) -> int:
    return nanoseconds(begins_s) + nanoseconds(one.time_s)
