"""The detector of AprilTags by the tags' authors, from apriltag-python, and the codes of the family, from OpenCV."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from muster.perception.optional_parts import require_physics

FAMILY = "tag36h11"


def new_detector(purpose: str, *, decimate: float, blur_px: float, most_corrected: int) -> Any:
    """An `apriltag.apriltag` of the family 36h11; parameters as those of `detection.DetectorParameters`.

    Raises
    ------
    MissingExtraError
        if apriltag-python or OpenCV is not installed; it names `purpose`.
    """
    require_physics(purpose, "cv2", "apriltag")
    from apriltag import apriltag

    return apriltag(FAMILY, threads=1, maxhamming=most_corrected, decimate=decimate, blur=blur_px)


def black_squares() -> npt.NDArray[np.uint8]:
    """All tags of the family, (n, 8, 8), upright: 1 where a cell is white.

    OpenCV has them half a turn about.

    Raises
    ------
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics("a picture of a tag", "cv2")
    import cv2

    family = cv2.aruco.getPredefinedDictionary(cv2.aruco.DICT_APRILTAG_36h11)
    side = family.markerSize + 2
    pictures = [family.generateImageMarker(tag, side) for tag in range(len(family.bytesList))]
    return (np.rot90(np.array(pictures), 2, axes=(1, 2)) > 0).astype(np.uint8)
