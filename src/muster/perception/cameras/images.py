"""Images: from arrays, files, films and cameras. An image is (height, width) grey or (height, width, 3) RGB, uint8."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import numpy.typing as npt

from muster.mission.errors import Finding, InputError, ParameterError
from muster.perception.camera import Intrinsics
from muster.perception.optional_parts import require_physics

Image = npt.NDArray[np.uint8]

_PURPOSE = "reading images"


def grey(image: Image, intrinsics: Intrinsics | None = None) -> Image:
    """The grey image (height, width) of an image; a grey one is returned as it is.

    Raises
    ------
    ParameterError
        if it is no image, or not of the size that its camera's intrinsics say.
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics(_PURPOSE, "cv2")
    import cv2

    array = np.asarray(image)
    if array.dtype != np.uint8:
        raise ParameterError(f"image: {array.dtype}; expected uint8")
    if array.size == 0 or not (array.ndim == 2 or (array.ndim == 3 and array.shape[2] == 3)):
        raise ParameterError(f"image: shape {array.shape}; expected (height, width) or (height, width, 3)")
    height, width = array.shape[:2]
    if intrinsics is not None and (width, height) != (intrinsics.width, intrinsics.height):
        right = f"{intrinsics.width} x {intrinsics.height}"
        raise ParameterError(f"image: {width} x {height} pixels; expected {right}, as its camera's intrinsics say")
    return array if array.ndim == 2 else np.asarray(cv2.cvtColor(array, cv2.COLOR_RGB2GRAY), dtype=np.uint8)


def read_image(path: str | Path) -> Image:
    """Read an image file, of any form that OpenCV knows, as RGB: (height, width, 3).

    Raises
    ------
    InputError
        if there is no such file, or no image in it.
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics(_PURPOSE, "cv2")
    import cv2

    try:
        data = np.frombuffer(Path(path).read_bytes(), dtype=np.uint8)
    except OSError as error:
        raise _wrong(path, error.strerror or str(error), "a file that can be read") from None
    image = cv2.imdecode(data, cv2.IMREAD_COLOR_RGB) if data.size else None
    if image is None:
        raise _wrong(path, "no image", "an image file, like PNG or JPEG")
    return np.asarray(image, dtype=np.uint8)


def images_from(source: int | str | Path) -> Iterator[Image]:
    """Images (height, width, 3), RGB, as they come: of a film (a file), or of a camera (its number, from 0).

    A film ends; a camera goes on until it is unplugged. Closing the iterator lets the camera go.

    Raises
    ------
    InputError
        at the first image, if there is no such film or camera.
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics(_PURPOSE, "cv2")
    import cv2

    capture = cv2.VideoCapture(source if isinstance(source, int) else str(source))
    try:
        if not capture.isOpened():
            is_camera = isinstance(source, int)
            raise _wrong(source, "cannot be opened", "the number of a camera" if is_camera else "a film")
        while (taken := capture.read())[0]:
            yield np.asarray(cv2.cvtColor(taken[1], cv2.COLOR_BGR2RGB), dtype=np.uint8)
    finally:
        capture.release()


def _wrong(source: int | str | Path, value: str, expected: str) -> InputError:
    place = f"camera {source}" if isinstance(source, int) else str(source)
    return InputError([Finding(place, None, "", value, expected)])
