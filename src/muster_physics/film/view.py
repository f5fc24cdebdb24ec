"""The camera of a film: oblique from above, as near as possible with the whole mission in the picture."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from muster.motion.grid import Floats

TILT = math.radians(52)
"""By how much the camera looks down."""
HALF_ANGLE = math.radians(15)
"""Half the field of view, upright."""
_NEARER, _FARTHER = 0.5, 3.0
"""What is seen, as shares of the distance."""


@dataclass(frozen=True)
class Frame:
    """A picture's size in pixels, and the margins at its edges."""

    width: int
    height: int
    left: int
    right: int
    top: int
    bottom: int


@dataclass(frozen=True, eq=False)
class View:
    """A camera that does not move.

    Parameters
    ----------
    position, axes
        (3,) metres, and x to the right, y down, z ahead as the columns of (3, 3), in the map frame.
    focal_px, width, height
        of its picture, in pixels; the axis meets it in the middle.
    pixel_m
        the width of a pixel, metres, in the middle of the picture.
    """

    position: Floats
    axes: Floats
    focal_px: float
    width: int
    height: int
    pixel_m: float

    @property
    def depth_m(self) -> tuple[float, float]:
        """The least and the greatest distance along the axis."""
        distance = self.pixel_m * self.focal_px
        return _NEARER * distance, _FARTHER * distance

    def pixels(self, places: Floats) -> Floats:
        """The pixels (n, 2), from the picture's upper left corner, of places (n, 3)."""
        seen = (places - self.position) @ self.axes
        middle = np.array([self.width, self.height]) / 2
        found: Floats = middle + self.focal_px * seen[:, :2] / seen[:, 2:]
        return found


def view_of(places: Floats, frame: Frame) -> View:
    """The nearest view from the south, or from the east if the places reach farther from south to north.

    Each side of the picture keeps the camera behind a plane through one of the places; where it is behind all four and
    foremost, in the middle of the room that is left, there it stands.

    Parameters
    ----------
    places
        (n, 3) metres, not all the same: what has to be in the picture, within what is kept free.
    """
    wide, long = np.ptp(places[:, :2], axis=0)
    axes = _axes(math.pi / 2 if wide >= long else math.pi)
    focal = frame.height / 2 / math.tan(HALF_ANGLE)
    turned = places @ axes
    slopes = (
        np.array(
            [
                [frame.width / 2 - frame.left, frame.width / 2 - frame.right],
                [frame.height / 2 - frame.top, frame.height / 2 - frame.bottom],
            ]
        )
        / focal
    )
    bounds = []
    for k in range(2):
        least = (turned[:, k] + slopes[k, 0] * turned[:, 2]).min()  # x <= least - slope z
        most = (turned[:, k] - slopes[k, 1] * turned[:, 2]).max()
        bounds.append((least, most))
    ahead = min((bounds[k][0] - bounds[k][1]) / slopes[k].sum() for k in range(2))
    across, down = ((bounds[k][0] - slopes[k, 0] * ahead + bounds[k][1] + slopes[k, 1] * ahead) / 2 for k in range(2))
    distance = float(turned[:, 2].mean() - ahead)
    position = axes @ np.array([across, down, ahead])
    return View(position, axes, focal, frame.width, frame.height, distance / focal)


def _axes(ahead: float) -> Floats:
    """The axes of a camera that looks down towards the map's angle `ahead`."""
    c, s = math.cos(ahead), math.sin(ahead)
    right = np.array([s, -c, 0.0])
    forward = np.array([c * math.cos(TILT), s * math.cos(TILT), -math.sin(TILT)])
    return np.column_stack([right, np.cross(forward, right), forward])
