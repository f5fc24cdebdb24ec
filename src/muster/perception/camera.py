"""The pinhole camera: [tcf-thesis] (4.36)-(4.40), and the camera of its drone (A.24)-(A.26).

Frames, each as its pose in the one before (a transform (4, 4), see `muster.motion.frames`):

- map: ENU, metres;
- body: x forward, y left, z up, at the robot's pose;
- link: the camera's housing, x where it looks, y left, z up;
- image: x to the right of the picture, y down, z where it looks, the origin in the pinhole.

A place in the picture is (x, y) in pixels, from the upper left corner of the picture to the right and down. The first
pixel covers 0 to 1, so its centre is (0.5, 0.5), and the middle of a picture 640 wide is 320. Angles are radians.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cached_property
from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission import model
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.frames import inverse, moved, pose_transform

_RIGHT_ANGLED = 1e-6
"""How far from right angles and from length 1 the axes of a pose may be."""

LINK_IMAGE = pose_transform([0.0, 0.0, 0.0, -math.pi / 2, 0.0, -math.pi / 2])
"""(A.25): from link to image."""

IMAGE_RENDERER = np.diag([1.0, -1.0, -1.0, 1.0])
"""From image to the frame of OpenGL's and MuJoCo's cameras: x right, y up, looking against z. Its own inverse."""


def mount_of(link: npt.ArrayLike) -> Floats:
    """(A.26): from body to image (4, 4), of the link's pose (6,) on the body: x, y, z, roll, pitch, yaw.

    A pitch above 0 looks down.
    """
    return np.asarray(pose_transform(link) @ LINK_IMAGE)


def mount_of_mission(camera: model.Camera) -> Floats:
    """From body to image (4, 4), of a robot's camera as its mission has it."""
    x, y, z = (*camera.mount, 0.0)[:3]
    return mount_of([x, y, z, 0.0, math.radians(camera.tilt_deg), 0.0])


RB5_MOUNT = mount_of([0.087, 0.0, -0.001, 0.0, math.pi / 4, 0.0])
"""(A.24)-(A.26): the tracking camera of the thesis' drone."""


@dataclass(frozen=True, kw_only=True)
class Intrinsics:
    """Intrinsic parameters of a camera, in pixels: size of the picture, focal lengths, principal point.

    The thesis has one focal length; the two of a real camera differ a little. There is no distortion: pictures of a
    lens with distortion must be rectified before.

    Raises
    ------
    ParameterError
        where a number is missing, not finite or out of its range.
    """

    width: int
    height: int
    fx: float
    fy: float
    cx: float
    cy: float

    def __post_init__(self) -> None:
        fault = fault_in({f.name: getattr(self, f.name) for f in fields(self)})
        if fault is not None:
            raise ParameterError("{}: {}; expected {}".format(*fault))

    @classmethod
    def of_view(cls, width: int, height: int, fov_rad: float) -> Intrinsics:
        """Square pixels, the principal point in the middle, `fov_rad` from the left edge to the right one."""
        if not 0 < fov_rad < math.pi:
            raise ParameterError(f"fov_rad: {fov_rad}; expected an angle above 0 and below pi")
        focal = width / 2 / math.tan(fov_rad / 2)
        return cls(width=width, height=height, fx=focal, fy=focal, cx=width / 2, cy=height / 2)

    @property
    def vertical_fov_rad(self) -> float:
        """From the upper edge to the lower one: `fovy` of a renderer, where the principal point is in the middle."""
        return math.atan(self.cy / self.fy) + math.atan((self.height - self.cy) / self.fy)

    @property
    def matrix(self) -> Floats:
        """(3, 3): takes points of the image frame to pixels times depth."""
        return np.array([[self.fx, 0.0, self.cx], [0.0, self.fy, self.cy], [0.0, 0.0, 1.0]])


def intrinsics_of_mission(camera: model.Camera) -> Intrinsics:
    """Of a camera as its mission has it."""
    return Intrinsics.of_view(camera.width_px, camera.height_px, math.radians(camera.fov_deg))


