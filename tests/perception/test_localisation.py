"""Where things are: exact on exact pixels; (4.44) as printed is wrong by what is said of it."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission.errors import ParameterError
from muster.motion.frames import moved, pose_transform, rotation, transform
from muster.perception.camera import RB5_MOUNT, Intrinsics, View, mount_of
from muster.perception.localisation import (
    Uncertainty,
    by_length_as_printed,
    by_size,
    ground_covariance,
    on_ground,
    size_covariance,
)
from muster.perception.tags import CORNERS

VGA = Intrinsics.of_view(640, 480, math.radians(60))
angle = st.floats(-math.pi, math.pi)
SIZE = 0.4


def over(x, y, z, yaw=0.0):
    return View.from_body(VGA, [x, y, z, 0, 0, yaw], RB5_MOUNT)


def before(view, depth, turn=(0.0, 0.0, 0.0), aside=0.0):
    """A tag before the camera, upright but for `turn`; `aside` is to the right, as a share of the depth."""
    return view.pose @ transform([aside * depth, 0.0, depth], rotation(*turn))


def corners_of(view, pose, size=SIZE):
    return view.project(moved(pose, CORNERS * size))


def test_a_plane_above_the_map_s_zero():
    view = over(1, 2, 5)
    place = [4.0, 2.5, 0.7]
    np.testing.assert_allclose(on_ground(view, view.project([place]), ground_m=0.7), [place], atol=1e-9)


def test_above_the_horizon_there_is_no_ground():
    level = View.from_body(VGA, [0, 0, 2, 0, 0, 0], mount_of([0, 0, 0, 0, 0, 0]))
    nowhere = on_ground(level, [[320, 100], [320, 240], [320, 300]])
    assert np.isnan(nowhere).all(axis=1).tolist() == [True, True, False]


def test_no_pixels_no_places():
    assert on_ground(over(0, 0, 3), np.empty((0, 2))).shape == (0, 3)
    assert ground_covariance(over(0, 0, 3), np.empty((0, 2)), Uncertainty()).shape == (0, 2, 2)


@given(st.floats(1, 8), st.tuples(st.floats(-0.9, 0.9), st.floats(-0.9, 0.9), angle), st.floats(-0.3, 0.3), angle)
def test_a_projected_tag_is_found_by_its_size(depth, turn, aside, yaw):
    view = over(3, -2, 4, yaw)
    pose = before(view, depth, turn, aside)
    found = by_size(view, corners_of(view, pose), SIZE)
    np.testing.assert_allclose(found.position, pose[:3, 3], atol=1e-4)
    np.testing.assert_allclose(found.pose, pose, atol=1e-3)
    assert found.error_px < 1e-3
    assert found.error_px <= found.other_error_px


@given(st.floats(0.2, 0.9), angle, angle)
def test_the_other_pose_is_tilted_the_other_way(tilt, towards, roll):
    """A small tag straight ahead: mirrored at the line of sight, and nearly as good."""
    view = View(VGA, np.eye(4))
    way = rotation(0, 0, towards) @ rotation(tilt, 0, 0) @ rotation(0, 0, -towards)
    mirrored = rotation(0, 0, towards) @ rotation(-tilt, 0, 0) @ rotation(0, 0, -towards)
    pose = transform([0.0, 0.0, 4.0], way @ rotation(0, 0, roll))
    found = by_size(view, corners_of(view, pose, 0.05), 0.05)
    np.testing.assert_allclose(found.other[:3, 2], mirrored[:, 2], atol=0.05)
    np.testing.assert_allclose(found.other[:3, 3], pose[:3, 3], atol=0.01)
    assert found.error_px < found.other_error_px < 0.1


@pytest.mark.parametrize("quarters", range(5))
@pytest.mark.parametrize("tilt", [0.0, 1e-9, 0.3])
def test_upright_and_turned_by_quarters_before_the_camera(quarters, tilt):
    """Where OpenCV's own method for squares answers NaN."""
    view = over(0, 0, 3)
    pose = before(view, 2.0, (tilt, 0.0, quarters * math.pi / 2))
    np.testing.assert_allclose(by_size(view, corners_of(view, pose), SIZE).pose, pose, atol=1e-6)


@given(st.floats(1, 8), angle)
def test_as_printed_is_right_straight_ahead_and_upright(depth, roll):
    view = over(0, 0, 3)
    pose = before(view, depth, (0, 0, roll))
    np.testing.assert_allclose(by_length_as_printed(view, corners_of(view, pose), SIZE), pose[:3, 3], atol=1e-6)


@given(st.floats(2, 8), st.floats(0.1, 0.5))
def test_as_printed_is_too_near_off_the_axis(depth, aside):
    """The depth is taken for the distance: too near by the cosine of the ray's angle with the axis."""
    view = over(0, 0, 3)
    pose = before(view, depth, aside=aside)
    printed = np.linalg.norm(by_length_as_printed(view, corners_of(view, pose), SIZE) - view.position)
    assert printed / np.linalg.norm(pose[:3, 3] - view.position) == pytest.approx(math.cos(math.atan(aside)), rel=1e-6)


