"""Images from files, films and cameras; intrinsics from a calibration file."""

import numpy as np
import pytest

from muster.mission.errors import InputError

pytest.importorskip("cv2")
import cv2

from muster.perception.cameras.calibration import read_intrinsics
from muster.perception.cameras.images import grey, images_from, read_image

CALIBRATION = """\
image_width: 640
image_height: 480
camera_name: front
camera_matrix: {rows: 3, cols: 3, data: [500.5, 0, 319.5, 0, 499.5, 239.5, 0, 0, 1]}
distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}
"""


def test_an_image_file_is_read_as_red_green_blue(tmp_path):
    image = np.zeros((20, 30, 3), dtype=np.uint8)
    image[:, :10, 0], image[:, 10:20, 1], image[:5, 20:, 2] = 200, 150, 100
    cv2.imwrite(str(tmp_path / "a.png"), image[:, :, ::-1])
    np.testing.assert_array_equal(read_image(tmp_path / "a.png"), image)


def test_a_grey_image_file_gets_three_equal_colours(tmp_path):
    image = np.arange(200, dtype=np.uint8).reshape(10, 20)
    cv2.imwrite(str(tmp_path / "a.png"), image)
    np.testing.assert_array_equal(grey(read_image(tmp_path / "a.png")), image)


def test_a_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"none\.png: No such file or directory; expected a file that can be read"):
        read_image(tmp_path / "none.png")


@pytest.mark.parametrize("content", [b"", b"not an image"])
def test_a_file_that_is_no_image(tmp_path, content):
    (tmp_path / "a.png").write_bytes(content)
    with pytest.raises(InputError, match=r"a\.png: no image; expected an image file, like PNG or JPEG"):
        read_image(tmp_path / "a.png")


def test_a_film_comes_image_by_image(tmp_path):
    path = tmp_path / "film.avi"
    writer = cv2.VideoWriter(str(path), cv2.VideoWriter.fourcc(*"MJPG"), 10, (64, 48))
    for level in (40, 120, 200):
        writer.write(np.full((48, 64, 3), (0, level // 2, level), dtype=np.uint8))
    writer.release()
    images = list(images_from(path))
    assert [image.shape for image in images] == [(48, 64, 3)] * 3
    for image, level in zip(images, (40, 120, 200), strict=True):
        np.testing.assert_allclose(image.mean(axis=(0, 1)), [level, level // 2, 0], atol=4)


def test_a_film_that_is_none(tmp_path):
    with pytest.raises(InputError, match=r"none\.avi: cannot be opened; expected a film"):
        next(images_from(tmp_path / "none.avi"))


def test_a_camera_that_is_not_there():
    with pytest.raises(InputError, match="camera 99: cannot be opened; expected the number of a camera"):
        next(images_from(99))


def test_a_calibration_file(tmp_path):
    (tmp_path / "c.yaml").write_text(CALIBRATION)
    found = read_intrinsics(tmp_path / "c.yaml")
    assert (found.width, found.height, found.fx, found.fy, found.cx, found.cy) == (640, 480, 500.5, 499.5, 320, 240)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("image_width: 640", "", "image_width: missing; expected a whole number of pixels"),
        ("image_width: 640", "image_width: 6.5", "image_width: 6.5; expected a whole number of pixels"),
        ("camera_matrix", "matrix", r"camera_matrix: missing; expected data: \[...\] of 9 numbers"),
        ("500.5, 0, ", "", r"camera_matrix: .*; expected data: \[...\] of 9 numbers"),
        ("500.5", "many", "camera_matrix: many; expected a finite number"),
        ("500.5", ".nan", "camera_matrix: nan; expected a finite number"),
        ("500.5", "0", "fx: 0.0; expected a focal length above 0, in pixels"),
        ("319.5", "900", "cx: 900.5; expected a principal point within the picture, 0 to 640"),
        ("500.5, 0,", "500.5, 3,", r"camera_matrix: \[3.0, 0.0, 0.0, 1.0\]; expected no skew"),
        ("[0, 0, 0, 0, 0]", "[-0.3, 0, 0, 0, 0]", "expected all 0: rectify the images before"),
        ("image_width", "[", "no YAML; expected a calibration file"),
        (CALIBRATION, "- 3", "list; expected a mapping with image_width"),
    ],
)
def test_a_calibration_file_that_is_wrong(tmp_path, old, new, message):
    (tmp_path / "c.yaml").write_text(CALIBRATION.replace(old, new, 1))
    with pytest.raises(InputError, match=r"c\.yaml.*" + message):
        read_intrinsics(tmp_path / "c.yaml")


def test_a_calibration_file_that_is_not_there(tmp_path):
    with pytest.raises(InputError, match=r"c\.yaml: No such file or directory; expected a file that can be read"):
        read_intrinsics(tmp_path / "c.yaml")
