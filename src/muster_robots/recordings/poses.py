"""Poses in recordings that others made: MCAP of ROS 1 or ROS 2, a folder of rosbag2, a bag of ROS 1.

Of a recording those topics are read that say where something is: `PoseStamped`, `PoseWithCovarianceStamped`, `Odometry`
and, for each child frame a track of its own, `TFMessage`. A pose counts at the time of its header, or where that is 0
at the time of its recording. Poses are left in the frame in which they are told.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from muster.mission.errors import Finding, InputError, ParameterError
from muster.mission.system.extras import needs_extra
from muster.mission.values.arrays import Floats
from muster.report.record.reader import whole_records
from muster.report.record.writer import require_mcap
from muster_robots.ros2.description import Message
from muster_robots.ros2.message_types import (
    Header,
    Odometry,
    Point,
    PoseStamped,
    PoseWithCovarianceStamped,
    TFMessage,
    Vector3,
)
from muster_robots.ros2.serialization import from_cdr, from_ros1

_EXPECTED = "a recording of ROS with poses: MCAP, a folder of rosbag2, or a bag of ROS 1"
_MCAP, _BAG = b"\x89MCAP0\r\n", b"#ROSBAG V2.0"
_PACKED = (b"\x1f\x8b", b"BZh", b"\x28\xb5\x2f\xfd")
"""How files of gzip, bzip2 and zstd begin."""


@dataclass(frozen=True, eq=False)
class PoseTrack:
    """The track of one topic.

    Parameters
    ----------
    topic
        its name; of a transform with its child frame: `/tf:base_link`.
    kind
        of its messages, `package/Type`.
    frame
        the frame of its poses.
    times_s, positions
        (n,) seconds on the recording's clock, growing; (n, 3) metres.
    """

    topic: str
    kind: str
    frame: str
    times_s: Floats
    positions: Floats


@dataclass(frozen=True, eq=False)
class PoseRecording:
    """The tracks in a recording, by topic, and whether it is complete; else they end where it breaks off."""

    tracks: Mapping[str, PoseTrack]
    complete: bool


@dataclass(frozen=True)
class _Raw:
    topic: str
    kind: str
    time_ns: int
    data: bytes
    decode: Callable[..., Any]


def is_recording(path: str | Path) -> bool:
    """Whether a file or folder is a recording of ROS, not a record of Muster; False if it cannot be read."""
    file = Path(path)
    if file.is_dir():
        return True
    try:
        with file.open("rb") as stream:
            begin = stream.read(len(_BAG))
            if not begin.startswith(_MCAP):
                return begin == _BAG
            stream.seek(0)
            first = next(whole_records(stream, []), None)
    except OSError:
        return False
    return str(getattr(first, "profile", "")).startswith("ros")


def read_poses(path: str | Path) -> PoseRecording:
    """The tracks in a recording.

    Raises
    ------
    InputError
        if it cannot be read, or holds no poses.
    MissingExtraError
        if `record` (MCAP) or `bags` (rosbag2, ROS 1) is not installed.
    """
    file = Path(path)
    found: dict[str, list[tuple[float, Header, Point | Vector3]]] = {}
    kinds: dict[str, str] = {}
    ended: list[bool] = []
    try:
        for raw in _raw_messages(file, ended):
            for name, header, place in _places(raw.topic, raw.decode(_POSES[raw.kind], raw.data)):
                found.setdefault(name, []).append((header.stamp.seconds or raw.time_ns * 1e-9, header, place))
                kinds[name] = raw.kind
    except OSError as error:
        raise _refusal(file, error.strerror or str(error)) from None
    except ParameterError as error:
        raise _refusal(file, str(error)) from None
    tracks = {name: _track(name, kinds[name], told) for name, told in sorted(found.items())}
    finite = {name: track for name, track in tracks.items() if len(track.times_s)}
    if not finite:
        raise _refusal(file, "holds no poses")
    return PoseRecording(finite, bool(ended))


def _refusal(file: Path, value: str) -> InputError:
    return InputError([Finding(str(file), None, "", value, _EXPECTED)])


_POSES: Mapping[str, type[Message]] = {
    message.NAME: message for message in (PoseStamped, PoseWithCovarianceStamped, Odometry, TFMessage)
}


def _places(topic: str, message: Any) -> Iterator[tuple[str, Header, Point | Vector3]]:
    if isinstance(message, TFMessage):
        for one in message.transforms:
            yield f"{topic}:{one.child_frame_id.lstrip('/')}", one.header, one.transform.translation
    elif isinstance(message, PoseStamped):
        yield topic, message.header, message.pose.position
    else:
        yield topic, message.header, message.pose.pose.position


def _track(topic: str, kind: str, told: list[tuple[float, Header, Point | Vector3]]) -> PoseTrack:
    times = np.array([time for time, _, _ in told])
    positions = np.array([(place.x, place.y, place.z) for _, _, place in told])
    order = np.argsort(times, kind="stable")
    order = order[np.isfinite(positions[order]).all(axis=1)]
    return PoseTrack(topic, kind, told[0][1].frame_id.lstrip("/"), times[order], positions[order])


def _raw_messages(file: Path, ended: list[bool]) -> Iterator[_Raw]:
    """The messages with poses; `ended` gets an item if none is missing."""
    if file.is_dir():
        yield from _from_bag(file, "rosbag2", from_cdr)
        ended.append(True)
        return
    with file.open("rb") as stream:
        begin = stream.read(len(_BAG))
        if begin == _BAG:
            yield from _from_bag(file, "rosbag1", from_ros1)
            ended.append(True)
        elif begin.startswith(_MCAP):
            stream.seek(0)
            yield from _from_mcap(stream, ended)
        elif begin.startswith(_PACKED):
            raise ParameterError("packed as a whole, to be unpacked first")
        else:
            raise ParameterError("no recording")


def _from_mcap(stream: Any, ended: list[bool]) -> Iterator[_Raw]:
    require_mcap()
    from mcap.records import Channel, Message, Schema

    decoders = {"cdr": from_cdr, "ros1": from_ros1}
    schemas: dict[int, str] = {}
    channels: dict[int, tuple[str, str, Callable[..., Any]]] = {}
    for record in whole_records(stream, ended):
        if isinstance(record, Schema):
            schemas[record.id] = record.name.replace("/msg/", "/")
        elif isinstance(record, Channel) and record.message_encoding in decoders:
            kind = schemas.get(record.schema_id, "")
            if kind in _POSES:
                channels[record.id] = (record.topic, kind, decoders[record.message_encoding])
        elif isinstance(record, Message) and record.channel_id in channels:
            topic, kind, decode = channels[record.channel_id]
            yield _Raw(topic, kind, record.log_time, record.data, decode)


def _from_bag(path: Path, module: str, decode: Callable[..., Any]) -> Iterator[_Raw]:
    """Messages of a bag, found by rosbags and decoded here."""
    with needs_extra("bags", "a bag"):
        from rosbags import rosbag1, rosbag2
    room: Any = rosbag1 if module == "rosbag1" else rosbag2
    try:
        with room.Reader(path) as reader:
            wanted = [one for one in reader.connections if one.msgtype.replace("/msg/", "/") in _POSES]
            if not wanted:  # no choice would be all
                return
            for connection, time, data in reader.messages(connections=wanted):
                yield _Raw(connection.topic, connection.msgtype.replace("/msg/", "/"), time, bytes(data), decode)
    except OSError:
        raise
    except Exception as error:  # of damaged bags rosbags says what its own code met: assertions, keys, struct.error
        reason = str(error).rstrip(".").partition("\n")[0] or type(error).__name__
        mend = "; rosbag reindex mends bags that break off" if module == "rosbag1" else ""
        raise ParameterError(f"{reason}{mend}") from None
