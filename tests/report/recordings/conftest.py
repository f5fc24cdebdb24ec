"""A record of two robots, and a writer of recordings as others make them."""

from pathlib import Path

import numpy as np
import pytest
from tests.report.voyages import carry_out

import muster
from muster.bridges.ros2.cdr import to_cdr, to_ros1
from muster.bridges.ros2.description import ROS1, ROS2, definition, md5_sum, type_name
from muster.bridges.ros2.messages import Header, Odometry, Point, Pose, PoseStamped, PoseWithCovariance, Time
from muster.report.record import RecordWriter, read_record

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
    if form == "mcap":
        _write_mcap(file, told)
    elif form == "rosbag1":
        _write_bag1(file, told)
    else:
        _write_bag2(file, told, form)
    return Path(file)


def _write_mcap(file, told):
    from mcap.writer import Writer

    with Path(file).open("wb") as stream:
        writer = Writer(stream, chunk_size=50_000)
        writer.start(profile="ros2", library="others")
        channels = {}
        for topic, time, message in told:
            if topic not in channels:
                kind = type(message)
                schema = writer.register_schema(type_name(kind, ROS2), "ros2msg", definition(kind, ROS2).encode())
                channels[topic] = writer.register_channel(topic, "cdr", schema)
            writer.add_message(channels[topic], round(time * 1e9), to_cdr(message), round(time * 1e9))
        writer.finish()


def _write_bag1(file, told):
    from rosbags.rosbag1 import Writer

    with Writer(Path(file)) as writer:
        links = {}
        for topic, time, message in told:
            if topic not in links:
                kind = type(message)
                text, md5 = definition(kind, ROS1), md5_sum(kind)
                links[topic] = writer.add_connection(topic, type_name(kind, ROS2), msgdef=text, md5sum=md5)
            writer.write(links[topic], round(time * 1e9), to_ros1(message))


def _write_bag2(folder, told, form):
    from rosbags.rosbag2 import StoragePlugin, Writer
    from rosbags.typesys import Stores, get_typestore

    storage = StoragePlugin.MCAP if form == "rosbag2-mcap" else StoragePlugin.SQLITE3
    store = get_typestore(Stores.ROS2_HUMBLE)
    with Writer(Path(folder), version=9, storage_plugin=storage) as writer:
        links = {}
        for topic, time, message in told:
            if topic not in links:
                links[topic] = writer.add_connection(topic, type_name(type(message), ROS2), typestore=store)
            writer.write(links[topic], round(time * 1e9), to_cdr(message))


def told_of(recording, robot, topic, *, begins_s=0.0, off=(0.0, 0.0, 0.0), say=odometry):
    """What another recorded of a robot of a record, so far off."""
    column = recording.tracks.robots.index(robot)
    places = recording.tracks.positions[:, column] + np.array(off)
    return [
        (topic, begins_s + time, say(begins_s + time, place))
        for time, place in zip(recording.tracks.times_s, places, strict=True)
    ]
