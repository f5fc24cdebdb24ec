"""Robots on ROS 1 that map themselves: the message of a map, and a mission that is carried out by their maps."""

import json

import pytest
from tests.muster_robots.ros2.test_robot_maps import ROOM


def test_a_message_is_read_as_it_is(rospy_there):
    from muster_robots.ros1.robot_maps import message_of
    from muster_robots.ros1.ros import OccupancyGrid

    message = OccupancyGrid()
    message.header.frame_id = "r_0/map"
    message.info.resolution, message.info.width, message.info.height = 0.5, 3, 1
    message.info.origin.position.x, message.info.origin.orientation.w = 2.0, 1.0
    message.data = [-1, 0, 100]
    found = message_of(message)
    assert (found.frame, found.cell_m, found.size) == ("r_0/map", 0.5, (1, 3))
    assert found.per_cent.tolist() == [-1, 0, 100]
    assert found.origin.tolist() == [[1, 0, 0, 2], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]
    message.info.origin.orientation.w = 0.0
    assert message_of(message).origin is None


@pytest.mark.long
@pytest.mark.parametrize("mapping", [True, pytest.param(False, marks=pytest.mark.long)])
def test_a_mission_is_carried_out_by_the_maps_of_its_robots(mapping, ros):
    (ros.folder / "room.yaml").write_text(ROOM, encoding="utf-8")
    for k in range(2):
        maps = ("--maps", "room.yaml") if mapping or not k else ()
        ros.robot(f"r_{k}", 1, 2 + 2 * k, "--kinematics", "holonomic", *maps)
    wait = ("--wait", "60" if mapping else "20")
    run = ros.muster("room.yaml", "--time-limit", "0.3", "--format", "json", "--unknown", "--known-only", *wait)
    out, err = run.communicate(timeout=110)
    if not mapping:
        assert "robot r_1: nothing on /r_1/map within 20 s; expected its map" in err
        assert run.returncode == 2
        return
    report = json.loads(out)
    assert set(report["tasks_done"]) == {"a", "b"}, err
    assert report["ground"]["explored_m2"] > 20
