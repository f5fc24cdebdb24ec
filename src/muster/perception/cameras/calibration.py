"""Intrinsics from a calibration file as ROS writes it (`camera_info` of camera_calibration), for a real camera.

    image_width: 640
    image_height: 480
    camera_matrix: {rows: 3, cols: 3, data: [fx, 0, cx, 0, fy, cy, 0, 0, 1]}
    distortion_coefficients: {rows: 1, cols: 5, data: [0, 0, 0, 0, 0]}

OpenCV, with which it is made, has the centre of the first pixel at (0, 0); here it is (0.5, 0.5), so half a pixel is
added to the principal point.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import yaml

from muster.mission.errors import Finding, InputError
from muster.perception.camera import Intrinsics, fault_in

_NUMBERS_OF_LENS = (4, 5, 8, 12, 14)


def read_intrinsics(path: str | Path) -> Intrinsics:
    """Read a calibration file.

    Raises
    ------
    InputError
        if it cannot be read, lacks something, has a number out of its range, or has distortion: images of such a
        lens must be rectified, and then have a calibration file of their own.
    """
    content = _mapping(path)
    width, height = _number(path, content, "image_width"), _number(path, content, "image_height")
    fx, skew, cx, _, fy, cy, *last = _numbers(path, content, "camera_matrix", (9,))
    if skew or last != [0, 0, 1]:
        raise _wrong(path, "camera_matrix", [skew, *last], "no skew, and the last row 0, 0, 1")
    if "distortion_coefficients" in content:
        lens = _numbers(path, content, "distortion_coefficients", _NUMBERS_OF_LENS)
        if any(lens):
            raise _wrong(path, "distortion_coefficients", lens, "all 0: rectify the images before")
    values: dict[str, Any] = {"width": width, "height": height, "fx": fx, "fy": fy, "cx": cx + 0.5, "cy": cy + 0.5}
    if (fault := fault_in(values)) is not None:
        raise _wrong(path, *fault)
    return Intrinsics(**values)


def _mapping(path: str | Path) -> Mapping[str, Any]:
    try:
        content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    except (OSError, UnicodeDecodeError) as error:
        raise _wrong(path, "", getattr(error, "strerror", None) or "not UTF-8", "a file that can be read") from None
    except yaml.YAMLError as error:
        mark = getattr(error, "problem_mark", None)
        raise _wrong(path, "", "no YAML", "a calibration file", mark.line + 1 if mark else None) from None
    if not isinstance(content, dict):
        raise _wrong(path, "", type(content).__name__, "a mapping with image_width, image_height and camera_matrix")
    return content


def _number(path: str | Path, content: Mapping[str, Any], key: str) -> int:
    value = content.get(key)
    if isinstance(value, bool) or not isinstance(value, int):
        raise _wrong(path, key, "missing" if value is None else value, "a whole number of pixels")
    return value


def _numbers(path: str | Path, content: Mapping[str, Any], key: str, lengths: tuple[int, ...]) -> list[float]:
    matrix = content.get(key)
    data = matrix.get("data") if isinstance(matrix, dict) else None
    wanted = f"data: [...] of {' or '.join(map(str, lengths))} numbers"
    if not isinstance(data, list) or len(data) not in lengths:
        raise _wrong(path, key, "missing" if matrix is None else matrix, wanted)
    for value in data:
        if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
            raise _wrong(path, key, value, "a finite number")
    return [float(value) for value in data]


def _wrong(path: str | Path, field: str, value: Any, expected: str, line: int | None = None) -> InputError:
    return InputError([Finding(str(path), line, field, str(value), expected)])
