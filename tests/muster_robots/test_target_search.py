"""What real robots' cameras and lasers show, without ROS: images are rendered from known poses."""

import math
from dataclasses import replace
from importlib.util import find_spec
from pathlib import Path

import numpy as np
import pytest

from muster.mission.errors import ParameterError, RenderingError
from muster.mission.reading.yaml_reader import parse_yaml
from muster.motion.frames import pose_transform
from muster.perception.camera import intrinsics_of_mission, mount_of_mission
from muster.perception.camera_messages import image_of, intrinsics_of, matrix_of
from muster.perception.scan_obstacles import scan_of
from muster_robots.target_search import SearchSettings, TargetSearch, ground_of

if find_spec("mujoco") is None:
    pytest.skip("the extra `physics` is not installed", allow_module_level=True)

YARD = parse_yaml(
    """
schema: muster/1
name: yard
robots:
  - {id: d, position: [0, 0, 0], kind: air, kinematics: quadcopter,
     camera: {fov_deg: 60, tilt_deg: 60, mount: [0.1, 0, 0], width_px: 320, height_px: 240}}
  - {id: r, position: [0, 5, 0], radius_m: 0.2}
tasks: [{id: t, position: [3, 3, 0]}]
tags:
  - {id: 7, position: [3, 0.2, 0], heading_deg: 40, size_m: 0.5}
  - {id: 9, position: [3, -0.6, 0], size_m: 0.5}
found:
  - {tags: [7], becomes: {requires: [], duration_s: 2}}
""",
    Path("yard.yaml"),
)
CAMERA = YARD.robots[0].camera
INTRINSICS = intrinsics_of_mission(CAMERA)


@pytest.fixture(scope="module")
def picture():
    from muster_physics.placed_camera import PlacedCamera

    try:
        camera = PlacedCamera(YARD, INTRINSICS)
    except RenderingError as error:
        pytest.skip(str(error))
    yield lambda pose: camera.image(pose_transform(pose), mount_of_mission(CAMERA))
    camera.close()


@pytest.fixture(scope="module")
def detector():
    from muster.perception.detection import TagDetector

    return TagDetector()


def flown(search, picture, count=4):
    """A drone flies east 3 m above the ground, and takes a picture each half second, between two of its poses."""
    results = []
    for k in range(count):
        for stamp in (k - 0.25, k + 0.25):
            search.hear_pose("d", stamp, pose_transform([0.4 * stamp, 0.0, 3.0, 0.0, 0.0, 0.0]))
        results.append(search.hear_image("d", float(k), picture([0.4 * k, 0.0, 3.0, 0.0, 0.0, 0.0])))
    return results


@pytest.mark.parametrize(("locate", "within_m"), [("ground", 0.02), ("size", 0.1)])
def test_tags_become_points_and_tasks(picture, detector, locate, within_m):
    search = TargetSearch(YARD, detector, SearchSettings(locate=locate))
    search.hear_intrinsics("d", intrinsics_of(320, 240, matrix_of(INTRINSICS), [0.0] * 5))
    results = flown(search, picture)
    points = {row["tag"]: row for row in search.points}
    assert set(points) == {7, 9}
    assert math.dist(points[7]["position"], (3, 0.2)) < within_m
    assert math.dist(points[9]["position"], (3, -0.6)) < within_m
    assert (points[7]["task"], points[9]["task"]) == ("found-7", None)
    events = [event for result in results for _, event in result.finds if event is not None]
    assert [event.new_task.id for event in events] == ["found-7"]
    assert events[0].new_task.duration_s == 2
    assert len(events[0].new_task.position) == 3


def test_a_tag_of_unknown_size_is_left_out_by_size_unless_one_size_holds_for_all(picture, detector):
    known = replace(YARD, tags=YARD.tags[:1])
    for size, tags in ((None, {7}), (0.5, {7, 9})):
        search = TargetSearch(known, detector, SearchSettings(locate="size", tag_size_m=size))
        search.hear_intrinsics("d", INTRINSICS)
        flown(search, picture)
        assert {row["tag"] for row in search.points} == tags


def test_what_is_missing_is_said(picture, detector):
    search, image = TargetSearch(YARD, detector), picture([0, 0, 3, 0, 0, 0])
    assert search.hear_image("d", 0.0, image).remarks == ("d: no camera_info; expected the camera's intrinsics",)
    search.hear_intrinsics("d", INTRINSICS)
    assert search.hear_image("d", 0.0, image).remarks == ("d: no pose of the time of an image; expected one",)
    search.hear_pose("d", 0.0, pose_transform([0, 0, 3, 0, 0, 0]))
    assert search.hear_image("d", 5.0, image).remarks == ("d: no pose of the time of an image; expected one",)
    assert search.hear_image("r", 0.0, image).remarks == ("r: an image; expected a camera of it in the mission",)
    assert "expected 320 x 240" in search.hear_image("d", 0.0, image[:100]).remarks[0]
    assert search.hear_image("d", 0.1, image).remarks == ()


