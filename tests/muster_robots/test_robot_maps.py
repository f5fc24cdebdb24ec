"""Maps that robots on ROS tell: which count, and in which frame."""

import numpy as np
import pytest

from muster.motion.frames import rotation, transform
from muster_robots.robot_maps import MapMessage, RobotMaps
from muster_robots.tied_frames import TiedFrames


def pose(x, y, yaw=0.0):
    return transform((x, y, 0.0), rotation(0.0, 0.0, yaw))


def message(frame, origin, **how):
    given = {"cell_m": 0.5, "size": (2, 3), "per_cent": np.array([0, 100, -1, 0, 0, 0], dtype=np.int8)} | how
    return MapMessage(frame=frame, origin=origin, **given)


@pytest.fixture
def said():
    return []


@pytest.fixture
def frames():
    return TiedFrames("map")


@pytest.fixture
def maps(frames, said):
    found = RobotMaps(frames, said.append)
    assert found.expect("r_0", "/lab/r_0") == "/lab/r_0/map"
    return found


def tie(frames, child, x, y, yaw=0.0):
    frames.take("map", child, 0.0, pose(x, y, yaw), static=True, now_s=0.0)


def test_a_map_in_the_missions_frame_counts_once(maps, said):
    assert maps.missing("r_0") == "nothing on /lab/r_0/map"
    assert maps.missing("another") == ""
    maps.take("r_0", message("map", pose(1.0, 2.0, 0.5)))
    assert maps.missing("r_0") == ""
    (grid,) = maps.new().values()
    assert grid.cells.origin == pytest.approx((1.0, 2.0, 0.5))
    assert grid.cells.blocked.tolist() == [[False, True, False], [False, False, False]]
    assert grid.free.tolist() == [[True, False, False], [True, True, True]]
    assert maps.new() == {}
    assert said == []


def test_a_map_of_an_own_frame_lies_where_tf_ties_it(maps, frames):
    tie(frames, "r_0/map", 3.0, -1.0, np.pi / 2)
    maps.take("r_0", message("r_0/map", pose(2.0, 0.0)))
    (grid,) = maps.new().values()
    assert grid.cells.origin == pytest.approx((3.0, 1.0, np.pi / 2))


def test_an_untied_map_is_named_once_and_counts_from_when_it_is_tied(maps, frames, said):
    maps.take("r_0", message("r_0/map", pose(2.0, 0.0)))
    why = "its map is in frame r_0/map, which tf does not tie to map"
    assert maps.missing("r_0") == maps.missing("r_0") == why
    assert maps.new() == {}
    assert said == [f"robot r_0: {why}"]
    tie(frames, "r_0/map", 3.0, 0.0)
    assert maps.missing("r_0") == ""
    assert maps.new()["r_0"].cells.origin == pytest.approx((5.0, 0.0, 0.0))


def test_a_newer_map_replaces_one_that_waits(maps, frames):
    maps.take("r_0", message("r_0/map", pose(2.0, 0.0)))
    assert maps.new() == {}
    maps.take("r_0", message("r_0/map", pose(4.0, 0.0)))
    tie(frames, "r_0/map", 0.0, 0.0)
    assert maps.new()["r_0"].cells.origin == pytest.approx((4.0, 0.0, 0.0))


@pytest.mark.parametrize(
    ("how", "why"),
    [
        ({"origin": None}, "its map: origin: no pose; expected finite numbers, and a quaternion"),
        ({"cell_m": -1.0}, "its map: resolution: -1; expected metres above 0"),
        ({"size": (3, 3)}, "its map: data: 6 cells; expected 3 rows of 3"),
        (
            {"origin": transform((0, 0, 0), np.array([[1, 0, 0], [0, 0, -1], [0, 1, 0.0]]))},
            "its map: origin: tilted by 1.57 rad; expected a level map",
        ),
    ],
)
def test_what_is_no_map_does_not_count_and_is_named(how, why, maps, said):
    maps.take("r_0", message("map", **{"origin": pose(0, 0), **how}))
    assert maps.missing("r_0") == why
    assert maps.new() == {}
    assert said == [f"robot r_0: {why}"]
    maps.take("r_0", message("map", pose(0, 0)))
    assert list(maps.new()) == ["r_0"]
