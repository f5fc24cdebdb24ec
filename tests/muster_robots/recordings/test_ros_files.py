"""Records written for ROS, read by others: mcap-ros2-support, rosbags, Debian's rosbag."""

import json
import math
import shutil
import subprocess
from collections import Counter
from dataclasses import replace

import numpy as np
import pytest

from muster.mission.errors import MissingExtraError, ParameterError
from muster_robots.recordings import write_ros1, write_ros2
from muster_robots.recordings.ros_messages import ros_messages
from muster_robots.ros2.names import ros_name, ros_names

BEGINS = 1_700_000_000.0


@pytest.fixture(scope="module")
def ros2_file(recording, tmp_path_factory):
    file = tmp_path_factory.mktemp("ros2") / "flown.mcap"
    return file, write_ros2(file, recording, begins_s=BEGINS)


@pytest.fixture(scope="module")
def ros1_file(recording, tmp_path_factory):
    file = tmp_path_factory.mktemp("ros1") / "flown.bag"
    return file, write_ros1(file, recording, begins_s=BEGINS)


def read_ros2(file):
    reader = pytest.importorskip("mcap_ros2.reader")
    return [(m.channel.topic, m.log_time_ns * 1e-9, m.ros_msg) for m in reader.read_ros2_messages(str(file))]


def read_ros1(file):
    from rosbags.rosbag1 import Reader
    from rosbags.typesys import Stores, get_types_from_msg, get_typestore

    store = get_typestore(Stores.ROS1_NOETIC)
    store.register(get_types_from_msg("geometry_msgs/TransformStamped[] transforms", "tf2_msgs/msg/TFMessage"))
    with Reader(file) as reader:
        return [(c.topic, t * 1e-9, store.deserialize_ros1(d, c.msgtype)) for c, t, d in reader.messages()]


@pytest.fixture(scope="module", params=["ros1", "ros2"])
def messages(request, ros1_file, ros2_file):
    """What others read in both files, and how many messages of each topic were said to be there."""
    (file, counts), read = (ros1_file, read_ros1) if request.param == "ros1" else (ros2_file, read_ros2)
    return read(file), counts


def of(messages, topic):
    return [(time, message) for name, time, message in messages[0] if name == topic]


def test_every_message_is_there_in_the_order_of_time(messages):
    read, counts = messages
    assert Counter(topic for topic, _, _ in read) == counts
    assert [time for _, time, _ in read] == sorted(time for _, time, _ in read)


def test_poses_are_those_of_the_record(messages, recording):
    tracks = recording.tracks
    for k, robot in enumerate(tracks.robots):
        for (time, odom), (_, pose), now, place, heading, velocity in zip(
            of(messages, f"/{robot}/odom"),
            of(messages, f"/{robot}/pose"),
            tracks.times_s,
            tracks.positions[:, k],
            tracks.headings[:, k],
            tracks.velocities[:, k],
            strict=True,
        ):
            at, turn = odom.pose.pose.position, odom.pose.pose.orientation
            ahead = odom.twist.twist.linear
            assert time == pytest.approx(BEGINS + now, abs=1e-5)
            assert (at.x, at.y, at.z) == tuple(place)
            assert (odom.header.frame_id, odom.child_frame_id) == ("map", f"{robot}/base_link")
            assert 2 * math.atan2(turn.z, turn.w) == pytest.approx(heading)
            east = ahead.x * math.cos(heading) - ahead.y * math.sin(heading)
            assert east == pytest.approx(velocity[0], abs=1e-9)
            assert pose.pose.position.x == at.x


def test_transforms_are_of_all_robots(messages, recording):
    _, last = of(messages, "/tf")[-1]
    assert [one.child_frame_id for one in last.transforms] == ["r_0/base_link", "r_1/base_link"]
    moved = [(one.transform.translation.x, one.transform.translation.y) for one in last.transforms]
    assert moved == [tuple(place[:2]) for place in recording.tracks.positions[-1]]


def test_markers_are_replaced_by_number(messages, recording):
    arrays = of(messages, "/markers")
    first = arrays[0][1].markers
    ends = [k for k, event in enumerate(recording.events) if event.kind == "ends"]
    assert len({(marker.ns, marker.id) for marker in first}) == len(first)
    assert {marker.text for marker in first if marker.ns == "task" and marker.text} == {
        task.id for task in recording.mission.tasks
    }
    known = {(marker.ns, marker.id) for marker in first}
    assert len(arrays) > len(ends)
    assert all({(marker.ns, marker.id) for marker in array.markers} <= known for _, array in arrays)


def test_plans_and_events(messages, recording):
    (_, plan) = of(messages, "/r_0/plan")[0]
    line = recording.plans[0].lines["r_0"]
    assert [(pose.pose.position.x, pose.pose.position.y) for pose in plan.poses] == [tuple(p[:2]) for p in line]
    events = [json.loads(message.data) for _, message in of(messages, "/muster/event")]
    assert [(e["time_s"], e["kind"]) for e in events] == [(e.time_s, e.kind) for e in recording.events]


def test_schemas_and_profile_are_those_of_ros2(ros2_file):
    from mcap.reader import make_reader

    with ros2_file[0].open("rb") as stream:
        reader = make_reader(stream)
        summary = reader.get_summary()
        assert reader.get_header().profile == "ros2"
    assert {schema.encoding for schema in summary.schemas.values()} == {"ros2msg"}
    assert {channel.message_encoding for channel in summary.channels.values()} == {"cdr"}


@pytest.mark.long
@pytest.mark.skipif(shutil.which("rosbag") is None, reason="no rosbag (Debian: apt-get install python3-rosbag)")
def test_rosbag_of_debian_reads_it(ros1_file):
    file, counts = ros1_file
    told = subprocess.run(["rosbag", "info", "--yaml", str(file)], capture_output=True, text=True, check=True).stdout
    import yaml

    info = yaml.safe_load(told)
    assert info["version"] == 2.0
    assert {topic["topic"]: topic["messages"] for topic in info["topics"]} == counts
    assert subprocess.run(["rosbag", "check", str(file)], capture_output=True, check=False).returncode == 0


def test_a_robot_that_was_not_there_has_no_pose(recording):
    positions = recording.tracks.positions.copy()
    positions[:3, 0] = np.nan
    late = replace(recording, tracks=replace(recording.tracks, positions=positions))
    count = Counter(sent.topic for sent in ros_messages(late))
    assert count["/r_0/odom"] == count["/r_1/odom"] - 3 == len(positions) - 3


def test_names_that_ros_can_have():
    assert ros_names(["r_0", "a b", "7", "é"]) == {"r_0": "r_0", "a b": "a_b", "7": "r_7", "é": "r_"}
    assert ros_name("_x") == "r_x"
    with pytest.raises(ParameterError, match="'a b' and 'a-b': both are a_b in ROS"):
        ros_names(["a b", "a-b"])


def test_without_the_extra(recording, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, "rosbags.rosbag1", None)
    with pytest.raises(MissingExtraError, match=r"muster-robotics\[bags\]"):
        write_ros1("x.bag", recording)
