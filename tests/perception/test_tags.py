"""Pictures of tags: form, distance between codes, and that the detector reads each as what it is."""

import numpy as np
import pytest

from muster.mission.errors import MissingExtraError, ParameterError

pytest.importorskip("apriltag")
pytest.importorskip("cv2")
from muster.perception import tags
from muster.perception.detection import TagDetector


@pytest.fixture(scope="module")
def detector():
    return TagDetector()


def code(tag):
    return tags.tag_image(tag, 1)[2:-2, 2:-2] > 0


def test_a_picture_is_a_white_margin_a_black_ring_and_the_code():
    for tag in (0, 300, tags.tag_count() - 1):
        picture = tags.tag_image(tag, 3)
        assert picture.shape == (30, 30)
        assert set(np.unique(picture)) == {0, 255}
        ring = np.ones((10, 10), dtype=bool)
        ring[1:-1, 1:-1] = False
        cells = picture[1::3, 1::3]
        assert (cells[ring] == 255).all()
        inner = cells[1:-1, 1:-1]
        assert (np.concatenate([inner[0], inner[-1], inner[:, 0], inner[:, -1]]) == 0).all()
        assert (np.kron(cells, np.ones((3, 3), dtype=np.uint8)) == picture).all()


def test_codes_differ_in_11_bits_or_more_however_turned():
    """What 36h11 means."""
    assert tags.tag_count() == 587
    codes = np.array([code(tag) for tag in range(tags.tag_count())])
    upright = codes.reshape(len(codes), -1).astype(np.int64)
    for quarters in range(4):
        turned = np.rot90(codes, quarters, axes=(1, 2)).reshape(len(codes), -1).astype(np.int64)
        differ = upright @ (1 - turned).T + (1 - upright) @ turned.T
        if quarters == 0:
            np.fill_diagonal(differ, 36)
        assert differ.min() >= 11


def test_the_detector_reads_what_is_drawn(detector):
    shown = list(range(0, 587, 25))
    scene = np.full((600, 720), 255, dtype=np.uint8)
    for place, tag in enumerate(shown):
        row, column = divmod(place, 6)
        scene[20 + 140 * row :, 10 + 115 * column :][:100, :100] = tags.tag_image(tag, 10)
    found = detector.detect(scene)
    assert [s.tag for s in found.all] == shown
    for place, sighting in enumerate(found.all):
        row, column = divmod(place, 6)
        middle = [60 + 115 * column, 70 + 140 * row]
        np.testing.assert_allclose(sighting.centre, middle, atol=0.5)
        square = [[-40, -40], [40, -40], [40, 40], [-40, 40]]
        np.testing.assert_allclose(sighting.corners - middle, square, atol=0.5)


@pytest.mark.parametrize("tag", [-1, 587])
def test_a_tag_that_is_not_there_is_refused(tag):
    with pytest.raises(ParameterError, match=f"tag: {tag}; expected 0 to 586, the ids of tag36h11"):
        tags.tag_image(tag)


def test_a_cell_has_a_pixel_at_least():
    with pytest.raises(ParameterError, match="cell_px: 0; expected a whole number of pixels of at least 1"):
        tags.tag_image(3, 0)


@pytest.mark.parametrize("module", ["cv2", "apriltag"])
def test_without_the_extra_one_line_says_what_to_install(module, monkeypatch):
    monkeypatch.setitem(__import__("sys").modules, module, None)
    with pytest.raises(MissingExtraError) as caught:
        TagDetector()
    assert str(caught.value) == "detecting tags needs an optional part: pip install 'muster-robotics[physics]'"
