"""Recordings that others made, and how far a record is from them."""

import bz2
import gzip
from dataclasses import replace

import numpy as np
import pytest
from tests.muster_robots.recordings.conftest import odometry, pose, told_of, write

from muster.mission.errors import InputError, ParameterError
from muster.mission.model import Map
from muster.motion.grid import Grid
from muster_robots.recordings import Reference, deviations, is_recording, read_poses
from muster_robots.ros2.message_types import Header, String, TFMessage, Time, Transform, TransformStamped, Vector3

FORMS = ("mcap", "mcap-ros1", "rosbag1", "rosbag2", "rosbag2-mcap")
PACKED = ("mcap-plain", "mcap-lz4", "rosbag1-bz2", "rosbag1-lz4", "rosbag2-file", "rosbag2-message")
BEGINS = 1_600_000_000.0


@pytest.mark.parametrize("form", [*FORMS, *PACKED])
def test_poses_of_every_kind_are_read(form, tmp_path):
    header = Header(stamp=Time.of(5.0), frame_id="/map")
    moved = TransformStamped(header, "/base_link", Transform(Vector3(7.0, 8.0, 9.0)))
    told = [
        ("/robot/odom", 5.0, odometry(4.5, (1, 2, 3))),
        ("/robot/odom", 6.0, odometry(0.0, (2, 2, 3))),
        ("/pose", 5.0, pose(5.25, (4, 5, 6))),
        ("/words", 5.0, String("nothing")),
        ("/tf", 5.0, TFMessage((moved,))),
    ]
    file = write(form, tmp_path / "others", told)
    tracks = read_poses(file).tracks
    assert is_recording(file)
    assert set(tracks) == {"/pose", "/robot/odom", "/tf:base_link"}
    assert tracks["/robot/odom"].times_s.tolist() == [4.5, 6.0]  # a header without time: when it was recorded
    assert tracks["/robot/odom"].positions.tolist() == [[1, 2, 3], [2, 2, 3]]
    assert tracks["/robot/odom"].frame == "odom"
    assert tracks["/pose"].times_s.tolist() == [5.25]
    assert tracks["/tf:base_link"].positions.tolist() == [[7, 8, 9]]
    assert tracks["/tf:base_link"].frame == "map"