@pytest.mark.parametrize("tilt", [0.4, 0.8, 1.2])
def test_as_printed_is_too_far_aslant(tilt):
    """Of a small tag turned about the picture's x, both diagonals shrink to sqrt((1 + cos^2) / 2)."""
    view = over(0, 0, 3)
    pose = before(view, 4, (tilt, 0, 0))
    printed = np.linalg.norm(by_length_as_printed(view, corners_of(view, pose, 0.01), 0.01) - view.position)
    assert printed / 4 == pytest.approx(math.sqrt(2 / (1 + math.cos(tilt) ** 2)), rel=1e-4)


def test_the_covariance_is_that_of_small_changes():
    """Against differences: one pixel coordinate, one axis of place, one axis of turn about the camera at a time."""
    view = over(1, -1, 3, 0.7)
    pixel, step = np.array([[410.0, 330.0]]), 1e-5
    errors = Uncertainty(pixel_px=0.6, position_m=0.03, angle_rad=0.02)
    here = on_ground(view, pixel)[0]
    changed = []
    for axis in np.eye(3):
        place = transform(axis * step, np.eye(3))
        turn = pose_transform([0, 0, 0, *(axis * step)])
        centred = transform(view.position, np.eye(3)) @ turn @ transform(-view.position, np.eye(3))
        changed.append((View(VGA, place @ view.pose), pixel, errors.position_m))
        changed.append((View(VGA, centred @ view.pose), pixel, errors.angle_rad))
    changed += [(view, pixel + step * axis, errors.pixel_px) for axis in np.eye(2)]
    slopes = [sigma * (on_ground(v, p)[0] - here)[:2] / step for v, p, sigma in changed]
    expected = sum(np.outer(slope, slope) for slope in slopes)
    np.testing.assert_allclose(ground_covariance(view, pixel, errors)[0], expected, rtol=1e-3)


def test_the_covariance_by_size_is_that_of_many_noisy_corners():
    """Corners, the robot's place and its attitude err as they say they do."""
    view = over(0.5, -0.3, 3.0, 0.4)
    tag = pose_transform([2.5, 0.4, 0.0, math.pi, 0.0, 0.7])
    exact, random = corners_of(view, tag), np.random.default_rng(3)
    errors = Uncertainty(pixel_px=0.3, position_m=0.02, angle_rad=0.005)
    places = []
    for _ in range(600):
        shift, turn = random.normal(0, 0.02, 3), random.normal(0, 0.005, 3)
        c = view.position
        off = transform(c + shift, rotation(*turn)) @ transform(-c, np.eye(3))
        wrong = View(view.intrinsics, off @ view.pose)
        places.append(by_size(wrong, exact + random.normal(0, 0.3, (4, 2)), SIZE).position[:2])
    sampled, said = np.cov(np.array(places).T), size_covariance(view, exact, SIZE, errors)
    np.testing.assert_allclose(np.linalg.eigvalsh(said), np.linalg.eigvalsh(sampled), rtol=0.25)


def test_far_views_are_stretched_along_the_view():
    view = over(0, 0, 3, 0.0)
    covariance = ground_covariance(view, view.project([[6.0, 0.0, 0.0]]), Uncertainty(angle_rad=0.0175))[0]
    along, across = math.sqrt(covariance[0, 0]), math.sqrt(covariance[1, 1])
    assert 2 < along / across < 3
    assert covariance[0, 1] == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("locate", [by_size, by_length_as_printed])
@pytest.mark.parametrize(
    ("corners", "size", "message"),
    [
        ([[0, 0], [9, 0], [9, 9], [0, 9]], 0.0, "size_m: 0.0; expected metres above 0"),
        ([[0, 0], [9, 0], [9, 9]], 0.4, "expected four places in pixels"),
        ([[0, 0], [9, 0], [9, 9], [0, math.nan]], 0.4, "expected four places in pixels"),
        ([[0, 0], [9, 9], [9, 0], [0, 9]], 0.4, "expected the corners of a convex square, in order"),
        ([[0, 0], [1, 1], [2, 2], [3, 3]], 0.4, "expected the corners of a convex square, in order"),
    ],
)
def test_corners_that_are_none_are_refused(locate, corners, size, message):
    with pytest.raises(ParameterError, match=message):
        locate(over(0, 0, 3), corners, size)


@pytest.mark.parametrize("wrong", [{"pixel_px": 0.0}, {"position_m": -1.0}, {"angle_rad": math.nan}])
def test_errors_below_zero_are_refused(wrong):
    with pytest.raises(ParameterError, match=f"{next(iter(wrong))}: "):
        Uncertainty(**wrong)
