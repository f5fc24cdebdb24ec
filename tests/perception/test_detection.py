"""Tags in pictures drawn here, in perspective, with noise and blur."""

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from muster.mission.errors import ParameterError

pytest.importorskip("apriltag")
pytest.importorskip("cv2")
from muster.perception.camera import mount_of
from muster.perception.detection import DetectorParameters, TagDetector
from muster.perception.localisation import by_size, on_ground
from muster.perception.tags import tag_image

from .scenes import VGA, corners_in_map, drawn, over, tag_pose

DETECTOR = TagDetector()


@pytest.mark.long
@settings(max_examples=25)
@given(
    tag=st.integers(0, 586),
    turned=st.floats(-math.pi, math.pi),
    away=st.floats(2.0, 4.5),
    aside=st.floats(-0.8, 0.8),
    noise=st.floats(0, 6),
    blur=st.floats(0, 1),
    seed=st.integers(0, 99),
)
def test_a_tag_on_the_ground_is_found_where_it_is(tag, turned, away, aside, noise, blur, seed):
    view, pose = over(0, 0, 3), tag_pose(away, aside, turned)
    (seen,) = DETECTOR.detect(drawn(view, [(tag, pose)], noise=noise, blur=blur, seed=seed), VGA).all
    assert seen.tag == tag
    assert seen.corrected <= 1
    np.testing.assert_allclose(seen.centre, view.project(pose[None, :3, 3])[0], atol=0.3)
    np.testing.assert_allclose(seen.corners, view.project(corners_in_map(pose, 0.5)), atol=0.6)
    np.testing.assert_allclose(on_ground(view, seen.centre), pose[None, :3, 3], atol=0.01)
    np.testing.assert_allclose(by_size(view, seen.corners, 0.5).position, pose[:3, 3], atol=0.05)


def test_several_tags_by_id():
    tags = [(9, tag_pose(2.2, 0.5)), (2, tag_pose(3.5, -0.9, 1.0)), (41, tag_pose(4.2, 1.0, 2.0))]
    found = DETECTOR.detect(drawn(over(0, 0, 3), tags, noise=2))
    assert [s.tag for s in found.all] == [2, 9, 41]
    assert found.repeated == ()


def test_a_tag_twice_in_one_image_is_told():
    tags = [(7, tag_pose(2.5, 0.6)), (7, tag_pose(3.5, -0.6)), (8, tag_pose(3.5, 0.6))]
    found = DETECTOR.detect(drawn(over(0, 0, 3), tags))
    assert [s.tag for s in found.all] == [7, 7, 8]
    assert found.repeated == (7,)


@pytest.mark.parametrize("seed", range(3))
def test_noise_has_no_tags(seed):
    noise = np.random.default_rng(seed).integers(0, 256, (480, 640)).astype(np.uint8)
    assert DETECTOR.detect(noise).all == ()


def test_a_tag_that_the_edge_cuts_is_not_seen():
    """As the thesis says of its detector (4.3.2)."""
    image = drawn(over(0, 0, 3), [(7, tag_pose(3, 0))])
    (whole,) = DETECTOR.detect(image).all
    cut = image.copy()
    cut[:, int(whole.centre[0]) :] = 110
    assert DETECTOR.detect(cut).all == ()


def test_an_empty_floor_has_no_tags():
    found = DETECTOR.detect(drawn(over(0, 0, 3), []))
    assert (found.all, found.repeated) == ((), ())


def test_a_coloured_image_gives_what_a_grey_one_does():
    image = drawn(over(0, 0, 3), [(7, tag_pose(3, 0))])
    (grey,) = DETECTOR.detect(image).all
    (coloured,) = DETECTOR.detect(np.repeat(image[:, :, None], 3, axis=2)).all
    np.testing.assert_array_equal(grey.corners, coloured.corners)


@pytest.mark.parametrize("wrong", [0, 1, 2, 3])
def test_bits_that_were_read_wrong(wrong):
    picture = tag_image(7, 12)
    for cell in ((2, 3), (5, 5), (7, 2))[:wrong]:
        part = picture[12 * cell[0] :, 12 * cell[1] :][:12, :12]
        part[:] = 255 - part
    scene = np.full((200, 200), 255, dtype=np.uint8)
    scene[40:160, 40:160] = picture
    for most in (0, 1, 2):
        found = TagDetector(DetectorParameters(most_corrected=most)).detect(scene).all
        assert [(s.tag, s.corrected) for s in found] == ([(7, wrong)] if wrong <= most else [])


def test_faint_tags_count_only_if_let():
    image = drawn(over(0, 0, 3), [(7, tag_pose(3, 0))], floor=120)
    faint = (120 + (image.astype(int) - 120) // 24).astype(np.uint8)
    assert DETECTOR.detect(faint).all == ()
    assert [s.tag for s in TagDetector(DetectorParameters(least_margin=0.0)).detect(faint).all] == [7]


@pytest.mark.parametrize(
    ("image", "message"),
    [
        (np.zeros((240, 320), np.uint8), "image: 320 x 240 pixels; expected 640 x 480, as its camera's intrinsics say"),
        (np.zeros((480, 640)), "image: float64; expected uint8"),
        (np.zeros((480, 640, 2), np.uint8), r"image: shape \(480, 640, 2\); expected \(height, width\) or"),
        (np.zeros((0, 640), np.uint8), r"image: shape \(0, 640\); expected \(height, width\) or"),
    ],
)
def test_what_is_no_image_of_this_camera_is_refused(image, message):
    with pytest.raises(ParameterError, match=message):
        DETECTOR.detect(image, VGA)


@pytest.mark.parametrize(
    "wrong", [{"decimate": 0.5}, {"blur_px": -1.0}, {"most_corrected": 3}, {"least_margin": math.nan}]
)
def test_parameters_out_of_range_are_refused(wrong):
    (name,) = wrong
    with pytest.raises(ParameterError, match=rf"{name}: .*; expected"):
        DetectorParameters(**wrong)


@pytest.mark.parametrize(("decimate", "least_px"), [(1.0, 16), (2.0, 24)])
def test_how_small_a_tag_may_be(decimate, least_px):
    """As docs/perception.md says; straight below, so that a tag is as wide everywhere."""
    detector = TagDetector(DetectorParameters(decimate=decimate))
    view = over(0, 0, 3, mount=mount_of([0, 0, 0, 0, math.pi / 2, 0]))
    size = least_px * 3 / VGA.fx
    tags = [(k, tag_pose((k % 3 - 1) * 0.7, (k // 3 - 1) * 0.9, k)) for k in range(9)]
    found = detector.detect(drawn(view, tags, size, noise=3, blur=0.7))
    assert [s.tag for s in found.all] == list(range(9))