def test_a_clock_that_is_set_back_begins_anew(picture, detector):
    search = TargetSearch(YARD, detector)
    pose = pose_transform([0, 0, 3, 0, 0, 0])
    search.hear_pose("d", 100.0, pose)
    search.hear_pose("d", 3.0, pose)
    assert search.pose_at("d", 3.0) is not None
    assert search.pose_at("d", 100.0) is None


def test_a_scan_shows_a_box_and_a_pole_on_the_map():
    """A laser at (1, 2), looking north: a wall of 1 m two metres ahead, and a pole of 5 cm to its left."""
    from muster.perception.laser import Scanner

    scanner = Scanner(field_rad=math.pi, step_rad=math.radians(0.25))
    wall = np.array([[0.5, 4.0, 1.5, 4.0]])
    pole = np.array([[-0.5, 2.5, 0.05]])
    exact = scanner.ranges((1.0, 2.0, math.pi / 2), wall, pole)
    first, step = scanner.bearings[0], scanner.bearings[1] - scanner.bearings[0]
    scan = scan_of(np.where(np.isfinite(exact), exact, 99.0), first, step, (0.05, 4.0))
    search = TargetSearch(YARD, None)
    seen = search.hear_scan("r", pose_transform([1.0, 2.0, 0.2, 0.0, 0.0, math.pi / 2]), *scan)
    line, _ = seen["obstacles"]
    assert line["shape"] == "line"
    assert line["position"] == pytest.approx([1.0, 4.0], abs=0.02)
    assert line["length_m"] == pytest.approx(1.0, abs=0.03)
    left, right = sorted(line["edges"])
    assert (left[0], right[0]) == (pytest.approx(0.3, abs=0.05), pytest.approx(1.7, abs=0.05))
    assert seen["landmarks"][0]["position"] == pytest.approx([-0.5, 2.5], abs=0.01)
    assert seen["landmarks"][0]["radius_m"] == pytest.approx(0.05, abs=0.01)


def test_a_scan_that_falls_is_turned_and_what_is_out_of_reach_is_nothing():
    ranges, bearings = scan_of([1.0, math.nan, 0.01, 9.0], 0.3, -0.1, (0.05, 4.0))
    assert bearings.tolist() == pytest.approx([0.0, 0.1, 0.2, 0.3])
    assert ranges.tolist() == [math.inf, math.inf, math.inf, 1.0]
    with pytest.raises(ParameterError, match="expected two, and a step"):
        scan_of([1.0], 0.0, 0.1, (0.0, 1.0))


@pytest.mark.parametrize("encoding", ["mono8", "rgb8", "bgr8", "rgba8", "bgra8"])
def test_images_of_every_encoding_have_their_colours_in_order(encoding):
    """One red pixel beside a blue one, rows padded to 16 bytes."""
    names = encoding.rstrip("8")
    pixels = {"mono": [(200,), (50,)]}.get(names) or [
        tuple({"r": 200, "g": 0, "b": 0, "a": 255}[c] for c in names),
        tuple({"r": 0, "g": 0, "b": 50, "a": 255}[c] for c in names),
    ]
    row = bytes(value for pixel in pixels for value in pixel).ljust(16, b"\0")
    image = image_of(encoding, 1, 2, 16, row)
    expected = [[200, 50]] if names == "mono" else [[[200, 0, 0], [0, 0, 50]]]
    assert image.tolist() == expected


@pytest.mark.parametrize(
    ("given", "said"),
    [(("yuv422", 1, 2, 4, b"1234"), "encoding: yuv422"), (("rgb8", 1, 2, 6, b"123"), "data: 3 bytes")],
)
def test_images_that_are_none_are_refused(given, said):
    with pytest.raises(ParameterError, match=said):
        image_of(*given)


@pytest.mark.parametrize(("matrix", "distortion", "said"), [([0.0] * 9, [], "K: all 0"), ([1.0] * 9, [0.1], "D:")])
def test_intrinsics_that_are_none_are_refused(matrix, distortion, said):
    with pytest.raises(ParameterError, match=said):
        intrinsics_of(2, 2, matrix, distortion)


def test_settings_are_checked_and_the_ground_is_the_lowest_place():
    for wrong in ({"locate": "sky"}, {"tag_size_m": 0.0}):
        with pytest.raises(ParameterError):
            SearchSettings(**wrong)
    assert ground_of(YARD) == 0.0
