"""A record of two robots, and a writer of recordings as others make them."""

from pathlib import Path

import numpy as np
import pytest
from tests.report.voyages import carry_out

import muster
from muster.report.record import RecordWriter, read_record
from muster_robots.ros2.description import ROS1, ROS2
from muster_robots.ros2.message_types import Header, Odometry, Point, Pose, PoseStamped, PoseWithCovariance, Time
from muster_robots.ros2.serialization import definition, md5_sum, to_cdr, to_ros1, type_name

pytest.importorskip("mcap")
pytest.importorskip("rosbags")


@pytest.fixture(scope="session")
def record_file(tmp_path_factory):
    """The record of a mission of two robots."""
    file = tmp_path_factory.mktemp("recordings") / "r.mcap"
    mission = muster.load("11T-2R")
    with RecordWriter(file, mission, rate_hz=5) as writer:
        carry_out(mission, muster.solve(mission, "greedy"), writer)
    return file


@pytest.fixture(scope="session")
def recording(record_file):
    return read_record(record_file)


def odometry(time, place, frame="odom"):
    pose = PoseWithCovariance(Pose(Point(*map(float, place))))
    return Odometry(Header(stamp=Time.of(time), frame_id=frame), "base_link", pose)


def pose(time, place, frame="map"):
    return PoseStamped(Header(stamp=Time.of(time), frame_id=frame), Pose(Point(*map(float, place))))


def write(form, file, told):
    """Write (topic, seconds, message) as a recording, by the writers of others."""
    kind, _, packed = form.partition("-")
    {"mcap": _write_mcap, "rosbag1": _write_bag1, "rosbag2": _write_bag2}[kind](file, told, packed)
    return Path(file)


def _write_mcap(file, told, packed):
    from mcap.writer import CompressionType, Writer

    ros, encoding, to_bytes = (ROS1, "ros1", to_ros1) if packed == "ros1" else (ROS2, "cdr", to_cdr)
    compression = {"plain": CompressionType.NONE, "lz4": CompressionType.LZ4}.get(packed, CompressionType.ZSTD)
    with Path(file).open("wb") as stream:
        writer = Writer(stream, chunk_size=50_000, compression=compression)
        writer.start(profile="ros1" if packed == "ros1" else "ros2", library="others")
        channels = {}
        for topic, time, message in told:
            if topic not in channels:
                kind = type(message)
                text = definition(kind, ros).encode()
                schema = writer.register_schema(type_name(kind), "ros1msg" if packed == "ros1" else "ros2msg", text)
                channels[topic] = writer.register_channel(topic, encoding, schema)
            writer.add_message(channels[topic], round(time * 1e9), to_bytes(message), round(time * 1e9))
        writer.finish()


def _write_bag1(file, told, packed):
    from rosbags.rosbag1 import Writer

    writer = Writer(Path(file))
    if packed:
        writer.set_compression(Writer.CompressionFormat[packed.upper()])
    with writer:
        links = {}
        for topic, time, message in told:
            if topic not in links:
                kind = type(message)
                text, md5 = definition(kind, ROS1), md5_sum(kind)
                links[topic] = writer.add_connection(topic, type_name(kind), msgdef=text, md5sum=md5)
            writer.write(links[topic], round(time * 1e9), to_ros1(message))


def _write_bag2(folder, told, packed):
    from rosbags.rosbag2 import CompressionFormat, CompressionMode, StoragePlugin, Writer
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    storage = StoragePlugin.MCAP if packed == "mcap" else StoragePlugin.SQLITE3
    store = get_typestore(Stores.ROS2_HUMBLE)
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
    writer = Writer(Path(folder), version=9, storage_plugin=storage)
    if packed in ("file", "message"):
        writer.set_compression(CompressionMode[packed.upper()], CompressionFormat.ZSTD)
    with writer:
        links = {}
        for topic, time, message in told:
            if topic not in links:
                links[topic] = writer.add_connection(topic, type_name(type(message)), typestore=store)
            writer.write(links[topic], round(time * 1e9), to_cdr(message))


def told_of(recording, robot, topic, *, begins_s=0.0, off=(0.0, 0.0, 0.0), say=odometry):
    """What another recorded of a robot of a record, so far off."""
    column = recording.tracks.robots.index(robot)
    places = recording.tracks.positions[:, column] + np.array(off)
    return [
        (topic, begins_s + time, say(begins_s + time, place))
        for time, place in zip(recording.tracks.times_s, places, strict=True)
    ]
