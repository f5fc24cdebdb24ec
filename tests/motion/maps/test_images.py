"""Images and ROS map files: what is read, and what each broken one is told."""

import struct
import zlib

import numpy as np
import pytest
from PIL import Image

from muster.mission.errors import MissionError
from muster.motion.map_world import World
from muster.motion.maps.images import read_shades

GREY = np.array([[0, 100, 255], [205, 254, 12]], dtype=np.uint8)


def test_every_kind_of_image_has_the_same_shades(tmp_path):
    shades = GREY / 255
    Image.fromarray(GREY).convert("P").save(tmp_path / "palette.png")
    Image.fromarray(GREY).save(tmp_path / "grey.png")
    Image.fromarray(GREY).convert("RGB").save(tmp_path / "colour.png")
    Image.fromarray(GREY).convert("RGBA").save(tmp_path / "opaque.png")
    Image.fromarray(GREY.astype(np.uint16) * 257).save(tmp_path / "deep.png")
    (tmp_path / "p5.pgm").write_bytes(b"P5\n# by hand\n3 2\n255\n" + GREY.tobytes())
    (tmp_path / "p2.pgm").write_text(
        "P2 # by hand\n3 2 255\n" + " ".join(map(str, GREY.ravel())) + "\n", encoding="ascii"
    )
    deep = (GREY.astype(np.uint16) * 257).astype(">u2").tobytes()
    (tmp_path / "deep.pgm").write_bytes(b"P5 3 2 65535\n" + deep)
    for path in sorted(tmp_path.iterdir()):
        np.testing.assert_allclose(read_shades(path), shades, atol=1e-12, err_msg=path.name)


def test_a_colour_is_the_mean_of_its_channels_and_what_is_not_opaque_is_nothing(tmp_path):
    pixels = np.array([[[255, 0, 0, 255], [255, 255, 255, 254], [30, 60, 90, 255]]], dtype=np.uint8)
    Image.fromarray(pixels).save(tmp_path / "colours.png")
    np.testing.assert_allclose(read_shades(tmp_path / "colours.png"), [[1 / 3, np.nan, 60 / 255]])


def test_one_bit_images_are_black_and_white(tmp_path):
    Image.fromarray(np.array([[True, False]])).save(tmp_path / "bits.png")
    assert read_shades(tmp_path / "bits.png").tolist() == [[1.0, 0.0]]


ROS = "image: floor.pgm\nresolution: 0.5\norigin: [1, 2, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n"


def floor(folder, text=ROS, grey=GREY):
    folder.joinpath("floor.yaml").write_text(text, encoding="utf-8")
    rows, columns = grey.shape
    folder.joinpath("floor.pgm").write_bytes(b"P5 %d %d 255\n" % (columns, rows) + grey.tobytes())


@pytest.mark.parametrize(
    ("changes", "free"),
    [
        ({}, [[False, True, False], [False, False, True]]),
        ({"negate: 0": "negate: true"}, [[False, False, True], [True, False, False]]),
        ({"free_thresh: 0.196": "free_thresh: 0.25"}, [[True, True, False], [False, False, True]]),
        ({"negate: 0": "negate: 0\nmode: scale"}, [[False, True, False], [False, False, True]]),
        ({"negate: 0": "negate: 0\nmode: raw"}, [[False, False, True], [True, False, False]]),
    ],
)
def test_free_is_what_lies_below_the_threshold(mission_with, tmp_path, changes, free):
    """The lowest row is the image's last: 205, 254, 12. In raw mode 12 is 12 %, 100 is occupied, 205 is unknown."""
    text = ROS
    for old, new in changes.items():
        text = text.replace(old, new)
    floor(tmp_path, text)
    grid = World.of(mission_with("{ros_yaml: floor.yaml}")).image
    assert (~grid.blocked).tolist() == free
    assert (grid.resolution_m, grid.origin) == (0.5, (1.0, 2.0, 0.0))


def test_an_image_without_ros_has_the_thresholds_that_ros_writes(mission_with, tmp_path):
    floor(tmp_path)
    grid = World.of(mission_with("{image: floor.pgm, resolution_m: 0.1, origin: [3, 4, 0.5]}")).image
    assert (~grid.blocked).tolist() == [[False, True, False], [False, False, True]]
    assert (grid.resolution_m, grid.origin) == (0.1, (3.0, 4.0, 0.5))
    assert World.of(mission_with("{image: floor.pgm, resolution_m: 0.1}")).image.origin == (0.0, 0.0, 0.0)


def test_keys_that_ros_does_not_know_are_passed_over(mission_with, tmp_path):
    floor(tmp_path, ROS + "floor_name: cellar\n")
    assert World.of(mission_with("{ros_yaml: floor.yaml}")).image.shape == (2, 3)