@pytest.mark.long
def test_a_recording_that_breaks_off_is_read_as_far_as_it_is_whole(tmp_path):
    file = write("mcap", tmp_path / "r", [("/pose", k * 0.1, pose(k * 0.1, (k, 0, 0))) for k in range(9000)])
    file.write_bytes(file.read_bytes()[: -(file.stat().st_size // 3)])
    found = read_poses(file)
    assert not found.complete
    assert 0 < len(found.tracks["/pose"].times_s) < 9000


@pytest.mark.parametrize("form", FORMS)
def test_poses_are_in_the_order_of_their_headers(form, tmp_path):
    stamps = (5.0, 3.0, 4.0, 1.0)
    told = [("/pose", 10.0 + k, pose(stamp, (k, 0, 0))) for k, stamp in enumerate(stamps)]
    track = read_poses(write(form, tmp_path / "r", told)).tracks["/pose"]
    assert track.times_s.tolist() == [1, 3, 4, 5]
    assert track.positions[:, 0].tolist() == [3, 1, 2, 0]


@pytest.mark.parametrize("form", FORMS)
def test_a_recording_of_nothing(form, tmp_path):
    file = write(form, tmp_path / "r", [])
    with pytest.raises(InputError, match="holds no poses"):
        read_poses(file)


@pytest.mark.parametrize("form", ["rosbag1", "rosbag1-bz2", "rosbag1-lz4"])
def test_a_bag_of_ros1_that_breaks_off_is_refused_with_what_mends_it(form, tmp_path):
    file = write(form, tmp_path / "r.bag", [("/pose", k * 0.1, pose(k * 0.1, (k, 0, 0))) for k in range(2000)])
    file.write_bytes(file.read_bytes()[: -(file.stat().st_size // 3)])
    with pytest.raises(InputError, match="rosbag reindex mends bags that break off"):
        read_poses(file)


def test_a_folder_of_rosbag2_that_breaks_off_is_refused(tmp_path):
    folder = write("rosbag2", tmp_path / "r", [("/pose", k * 0.1, pose(k * 0.1, (k, 0, 0))) for k in range(2000)])
    (file,) = folder.glob("*.db3")
    file.write_bytes(file.read_bytes()[: file.stat().st_size // 2])
    with pytest.raises(InputError) as error:
        read_poses(folder)
    assert str(error.value).startswith(f"{folder}: Cannot open database")
    assert "\n" not in str(error.value)


def test_a_record_is_no_recording(record_file, tmp_path):
    assert not is_recording(record_file)
    assert not is_recording(tmp_path / "nowhere")


@pytest.mark.parametrize(
    ("name", "content", "said"),
    [
        ("absent.bag", None, "No such file"),
        ("text.bag", b"hello", "no recording"),
        ("empty.bag", b"#ROSBAG V2.0\n", "expected a recording of ROS"),
        ("whole.bag.gz", gzip.compress(b"#ROSBAG V2.0\n", mtime=0), "packed as a whole, to be unpacked first"),
        ("whole.bag.bz2", bz2.compress(b"#ROSBAG V2.0\n"), "packed as a whole, to be unpacked first"),
        ("empty.mcap", b"\x89MCAP0\r\n", "holds no poses"),
    ],
)
def test_what_cannot_be_read(name, content, said, tmp_path):
    if content is not None:
        (tmp_path / name).write_bytes(content)
    with pytest.raises(InputError, match=said) as error:
        read_poses(tmp_path / name)
    assert str(error.value).startswith(str(tmp_path / name))
    assert "\n" not in str(error.value)


def test_a_folder_that_is_no_bag_and_words_alone(tmp_path):
    with pytest.raises(InputError, match="expected a recording of ROS"):
        read_poses(tmp_path)
    file = write("mcap", tmp_path / "words", [("/words", 1.0, String("a"))])
    with pytest.raises(InputError, match="holds no poses"):
        read_poses(file)


@pytest.mark.parametrize("form", FORMS)
def test_errors_are_the_distances_to_the_reference(form, recording, tmp_path):
    told = told_of(recording, "r_0", "/r_0/odom", begins_s=BEGINS, off=(0.3, 0.4, 5.0))
    told += told_of(recording, "r_1", "/elsewhere", begins_s=BEGINS, say=pose)
    tracks = read_poses(write(form, tmp_path / "others", sorted(told, key=lambda one: one[1]))).tracks
    reference = Reference.of(recording, tracks, {"r_1": "/elsewhere"})
    off = {one.robot: one for one in deviations(recording, reference)}
    count = len(recording.tracks.times_s)
    assert reference.begins_s == pytest.approx(BEGINS, abs=1e-5)
    assert off["r_0"].samples == count
    assert off["r_0"].error.mean == pytest.approx(0.5, abs=1e-5)  # the mission is in the plane
    assert off["r_0"].error.total == pytest.approx(0.5 * off["r_0"].samples, abs=1e-3)
    assert off["r_1"].error.most == pytest.approx(0.0, abs=1e-5)
    assert off["r_1"].topic == "/elsewhere"


def test_a_clock_that_is_given_shifts_the_reference(recording, tmp_path):
    tracks = read_poses(
        write("mcap", tmp_path / "r", told_of(recording, "r_0", "/r_0/pose", begins_s=3.0, say=pose))
    ).tracks
    on_time, late = (deviations(recording, Reference.of(recording, tracks, {}, begins)) for begins in (3.0, 1.0))
    assert on_time[0].error.most == pytest.approx(0.0, abs=1e-9)
    assert late[0].error.most > 0.1
    assert late[0].samples == np.sum(recording.tracks.times_s >= 2.0)


def test_robots_topics_and_times_that_are_not_there(recording, tmp_path):
    tracks = read_poses(write("mcap", tmp_path / "r", [("/car", 5.0, pose(5.0, (0, 0, 0)))])).tracks
    for topics, said in (
        ({"r_9": "/car"}, "no robot 'r_9' in the record"),
        ({"r_0": "/bus"}, "no poses on '/bus'; expected one of /car"),
        ({}, "no topic of a robot; expected --topic ROBOT=TOPIC of /car"),
    ):
        with pytest.raises(ParameterError, match=said):
            Reference.of(recording, tracks, topics)
    with pytest.raises(ParameterError, match="expected a time in which the record has poses of 'r_0'"):
        deviations(recording, Reference.of(recording, tracks, {"r_0": "/car"}, -1e6))


def test_risk_is_by_the_distance_to_the_map(recording, tmp_path):
    chart = Map(boundary=((-9.0, -9.0), (9.0, -9.0), (9.0, 9.0), (-9.0, 9.0)))
    within = replace(recording, mission=replace(recording.mission, map=chart))
    tracks = read_poses(write("mcap", tmp_path / "r", told_of(recording, "r_0", "/r_0/odom"))).tracks
    reference = Reference.of(within, tracks, {})
    (off,) = deviations(within, reference)
    assert off.risk == pytest.approx(
        float((1 / (9.0 - np.abs(recording.tracks.positions[:, 0, :2]).max(axis=1))).sum())
    )
    assert deviations(recording, reference)[0].risk is None


def test_risk_over_an_image_is_by_the_distance_to_its_blocked_cells(recording, tmp_path):
    blocked = np.zeros((200, 200), dtype=bool)
    blocked[:, 0] = True  # the wall of the west: x from -10.0 to -9.5
    chart = Map(image="floor.png", resolution_m=0.5, origin=(-10.0, -50.0, 0.0))
    image = Grid(blocked, 0.5, (-10.0, -50.0, 0.0))
    within = replace(recording, mission=replace(recording.mission, map=chart), image=image)
    tracks = read_poses(write("rosbag1", tmp_path / "r", told_of(recording, "r_0", "/r_0/odom"))).tracks
    (off,) = deviations(within, Reference.of(within, tracks, {}))
    assert off.risk == pytest.approx(float((1 / (9.5 + recording.tracks.positions[:, 0, 0])).sum()))


@pytest.mark.parametrize("form", ["mcap", "rosbag1"])
def test_recordings_that_are_damaged_anywhere_are_read_or_refused(form, tmp_path):
    whole = write(
        form, tmp_path / "whole", [("/pose", k * 0.1, pose(k * 0.1, (k, 0, 0))) for k in range(40)]
    ).read_bytes()
    random = np.random.default_rng(0)
    for trial in range(60):
        data = bytearray(whole)
        if trial % 2:
            del data[int(random.integers(20, len(whole))) :]
        else:
            for at in random.integers(20, len(whole), 5):
                data[at] = int(random.integers(256))
        (tmp_path / "damaged").write_bytes(data)
        said = ""
        try:
            assert all(len(track.times_s) for track in read_poses(tmp_path / "damaged").tracks.values())
        except InputError as error:
            said = str(error)
        assert len(said.splitlines()) <= 1
