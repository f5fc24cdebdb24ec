"""Robots on ROS 2 that map themselves: the messages of their maps, and a mission that is carried out by these."""

import json
import time

import numpy as np
import pytest
from tests.muster_robots.ros2.fake_middleware import Middleware, posed

from muster.mission.model import Mission, Robot, Task
from muster_robots.ros2.fleet import Ros2Fleet
from muster_robots.ros2.map_message_types import MapMetaData, OccupancyGrid
from muster_robots.ros2.message_types import Header, Point, Pose, Time

ROOM = """
schema: muster/1
map:
  boundary: [[0, 0], [8, 0], [8, 6], [0, 6]]
  zones: [{polygon: [[3.8, 0], [4.2, 0], [4.2, 5], [3.8, 5]]}]
robots:
  - {id: r_0, position: [1, 2], radius_m: 0.2, speed_mps: 3, kinematics: holonomic}
  - {id: r_1, position: [1, 4], radius_m: 0.2, speed_mps: 3, kinematics: holonomic}
tasks:
  - {id: a, position: [7, 1]}
  - {id: b, position: [7, 3]}
"""


def grid(*cells, frame="map", stamp=1.0, size=(1, 3)):
    info = MapMetaData(Time(), 0.5, size[1], size[0], Pose(Point(1.0, 2.0, 0.0)))
    return OccupancyGrid(Header(frame_id=frame, stamp=Time.of(stamp)), info, np.array(cells, dtype=np.int8).tobytes())


@pytest.fixture
def fleet():
    robots = tuple(Robot(id=name, position=(0.0, 0.0)) for name in ("r_0", "r-1"))
    there = Middleware()
    made = Ros2Fleet(Mission(robots=robots, tasks=(Task(id="t", position=(1.0, 0.0)),)), middleware=there)
    for topic in ("/r_0/pose", "/r_1/pose"):
        there.heard[topic].append(posed(1.0))
    assert made.robots_not_ready() == {}
    return made, there


def test_robots_are_ready_once_their_maps_are_there_and_the_newest_counts(fleet):
    made, there = fleet
    assert made.new_maps() == {}
    made.hear_maps()
    assert made.robots_not_ready() == {"r_0": "nothing on /r_0/map", "r-1": "nothing on /r_1/map"}
    there.heard["/r_0/map"] += [grid(0, 0, 0, stamp=1.0), grid(100, 0, -1, stamp=2.0)]
    there.heard["/r_1/map"].append(grid(0, 0, 0, frame="r_1/map"))
    assert made.robots_not_ready() == {"r-1": "its map is in frame r_1/map, which tf does not tie to map"}
    (found,) = made.new_maps().items()
    assert found[0] == "r_0"
    assert found[1].cells.blocked.tolist() == [[True, False, False]]
    assert found[1].free.tolist() == [[False, True, False]]
    assert made.new_maps() == {}


def test_maps_are_written_as_ros_writes_them():
    pytest.importorskip("rosbags")
    from muster_robots.ros2.serialization import from_cdr, from_ros1, to_cdr, to_ros1

    sent = grid(-1, 0, 100)
    assert from_cdr(OccupancyGrid, to_cdr(sent)) == sent
    assert from_ros1(OccupancyGrid, to_ros1(sent)).data == sent.data
    pytest.importorskip("cyclonedds")
    from muster_robots.ros2.dds import _idl
    from muster_robots.ros2.description import from_foreign, to_foreign

    foreign = to_foreign(sent, _idl)
    assert list(foreign.data) == [-1, 0, 100]
    assert foreign.serialize() == to_cdr(sent)
    assert from_foreign(OccupancyGrid, foreign) == sent


def test_a_latched_reader_hears_what_was_published_before(loopback):
    pytest.importorskip("cyclonedds")
    from cyclonedds import qos

    from muster_robots.ros2.dds import DdsMiddleware

    ours, theirs = DdsMiddleware(), DdsMiddleware()
    keeps = qos.Policy.Durability.TransientLocal
    theirs._dds._publishing = qos.Qos(keeps, base=theirs._dds._publishing)
    writer, sent = theirs.writer("/r_0/map", OccupancyGrid), grid(0, 100, -1)
    writer.write(sent)
    readers = {latched: ours.reader("/r_0/map", OccupancyGrid, latched=latched) for latched in (True, False)}
    until, heard = time.monotonic() + 20, []
    while not heard:
        assert time.monotonic() < until
        ours.wait(0.05)
        heard = readers[True].take()
    assert heard == [sent]
    assert readers[False].take() == []
    ours.close()
    theirs.close()


@pytest.mark.long
def test_a_mission_is_carried_out_by_the_maps_of_its_robots(start, simulated, tmp_path):
    pytest.importorskip("cyclonedds")
    file = tmp_path / "room.yaml"
    file.write_text(ROOM, encoding="utf-8")
    for k in range(2):
        simulated(f"r_{k}", 1, 2 + 2 * k, "--maps", file)
    options = ("--by", "dds", "--time-limit", "0.3", "--format", "json", "--unknown", "--wait", "60")
    out, err = start("-m", "muster.cli", "ros2", file, *options).communicate(timeout=120)
    report = json.loads(out)
    assert set(report["tasks_done"]) == {"a", "b"}, err
    assert report["ground"]["explored_m2"] > 20
    assert "robots have no map" in err


@pytest.mark.long
def test_a_robot_that_tells_no_map_ends_it_before_anybody_moves(start, simulated, tmp_path):
    pytest.importorskip("cyclonedds")
    file = tmp_path / "room.yaml"
    file.write_text(ROOM, encoding="utf-8")
    simulated("r_0", 1, 2, "--maps", file)
    simulated("r_1", 1, 4)
    run = start("-m", "muster.cli", "ros2", file, "--by", "dds", "--time-limit", "0.3", "--unknown", "--wait", "15")
    out, err = run.communicate(timeout=120)
    assert run.returncode == 2
    assert "robot r_1: nothing on /r_1/map within 15 s; expected its map" in err
    assert out == ""