@pytest.mark.parametrize(
    ("line", "becomes", "told"),
    [
        ("resolution: 0.5\n", "", "floor.yaml:1: resolution: missing; expected a finite number, above 0"),
        ("0.5", "0", "floor.yaml:2: resolution: 0; expected a finite number, above 0"),
        ("0.5", "fine", 'floor.yaml:2: resolution: "fine"; expected a finite number, above 0'),
        ("image: floor.pgm\n", "", "floor.yaml:1: image: missing; expected a text of one line"),
        ("[1, 2, 0]", "[1, 2]", "floor.yaml:3: origin: [1, 2]; expected [x, y, yaw] in metres and radians"),
        ("[1, 2, 0]", "[1, x, 0]", 'floor.yaml:3: origin[1]: "x"; expected a finite number'),
        ("negate: 0", "negate: 2", "floor.yaml:4: negate: 2; expected 0 or 1"),
        ("0.196", "1.96", "floor.yaml:6: free_thresh: 1.96; expected a finite number, at least 0 and at most 1"),
        ("0.196", "0.7", "floor.yaml:6: free_thresh: 0.7; expected a number of at most occupied_thresh (0.65)"),
        (
            "negate: 0",
            "negate: 0\nmode: Trinary",
            'floor.yaml:5: mode: "Trinary"; expected trinary or scale or raw; did you mean',
        ),
        (ROS, "- 1\n", "floor.yaml:1: [1]; expected a map of ROS with the keys image, resolution, origin, negate"),
        (ROS, "", "floor.yaml:1: empty; expected a map of ROS with the keys image"),
        ("floor.pgm", "attic.pgm", "attic.pgm: No such file or directory; expected an image in PNG or PGM (P2 or P5)"),
        ("[1, 2, 0]", "[1e12, 2, 0]", "a map that reaches 1e+12 m; expected coordinates up to 1e+09 m"),
    ],
)
def test_what_is_wrong_with_a_ros_map(mission_with, tmp_path, line, becomes, told):
    floor(tmp_path, ROS.replace(line, becomes))
    (message,) = refusal(mission_with("{ros_yaml: floor.yaml}"))
    start = f"{tmp_path / 'm.yaml'}:4: map.ros_yaml: "
    assert message.startswith(start)
    assert message.removeprefix(start).replace(f"{tmp_path}/", "").startswith(told)


def chunk(kind, data):
    return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))


def png_bytes(width=2, height=2, data=b"\0\0\0\0\0\0"):
    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(data)) + chunk(b"IEND", b"")


@pytest.mark.parametrize(
    ("content", "told"),
    [
        (b"\xff\xd8\xff\xe0 JFIF", "a JPEG image; expected an image in PNG or PGM (P2 or P5)"),
        (b"GIF89a", "a GIF image; expected"),
        (b"RIFF....WEBPVP8", "a WebP image; expected"),
        (b"P6 1 1 255\nabc", "a PPM image; expected"),
        (b"walls: here\n", "a text file; expected"),
        (b"\x00\x01\x02\x90", "a file of another kind; expected"),
        (b"", "an empty file; expected"),
        (png_bytes()[:45], "a broken PNG ("),
        (png_bytes()[:20], "a broken PNG ("),
        (png_bytes().replace(b"IDAT", b"IDAX"), "a broken PNG ("),
        (b"P5 4 4 255\nabc", "a broken PGM ("),
        (b"P2 2 2 255\n1 2 3", "a broken plain PGM (3 pixels of 2 x 2); expected"),
        (b"P2 2 2 255\n1 2 3 x", "a broken plain PGM ("),
        (b"P2 2 2 255\n1 2 3 256", "a broken plain PGM (a pixel beyond 0 to 255); expected"),
        (b"P2 2 2 255\n1 2 3 -4", "a broken plain PGM (a pixel beyond 0 to 255); expected"),
        (b"P2 2 0 255\n1", "a broken plain PGM (2 x 0 pixels up to 255); expected"),
        (b"P2 2 2", "a broken plain PGM ("),
        (b"P2 90000 90000 255\n1", "too many pixels; expected an image of at most 89 million pixels"),
        (b"P5 0 4 255\n", "a broken PGM ("),
        (b"P5", "a broken PGM ("),
        (png_bytes(width=100000, height=100000), "too many pixels; expected an image of at most 89 million pixels"),
    ],
)
def test_what_is_wrong_with_an_image(mission_with, tmp_path, content, told):
    tmp_path.joinpath("floor.png").write_bytes(content)
    (message,) = refusal(mission_with("{image: floor.png, resolution_m: 0.1}"))
    start = f"{tmp_path / 'm.yaml'}:4: map.image: {tmp_path / 'floor.png'}: "
    assert message.startswith(start + told)


def test_an_image_that_is_a_folder(mission_with, tmp_path):
    tmp_path.joinpath("floor.png").mkdir()
    (message,) = refusal(mission_with("{image: floor.png, resolution_m: 0.1}"))
    assert "Is a directory; expected an image in PNG or PGM" in message


def refusal(mission):
    with pytest.raises(MissionError) as caught:
        World.of(mission)
    return str(caught.value).splitlines()
