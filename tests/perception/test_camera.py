"""The pinhole camera: frames compose, projecting and looking along rays undo each other, bad numbers are refused."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from muster.mission import model
from muster.mission.errors import ParameterError
from muster.motion.frames import inverse, moved, pose_transform
from muster.perception.camera import (
    IMAGE_RENDERER,
    LINK_IMAGE,
    RB5_MOUNT,
    Intrinsics,
    View,
    mount_of,
    mount_of_mission,
)
from muster.perception.localisation import on_ground

angle = st.floats(-math.pi, math.pi)
metres = st.floats(-50, 50)
poses = st.tuples(metres, metres, metres, angle, st.floats(-1.5, 1.5), angle)
intrinsics = st.builds(
    lambda fx, fy, cx, cy: Intrinsics(width=640, height=480, fx=fx, fy=fy, cx=cx, cy=cy),
    st.floats(100, 2000),
    st.floats(100, 2000),
    st.floats(200, 440),
    st.floats(150, 330),
)
pixels = st.tuples(st.floats(0, 640), st.floats(0, 480))
PLAIN = {"width": 640, "height": 480, "fx": 500.0, "fy": 500.0, "cx": 320.0, "cy": 240.0}


def test_the_thesis_drone_looks_ahead_and_down_by_45_degrees():
    view = View.from_body(Intrinsics(**PLAIN), [0, 0, 0, 0, 0, 0], RB5_MOUNT)
    np.testing.assert_allclose(view.position, [0.087, 0, -0.001], atol=1e-12)
    half = math.sqrt(0.5)
    np.testing.assert_allclose(view.rays([[320, 240]]), [[half, 0, -half]], atol=1e-12)
    np.testing.assert_allclose(view.rotation[:, 0], [0, -1, 0], atol=1e-12)  # the picture's right is the body's right


@given(intrinsics, poses, poses, st.tuples(metres, metres, metres))
def test_a_view_is_body_then_link_then_image(camera, body, link, point):
    view = View.from_body(camera, body, mount_of(link))
    chain = [pose_transform(body), pose_transform(link), LINK_IMAGE]
    there = np.array([point])
    for step in chain:  # (4.37), one frame after the other
        there = moved(inverse(step), there)
    x, y, depth = there[0]
    if depth > 1e-3:
        expected = [camera.fx * x / depth + camera.cx, camera.fy * y / depth + camera.cy]
        np.testing.assert_allclose(view.project([point])[0], expected, rtol=1e-6, atol=1e-4)
    elif depth < -1e-3:
        assert np.isnan(view.project([point])).all()


@given(intrinsics, poses, pixels, st.floats(0.1, 100))
def test_what_is_along_a_ray_is_at_its_pixel(camera, body, pixel, distance):
    view = View.from_body(camera, body, RB5_MOUNT)
    (ray,) = view.rays([pixel])
    assert np.linalg.norm(ray) == pytest.approx(1)
    np.testing.assert_allclose(view.project([view.position + distance * ray]), [pixel], atol=1e-6)
    assert view.sees([view.position + distance * ray])[0] or not (1e-6 < pixel[0] < 639 and 1e-6 < pixel[1] < 479)


@given(pixels, st.floats(100, 2000))
def test_equation_4_39_with_one_focal_length(pixel, focal):
    view = View(Intrinsics(**PLAIN | {"fx": focal, "fy": focal}), np.eye(4))
    x, y = pixel[0] - 320, pixel[1] - 240
    printed = np.array([x, y, focal]) / math.sqrt(x**2 + y**2 + focal**2)
    np.testing.assert_allclose(view.rays([pixel])[0], printed, atol=1e-12)


@given(metres, metres, st.floats(0.5, 50), angle, st.floats(-0.2, 0.2), st.floats(0.4, 1.5), pixels)
def test_project_then_localise_is_the_identity(x, y, z, yaw, roll, tilt, pixel):
    """Where the ground is seen at all: the camera looks down by at least 0.4 and its picture reaches 0.36 up."""
    camera = Intrinsics.of_view(640, 480, 0.9)
    view = View.from_body(camera, [x, y, z, roll, 0.0, yaw], mount_of([0.1, 0.0, 0.0, 0.0, tilt, 0.0]))
    (place,) = on_ground(view, [pixel])
    if np.isnan(place).any() or np.linalg.norm(place - view.position) > 1000:
        return
    np.testing.assert_allclose(view.project([place]), [pixel], atol=1e-5)
    np.testing.assert_allclose(on_ground(view, view.project([place])), [place], atol=1e-5 * z)


def test_what_is_behind_or_outside_is_not_seen():
    view = View(Intrinsics(**PLAIN), np.eye(4))
    places = [[0, 0, 1], [0, 0, -1], [1, 1, 0], [0.63, 0.47, 1], [0.65, 0, 1], [0, -0.49, 1]]
    assert view.sees(places).tolist() == [True, False, False, True, False, False]


def test_intrinsics_of_a_field_of_view():
    camera = Intrinsics.of_view(640, 480, math.radians(60))
    view = View(camera, np.eye(4))
    left, right = view.rays([[0, 240], [640, 240]])
    assert math.acos(left @ right) == pytest.approx(math.radians(60))
    above, below = view.rays([[320, 0], [320, 480]])
    assert math.acos(above @ below) == pytest.approx(camera.vertical_fov_rad)


def test_a_mission_camera_with_the_numbers_of_the_thesis_is_that_of_the_thesis():
    camera = model.Camera(fov_deg=60, tilt_deg=45, mount=(0.087, 0.0, -0.001))
    np.testing.assert_allclose(mount_of_mission(camera), RB5_MOUNT, atol=1e-12)
    flat = mount_of_mission(model.Camera(fov_deg=60, mount=(0.1, 0.2)))
    np.testing.assert_allclose(flat[:3, 3], [0.1, 0.2, 0.0])


def test_a_renderer_looks_against_its_z_and_has_y_up():
    pose = mount_of([0, 0, 0, 0, 0, 0]) @ IMAGE_RENDERER
    np.testing.assert_allclose(pose[:3, 2], [-1, 0, 0], atol=1e-12)
    np.testing.assert_allclose(pose[:3, 1], [0, 0, 1], atol=1e-12)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"fx": None}, "fx: None; expected a number of pixels"),
        ({"fx": 0.0}, "fx: 0.0; expected a focal length above 0, in pixels"),
        ({"fy": -3.0}, "fy: -3.0; expected a focal length above 0, in pixels"),
        ({"cx": math.nan}, "cx: nan; expected a finite number of pixels"),
        ({"cy": 481.0}, "cy: 481.0; expected a principal point within the picture, 0 to 480"),
        ({"width": 0}, "width: 0; expected a whole number of pixels of at least 1"),
        ({"height": 1.5}, "height: 1.5; expected a whole number of pixels of at least 1"),
        ({"width": True}, "width: True; expected a number of pixels"),
    ],
)
def test_bad_intrinsics_are_refused(change, message):
    with pytest.raises(ParameterError) as caught:
        Intrinsics(**PLAIN | change)
    assert str(caught.value) == message


def test_a_field_of_view_of_a_half_turn_is_refused():
    with pytest.raises(ParameterError, match=r"fov_rad: .*; expected an angle above 0 and below pi"):
        Intrinsics.of_view(640, 480, math.pi)


@pytest.mark.parametrize(
    ("pose", "message"),
    [
        (np.eye(3), r"pose: shape \(3, 3\); expected \(4, 4\)"),
        (np.full((4, 4), np.nan), "pose: a number that is not finite"),
        (np.diag([2.0, 1, 1, 1]), "expected a rotation, a position"),
        (np.diag([1.0, 1, -1, 1]), "expected a rotation, a position"),
    ],
)
def test_a_pose_that_is_none_is_refused(pose, message):
    with pytest.raises(ParameterError, match=message):
        View(Intrinsics(**PLAIN), pose)


def test_a_camera_without_intrinsics_is_refused():
    with pytest.raises(ParameterError, match="intrinsics: None; expected the camera's Intrinsics"):
        View(None, np.eye(4))


def test_a_body_that_is_no_pose_is_refused():
    with pytest.raises(ParameterError, match=r"body: shape \(3,\); expected \(6,\) or \(4, 4\)"):
        View.from_body(Intrinsics(**PLAIN), [0, 0, 0], RB5_MOUNT)
