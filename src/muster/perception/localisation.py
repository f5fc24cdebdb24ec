"""Positions on the map of what a camera sees: [tcf-thesis] (4.41)-(4.45).

`on_ground` assumes flat ground, (4.41)-(4.43). `by_size` uses the known size of a tag and needs no ground: it finds
the tag's pose from the image of its four corners (perspective-n-point). OpenCV's own method for squares,
`SOLVEPNP_IPPE_SQUARE`, is not used: on exact corners it gives NaN for many poses (5.0).

`by_length_as_printed` is (4.44) and (4.45), which the thesis proposes for that. It is kept to show its error (table
`sizes` of study thesis-6.1): a tag seen aslant looks shorter, so that it is placed too far away; and L f / l is the
depth along the optical axis, which the thesis takes for the distance along the ray, so that what is off the axis is
placed too near.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.frames import moved, transform
from muster.perception.camera import View
from muster.perception.optional_parts import require_physics
from muster.perception.tags import CORNERS


def on_ground(view: View, pixels: npt.ArrayLike, ground_m: float = 0.0) -> Floats:
    """(4.41)-(4.43): the places (n, 3) on the plane z = `ground_m` of the map that are at pixels (n, 2).

    NaN where the ray does not meet the plane before the camera.
    """
    ways = view.rays(pixels)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (ground_m - view.position[2]) / ways[:, 2:]  # (4.42)
    ahead = (distance > 0) & np.isfinite(distance)
    places = view.position + np.where(ahead, distance, np.nan) * ways
    places[:, 2] = np.where(ahead[:, 0], ground_m, np.nan)
    return np.asarray(places)


@dataclass(frozen=True, kw_only=True)
class Uncertainty:
    """Standard deviations of what goes into an estimate: of pixels, the robot's place and its attitude, each axis."""

    pixel_px: float = 0.5
    position_m: float = 0.0
    angle_rad: float = 0.0

    def __post_init__(self) -> None:
        if not self.pixel_px > 0:
            raise ParameterError(f"pixel_px: {self.pixel_px}; expected above 0")
        for name in ("position_m", "angle_rad"):
            if not (value := getattr(self, name)) >= 0:
                raise ParameterError(f"{name}: {value}; expected at least 0")


def ground_covariance(
    view: View, pixels: npt.ArrayLike, uncertainty: Uncertainty, ground_m: float = 0.0
) -> npt.NDArray[np.float64]:
    """To first order, the covariances (n, 2, 2), m^2, of the x and y of `on_ground`.

    A turn of the robot is taken about the camera: what it moves the camera by is left to `position_m`.
    """
    places = on_ground(view, pixels, ground_m)
    ways = places - view.position  # d; the place is c + d, and where d changes it slides back along d onto the plane
    slide = _slide(ways)
    depth = ways @ view.rotation[:, 2]
    per_pixel = depth[:, None, None] * (view.rotation[:, :2] / (view.intrinsics.fx, view.intrinsics.fy))
    turns = by_turns(ways) * uncertainty.angle_rad
    steps = uncertainty.pixel_px * slide @ per_pixel
    shifts = uncertainty.position_m * slide
    return np.asarray(sum(part @ np.swapaxes(part, 1, 2) for part in (turns, steps, shifts)))


def by_turns(ways: Floats) -> Floats:
    """(n, 2, 3) the derivative of places on the ground, ways (n, 3) from the camera, by small turns of the camera."""
    return _slide(ways) @ _cross(ways)


def _slide(ways: Floats) -> Floats:
    """(n, 2, 3) the derivative of places on the ground by the camera, from which ways (n, 3) lead to them."""
    slide = np.zeros((len(ways), 2, 3))
    slide[:, :, :2] = np.eye(2)
    slide[:, :, 2] = -ways[:, :2] / ways[:, 2:]
    return slide


@dataclass(frozen=True, eq=False)
class TagPose:
    """Where a tag is: its pose (4, 4) in the map, and how far off its corners are then in the picture (RMS, pixels).

    `other` is the second pose that fits, less well, with its error: a small tag from afar looks nearly the same tilted
    one way or the other. Its place is much the same. Where a tag squarely faces the camera both poses are one.
    """

    pose: Floats
    error_px: float
    other: Floats
    other_error_px: float

    @property
    def position(self) -> Floats:
        """(3,) the tag's middle, in the map frame."""
        return self.pose[:3, 3]


