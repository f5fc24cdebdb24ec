"""Images of floors: PNG (grey, colour, palette) and PGM (P2, P5), of 8 or 16 bits, as shades of grey."""

from __future__ import annotations

import re
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, MissionError
from muster.mission.values.arrays import Floats
from muster.mission.yaml_writer import YAML_SUFFIXES

_EXPECTED = "an image in PNG or PGM (P2 or P5)"
_READ = {b"\x89PNG\r\n\x1a\n": "PNG", b"P2": "plain PGM", b"P5": "PGM"}
_KNOWN = {
    b"\xff\xd8\xff": "a JPEG image",
    b"GIF8": "a GIF image",
    b"BM": "a BMP image",
    b"II*\0": "a TIFF image",
    b"MM\0*": "a TIFF image",
    b"RIFF": "a WebP image",
    b"%PDF": "a PDF document",
    b"P1": "a PBM image",
    b"P4": "a PBM image",
    b"P3": "a PPM image",
    b"P6": "a PPM image",
}


class _TooLargeError(Exception):
    """A plain PGM of too many pixels."""


def read_shades(path: Path) -> Floats:
    """The shades of an image: (rows, columns), the top row first, from 0 (black) to 1 (white).

    A colour is the mean of its three channels; what is not opaque is NaN.

    Raises
    ------
    MissionError
        if there is no such file, if it is no image of the kinds above, or broken.
    """
    form = _form(path)
    from PIL import Image

    try:
        if form == "plain PGM":
            return _plain_pgm(path.read_bytes(), Image.MAX_IMAGE_PIXELS or 0)
        with warnings.catch_warnings():
            warnings.simplefilter("error", Image.DecompressionBombWarning)
            with Image.open(path, formats=("PNG", "PPM")) as image:
                image.load()
                return _shades(image)
    except (_TooLargeError, Image.DecompressionBombWarning, Image.DecompressionBombError):
        limit = (Image.MAX_IMAGE_PIXELS or 0) // 10**6
        raise _refusal(path, "too many pixels", f"an image of at most {limit} million pixels") from None
    except Exception as error:  # Pillow's decoders raise whatever a broken file leads them to
        raise _refusal(path, f"a broken {form} ({error})", f"{_EXPECTED} that can be read to its end") from None


def image_kind(path: Path) -> str | None:
    """`a PNG image`, `a JPEG image`, ... where a file is an image, be it of a kind that is not read; else None."""
    try:
        head = _head(path)
    except (OSError, ValueError):
        return None
    known = {magic: f"a {form} image" for magic, form in _READ.items()} | _KNOWN
    return next((kind for magic, kind in known.items() if head.startswith(magic)), None)


def _head(path: Path) -> bytes:
    with path.open("rb") as file:
        return file.read(4096)


def _form(path: Path) -> str:
    try:
        head = _head(path)
    except (OSError, ValueError) as error:
        raise _refusal(path, getattr(error, "strerror", None) or str(error), _EXPECTED) from None
    form = next((form for magic, form in _READ.items() if head.startswith(magic)), None)
    if form is None:
        hint = "; for a map file of ROS the key is ros_yaml" if path.suffix in YAML_SUFFIXES else ""
        raise _refusal(path, _described(head), _EXPECTED + hint)
    return form


def _described(head: bytes) -> str:
    if not head:
        return "an empty file"
    known = next((name for magic, name in _KNOWN.items() if head.startswith(magic)), None)
    try:
        head[:64].decode("ascii")
    except UnicodeDecodeError:
        return known or "a file of another kind"
    return known or "a text file"


def _shades(image: Any) -> Floats:
    """A loaded image of Pillow as shades."""
    if image.mode.startswith("I"):  # 16 bits; of a PGM scaled to them
        return np.asarray(image, dtype=np.float64) / 65535
    if image.mode in ("LA", "PA", "RGBA") or "transparency" in image.info:
        channels = np.asarray(image.convert("RGBA"))
        return np.where(channels[..., 3] == 255, _mean(channels), np.nan)
    if image.mode in ("1", "L"):
        return np.asarray(image.convert("L"), dtype=np.float64) / 255
    return _mean(np.asarray(image.convert("RGB")))


def _plain_pgm(data: bytes, most_pixels: int) -> Floats:
    """A PGM written in decimals (P2), which Pillow reads a pixel at a time; ValueError where it is broken."""
    _, width, height, greatest, raster = re.sub(rb"#[^\r\n]*", b" ", data).split(None, 4)
    columns, rows, white = int(width), int(height), int(greatest)
    if rows * columns > most_pixels:
        raise _TooLargeError
    if not (rows > 0 and columns > 0 and 0 < white < 65536):
        raise ValueError(f"{columns} x {rows} pixels up to {white}")
    with warnings.catch_warnings():
        warnings.simplefilter("error", DeprecationWarning)  # what NumPy says of text that is no number
        values = np.fromstring(raster, dtype=np.int64, sep=" ")
    if len(values) != rows * columns:
        raise ValueError(f"{len(values)} pixels of {columns} x {rows}")
    if values.min() < 0 or values.max() > white:
        raise ValueError(f"a pixel beyond 0 to {white}")
    return values.reshape(rows, columns) / white


def _mean(channels: npt.NDArray[np.uint8]) -> Floats:
    means: Floats = channels[..., :3].sum(axis=2, dtype=np.uint16) / 765.0
    return means


def _refusal(path: Path, value: str, expected: str) -> MissionError:
    return MissionError([Finding(str(path), None, "", value, expected)])
