"""Images and intrinsics in the form of ROS' sensor_msgs/Image and CameraInfo, for both versions of ROS.

ROS has the centre of the first pixel at (0, 0), as OpenCV has; here it is (0.5, 0.5), so half a pixel is added to the
principal point.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.mission.errors import ParameterError
from muster.perception.camera import Intrinsics
from muster.perception.cameras.images import Image

_CHANNELS = {
    "mono8": (0,),
    "8UC1": (0,),
    "rgb8": (0, 1, 2),
    "bgr8": (2, 1, 0),
    "8UC3": (2, 1, 0),
    "rgba8": (0, 1, 2, 3),
    "bgra8": (2, 1, 0, 3),
}
"""Where red, green and blue (and alpha) are in a pixel of an encoding; one channel is grey."""


def image_of(encoding: str, height: int, width: int, step: int, data: bytes) -> Image:
    """An image, (height, width) grey or (height, width, 3) RGB.

    Parameters
    ----------
    step
        bytes of a row.

    Raises
    ------
    ParameterError
        if the encoding is not known here, or the data are not of that size.
    """
    if encoding not in _CHANNELS:
        raise ParameterError(f"encoding: {encoding}; expected {', '.join(_CHANNELS)}")
    order = _CHANNELS[encoding]
    if height < 1 or width < 1 or step < width * len(order) or len(data) != height * step:
        raise ParameterError(f"data: {len(data)} bytes; expected {height} rows of {step}, each of {width} pixels")
    rows = np.frombuffer(data, dtype=np.uint8).reshape(height, step)[:, : width * len(order)]
    if len(order) == 1:
        return np.ascontiguousarray(rows)
    return np.ascontiguousarray(rows.reshape(height, width, len(order))[:, :, order[:3]])


def intrinsics_of(width: int, height: int, matrix: Sequence[float], distortion: Sequence[float]) -> Intrinsics:
    """The intrinsics of a CameraInfo: K (9,) by rows, and D.

    Raises
    ------
    ParameterError
        if there are none, or the lens has distortion: its images must be rectified before.
    """
    if len(matrix) != 9 or matrix[0] == 0:
        raise ParameterError("K: all 0; expected the camera's calibration")
    if any(distortion):
        raise ParameterError(f"D: {list(distortion)}; expected all 0: rectified images")
    fx, _, cx, _, fy, cy, *_ = map(float, matrix)
    return Intrinsics(width=int(width), height=int(height), fx=fx, fy=fy, cx=cx + 0.5, cy=cy + 0.5)


def matrix_of(intrinsics: Intrinsics) -> list[float]:
    """K (9,) by rows; the inverse of `intrinsics_of`."""
    i = intrinsics
    return [i.fx, 0.0, i.cx - 0.5, 0.0, i.fy, i.cy - 0.5, 0.0, 0.0, 1.0]
