"""Raster searches from a camera's footprint: a simulated camera on the way sees every place of the square."""

import math
from itertools import pairwise

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from tests.mission.strategies import examples

from muster.mission.errors import MissionError
from muster.mission.model import Action, Camera, Robot, Task
from muster.motion.actions import Impossible, TaskMotion, plan
from muster.motion.actions.footprint import footprint_of
from muster.motion.actions.unseen_places import unseen
from muster.perception.camera import View, intrinsics_of_mission, mount_of_mission
from muster.perception.localisation import on_ground

cameras = st.builds(
    Camera,
    fov_deg=st.floats(25, 110),
    tilt_deg=st.floats(25, 90),
    mount=st.tuples(st.floats(-0.3, 0.3), st.floats(-0.3, 0.3), st.floats(-0.3, 0.3)),
    height_px=st.integers(320, 960),
)


def search(**more):
    return Task(id="t", position=(3, -2), action=Action(name="raster-search", **more))


def drone(camera, name="d"):
    return Robot(id=name, position=(0, 0), kind="air", camera=camera)


def views(camera, motion, height, step):
    """The camera's views on the way, so many metres apart, each lane at its heading."""
    mount, intrinsics = mount_of_mission(camera), intrinsics_of_mission(camera)
    for start, end in pairwise(motion.waypoints):
        if start.heading != end.heading:
            continue
        steps = max(2, math.ceil(math.dist(start.position, end.position) / step))
        for share in np.linspace(0.0, 1.0, steps + 1):
            x, y, _ = np.array(start.position) + share * np.subtract(end.position, start.position)
            yield View.from_body(intrinsics, [x, y, height, 0.0, 0.0, end.heading], mount)


def seen_by_flying(camera, task, motion, count=11):
    side, height = task.action.side_m, task.action.height_m
    even = np.linspace(-side / 2, side / 2, count)
    places = np.array([(3 + e, -2 + n, 0.0) for e in even for n in even])
    seen = np.zeros(len(places), dtype=bool)
    for view in views(camera, motion, height, side / 100):
        seen |= view.sees(places)
    return seen


@examples(15)
@given(camera=cameras, height=st.floats(1, 20), widths=st.floats(0.3, 3.5), overlap=st.floats(0.05, 0.6))
def test_the_whole_square_is_seen_whatever_the_camera(camera, height, widths, overlap):
    side = widths * footprint_of(camera, height).width_m
    task = search(side_m=side, height_m=height, overlap=overlap)
    motion = plan(task, drone(camera))
    assert isinstance(motion, TaskMotion)
    assert seen_by_flying(camera, task, motion).all()


@examples(15)
@given(camera=cameras, height=st.floats(1, 20))
def test_the_footprint_is_what_the_picture_shows(camera, height):
    """Near edge and middle row of the picture, their widths: by projection of pixels to the ground."""
    found = footprint_of(camera, height)
    view = View.from_body(intrinsics_of_mission(camera), [0, 0, height, 0, 0, 0], mount_of_mission(camera))
    wide, high = camera.width_px, camera.height_px
    near, middle = (on_ground(view, [[0, row], [wide, row]]) for row in (high, high / 2))
    for corners, ahead, half in (
        (near, found.near_m, found.near_half_m),
        (middle, found.middle_m, found.middle_half_m),
    ):
        assert np.allclose(corners[:, 0], ahead, atol=1e-6)
        assert np.allclose(corners[:, 1], [found.left_m + half, found.left_m - half], atol=1e-6)


@examples(15)
@given(camera=cameras, height=st.floats(1, 8), part=st.floats(0.2, 3.0))
def test_what_is_said_to_be_seen_is_seen(camera, height, part):
    """A typed spacing that is not complained of leaves no place of the square unseen."""
    width = footprint_of(camera, height).width_m
    task = search(side_m=2 * width, height_m=height, spacing_m=part * width)
    if camera.tilt_deg < 89 and unseen(task, drone(camera)) is None:
        assert seen_by_flying(camera, task, plan(task, drone(camera))).all()


def test_a_spacing_that_is_too_wide():
    camera = Camera(fov_deg=60, tilt_deg=90)
    found = unseen(search(side_m=4, height_m=2, spacing_m=9), drone(camera))
    assert found.width_m == pytest.approx(2 * 2 * math.tan(math.radians(30)))
    assert found.expected_m == pytest.approx(0.9 * found.width_m)
    assert 0.3 < found.share < 1
    assert unseen(search(side_m=4, height_m=2, spacing_m=0.5), drone(camera)) is None
    assert unseen(search(side_m=4, height_m=2), drone(camera)) is None
    assert unseen(search(side_m=4, height_m=2, spacing_m=9), drone(None)) is None


def test_lanes_follow_from_the_camera():
    """Strips of one width, as many as 0.9 w_c needs; the middle of the picture goes over the square."""
    camera = Camera(fov_deg=90, tilt_deg=45, mount=(0.1, 0.2, 0))
    motion = plan(search(side_m=6, height_m=2), drone(camera))
    width = 2 * 2 / math.sin(math.radians(45))
    lanes = math.ceil(6 / (0.9 * width))
    assert len(motion.waypoints) == 2 * lanes == 4
    (x0, y0), (x1, y1), (x2, y2), (x3, y3) = motion.points
    ahead = 2 + 0.1
    assert (x0, x1, x2, x3) == pytest.approx((0 - ahead, 6 - ahead, 6 + ahead, 0 + ahead))
    assert (y0, y1, y2, y3) == pytest.approx((-3.5 - 0.2, -3.5 - 0.2, -0.5 + 0.2, -0.5 + 0.2))
    assert [way.heading for way in motion.waypoints] == [0, 0, math.pi, math.pi]
    assert motion.cost_m == pytest.approx(6 + math.dist((x1, y1), (x2, y2)) + 6)


@pytest.mark.parametrize(
    ("camera", "height", "reason"),
    [
        (None, 3, "it has no camera"),
        (Camera(fov_deg=60, tilt_deg=0), 3, "does not look down"),
        (Camera(fov_deg=60, tilt_deg=45, mount=(0, 0, -3)), 2, "not above the ground at height_m 2"),
        (Camera(fov_deg=1e-4, tilt_deg=45), 2, "sees too little"),
        (Camera(fov_deg=60, tilt_deg=90), 1e-6, "lanes; expected at most 10000"),
    ],
)
def test_robots_that_cannot(camera, height, reason):
    found = plan(search(side_m=4, height_m=height), drone(camera))
    assert isinstance(found, Impossible)
    assert reason in found.reason


def test_a_spacing_beside_an_overlap_is_refused():
    with pytest.raises(MissionError, match="spacing_m or overlap, not both"):
        search(side_m=4, height_m=2, spacing_m=1, overlap=0.2)