def fault_in(values: Mapping[str, Any]) -> tuple[str, Any, str] | None:
    """The first fault in the numbers of `Intrinsics`: the name, the value, and what was expected."""
    for name, value in values.items():
        if isinstance(value, bool) or not isinstance(value, (int, float, np.integer, np.floating)):
            return name, repr(value), "a number of pixels"
        if not math.isfinite(value):
            return name, value, "a finite number of pixels"
    for name in ("width", "height"):
        if values[name] < 1 or values[name] != int(values[name]):
            return name, values[name], "a whole number of pixels of at least 1"
    for name in ("fx", "fy"):
        if values[name] <= 0:
            return name, values[name], "a focal length above 0, in pixels"
    for name, most in (("cx", values["width"]), ("cy", values["height"])):
        if not 0 <= values[name] <= most:
            return name, values[name], f"a principal point within the picture, 0 to {most}"
    return None


@dataclass(frozen=True, eq=False)
class View:
    """A camera at a place: its intrinsics and the pose (4, 4) of its image frame in the map frame.

    Raises
    ------
    ParameterError
        where the pose is no rigid transform, or the intrinsics are none.
    """

    intrinsics: Intrinsics
    pose: Floats

    def __post_init__(self) -> None:
        if not isinstance(self.intrinsics, Intrinsics):
            raise ParameterError(f"intrinsics: {self.intrinsics!r}; expected the camera's Intrinsics")
        _check_rigid(self.pose)

    @classmethod
    def from_body(cls, intrinsics: Intrinsics, body: npt.ArrayLike, mount: Floats) -> View:
        """(4.37): `body` is the robot's pose (6,) or (4, 4) in the map, `mount` (4, 4) goes from body to image."""
        pose = np.asarray(body, dtype=np.float64)
        if pose.shape not in ((6,), (4, 4)):
            raise ParameterError(f"body: shape {pose.shape}; expected (6,) or (4, 4)")
        return cls(intrinsics, (pose_transform(pose) if pose.ndim == 1 else pose) @ mount)

    @property
    def position(self) -> Floats:
        """(3,) the pinhole, in the map frame."""
        return self.pose[:3, 3]

    @property
    def rotation(self) -> Floats:
        """(3, 3): takes directions of the image frame to the map frame."""
        return self.pose[:3, :3]

    @cached_property
    def _from_map(self) -> Floats:
        return inverse(self.pose)

    def project(self, points: npt.ArrayLike) -> Floats:
        """Where points (n, 3) of the map are in the picture: (n, 2) pixels; NaN for those not before the camera."""
        seen = moved(self._from_map, np.reshape(points, (-1, 3)))
        depth = np.where(seen[:, 2:] > 0, seen[:, 2:], np.nan)
        return np.asarray((seen / depth) @ self.intrinsics.matrix[:2].T)

    def sees(self, points: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Which points (n, 3) of the map are within the picture: (n,). Nothing is in the way."""
        pixels = self.project(points)
        size = (self.intrinsics.width, self.intrinsics.height)
        return np.asarray(((pixels >= 0) & (pixels <= size)).all(axis=1))

    def rays(self, pixels: npt.ArrayLike) -> Floats:
        """(4.39), (4.40): unit vectors (n, 3) of the map frame from the pinhole to what is at pixels (n, 2)."""
        return np.asarray(rays_in_image(self.intrinsics, pixels) @ self.rotation.T)


def rays_in_image(intrinsics: Intrinsics, pixels: npt.ArrayLike) -> Floats:
    """(4.39): unit vectors (n, 3) of the image frame to what is at pixels (n, 2)."""
    at = np.asarray(pixels, dtype=np.float64).reshape(-1, 2)
    middle, focal = (intrinsics.cx, intrinsics.cy), (intrinsics.fx, intrinsics.fy)
    ways = np.column_stack([(at - middle) / focal, np.ones(len(at))])
    return np.asarray(ways / np.linalg.norm(ways, axis=1, keepdims=True))


def _check_rigid(pose: Floats) -> None:
    if np.shape(pose) != (4, 4):
        raise ParameterError(f"pose: shape {np.shape(pose)}; expected (4, 4)")
    if not np.isfinite(pose).all():
        raise ParameterError("pose: a number that is not finite; expected finite numbers")
    turn = pose[:3, :3]
    rigid = np.allclose(turn @ turn.T, np.eye(3), rtol=0, atol=_RIGHT_ANGLED) and np.linalg.det(turn) > 0
    if not rigid or not np.array_equal(pose[3], [0, 0, 0, 1]):
        raise ParameterError(
            f"pose: {np.round(pose, 6).tolist()}; expected a rotation, a position and the row 0, 0, 0, 1"
        )