def by_size(view: View, corners: npt.ArrayLike, size_m: float) -> TagPose:
    """Find the pose of a tag whose black square is `size_m` wide, of its corners (4, 2) as a `Sighting` has them.

    Raises
    ------
    ParameterError
        if the size is not above 0, or the corners are not four places of which no three are in line.
    MissingExtraError
        if OpenCV is not installed.
    """
    require_physics("the pose of a tag by its size", "cv2")
    import cv2

    at, square, camera = _checked(corners, size_m), CORNERS * size_m, view.intrinsics.matrix
    _, turn, shift = cv2.solvePnP(square, at, camera, None, flags=cv2.SOLVEPNP_ITERATIVE)
    first = transform(np.ravel(shift), np.asarray(cv2.Rodrigues(turn)[0]))
    start = _tilted_the_other_way(first)
    turn, shift = cv2.solvePnPRefineLM(square, at, camera, None, cv2.Rodrigues(start[:3, :3])[0], start[:3, 3:].copy())
    second = transform(np.ravel(shift), np.asarray(cv2.Rodrigues(turn)[0]))
    poses = [view.pose @ pose for pose in (first, second)]
    errors = [_error_px(view, moved(pose, square), at) for pose in poses]
    best = int(errors[1] < errors[0])
    return TagPose(poses[best], errors[best], poses[1 - best], errors[1 - best])


def size_covariance(
    view: View, corners: npt.ArrayLike, size_m: float, uncertainty: Uncertainty
) -> npt.NDArray[np.float64]:
    """To first order, the covariance (2, 2), m^2, of the x and y of `by_size`.

    The corners' part is differenced, each corner moved by a pixel to both sides; the robot's place and attitude move
    the tag as a whole.

    Raises
    ------
    ParameterError
        as `by_size`.
    """
    at = np.asarray(corners, dtype=np.float64)
    place = by_size(view, at, size_m).position
    slopes = []
    for k in range(8):
        off = np.zeros(8)
        off[k] = 0.5
        ahead, back = (by_size(view, at + sign * off.reshape(4, 2), size_m).position for sign in (1, -1))
        slopes.append((ahead - back)[:2])
    of_corners = uncertainty.pixel_px * np.array(slopes).T
    of_turns = uncertainty.angle_rad * _cross((place - view.position)[None])[0][:2]
    return np.asarray(of_corners @ of_corners.T + of_turns @ of_turns.T + uncertainty.position_m**2 * np.eye(2))


def by_length_as_printed(view: View, corners: npt.ArrayLike, size_m: float) -> Floats:
    """(4.44), (4.45) as printed: the place (3,) of a tag by the length of its diagonals in the picture.

    L is the tag's diagonal (Figure 4.13), l the mean of both in the picture; f the mean of both focal lengths.

    Raises
    ------
    ParameterError
        as `by_size`.
    """
    at = _checked(corners, size_m)
    centre = _crossing(at)
    length = np.mean([np.linalg.norm(at[2] - at[0]), np.linalg.norm(at[3] - at[1])])
    focal = (view.intrinsics.fx + view.intrinsics.fy) / 2
    distance = np.sqrt(2) * size_m * focal / length  # (4.44)
    return np.asarray(view.position + distance * view.rays(centre)[0])


def _tilted_the_other_way(pose: Floats) -> Floats:
    """A pose (4, 4) of the image frame, its z mirrored at the line of sight: half a turn about that, one about z."""
    sight = pose[:3, 3] / np.linalg.norm(pose[:3, 3])
    about_sight = 2 * np.outer(sight, sight) - np.eye(3)
    return transform(pose[:3, 3], about_sight @ pose[:3, :3] @ np.diag([-1.0, -1.0, 1.0]))


def _error_px(view: View, places: Floats, pixels: Floats) -> float:
    """RMS distance in the picture; infinite for what is not before the camera."""
    error = float(np.sqrt(((view.project(places) - pixels) ** 2).sum(axis=1).mean()))
    return error if np.isfinite(error) else np.inf


def _checked(corners: npt.ArrayLike, size_m: float) -> Floats:
    if not size_m > 0:
        raise ParameterError(f"size_m: {size_m}; expected metres above 0")
    at = np.ascontiguousarray(corners, dtype=np.float64)
    if at.shape != (4, 2) or not np.isfinite(at).all():
        raise ParameterError(f"corners: {at.tolist()}; expected four places in pixels")
    back, on = at - np.roll(at, 1, axis=0), np.roll(at, -1, axis=0) - at
    turns = back[:, 0] * on[:, 1] - back[:, 1] * on[:, 0]
    if not ((turns > 0).all() or (turns < 0).all()):
        raise ParameterError(f"corners: {at.tolist()}; expected the corners of a convex square, in order")
    return at


def _crossing(corners: Floats) -> Floats:
    """(2,) where the diagonals cross."""
    one, other = corners[2] - corners[0], corners[3] - corners[1]
    share = np.linalg.solve(np.column_stack([one, -other]), corners[1] - corners[0])[0]
    return np.asarray(corners[0] + share * one)


def _cross(vectors: Floats) -> Floats:
    """(n, 3, 3) that takes a small turn w to w x v, for vectors v (n, 3)."""
    x, y, z = vectors.T
    zero = np.zeros_like(x)
    rows = [[zero, z, -y], [-z, zero, x], [y, -x, zero]]
    return np.moveaxis(np.array(rows), 2, 0)
