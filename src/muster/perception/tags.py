"""Pictures of AprilTags of the family 36h11.

A tag is 8 x 8 cells, black around 6 x 6 cells of code; a white margin, one cell wide, belongs to it. The size of a tag
is the side of its black square, 0.8 of the side of the picture. The tag's frame has its origin in the middle, x to the
right of the picture, y down and z into it, as the image frame of a camera before which it hangs upright.
"""

from __future__ import annotations

import math
from functools import cache

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.motion.frames import pose_transform
from muster.perception.cameras.apriltag import FAMILY, black_squares

CELLS, CELLS_OF_PICTURE = 8, 10
"""Across the black square; across the picture, with the margin."""

CORNERS = np.array([[-0.5, -0.5, 0.0], [0.5, -0.5, 0.0], [0.5, 0.5, 0.0], [-0.5, 0.5, 0.0]])
"""(4, 3) of a tag of size 1 in its own frame: upper left, upper right, lower right, lower left."""


def tag_count() -> int:
    """How many tags the family has: ids are 0 to one less.

    Raises
    ------
    MissingExtraError
        if OpenCV is not installed.
    """
    return len(_cells())


def tag_image(tag: int, cell_px: int = 8) -> npt.NDArray[np.uint8]:
    """Draw a tag with its margin: (10 cell_px, 10 cell_px) of 0 and 255.

    Raises
    ------
    ParameterError
        if the family has no such tag, or a cell has no pixel.
    MissingExtraError
        if OpenCV is not installed.
    """
    if not 0 <= tag < tag_count():
        raise ParameterError(f"tag: {tag}; expected 0 to {tag_count() - 1}, the ids of {FAMILY}")
    if cell_px < 1:
        raise ParameterError(f"cell_px: {cell_px}; expected a whole number of pixels of at least 1")
    return np.kron(_cells()[tag], np.full((cell_px, cell_px), 255, dtype=np.uint8))


def tag_pose(position: npt.ArrayLike, heading: float) -> npt.NDArray[np.float64]:
    """The pose (4, 4) of a tag that lies face up, of its middle (2,) or (3,) and the direction of its upper edge."""
    x, y, z = (*np.asarray(position, dtype=np.float64), 0.0)[:3]
    return pose_transform([x, y, z, math.pi, 0.0, heading - math.pi / 2])


@cache
def _cells() -> npt.NDArray[np.uint8]:
    """All tags (n, 10, 10): 1 where a cell is white."""
    return np.pad(black_squares(), ((0, 0), (1, 1), (1, 1)), constant_values=1)
