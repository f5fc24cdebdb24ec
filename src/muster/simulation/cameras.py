"""Robots' cameras in a simulated world: they see by geometry, or in rendered pictures."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Protocol, runtime_checkable

import numpy as np
import numpy.typing as npt

from muster.mission.model import Tag
from muster.motion.grid import Floats
from muster.perception.camera import View
from muster.perception.camera_observer import CameraObserver, Observation
from muster.perception.cameras.images import Image
from muster.perception.detection import TagDetector
from muster.perception.geometric_detection import MIDDLE_SHARE, GroundTag, sightings_of
from muster.perception.point_search import FoundPoint
from muster.perception.tags import tag_pose


@dataclass(frozen=True, eq=False)
class Look:
    """One image of one robot's camera: its time, the picture (None where none is rendered), and the observation.

    `finds` is all that the team has found by then.
    """

    robot: str
    time_s: float
    image: Image | None
    observation: Observation
    finds: tuple[FoundPoint, ...] = ()


class Cameras(Protocol):
    """The cameras of a world."""

    detector: TagDetector | None
    """Finds tags in pictures; None where cameras have none."""

    @property
    def pixel_px(self) -> float:
        """The standard deviation of a tag's middle in the picture, each axis."""
        ...

    def look(self, observer: CameraObserver, view: View, body: npt.ArrayLike, now: float) -> Look:
        """Look from the camera's true `view`; `body`, (6,) or (4, 4), is the pose that the robot estimates."""
        ...

    def close(self) -> None:
        """Release resources."""
        ...


@runtime_checkable
class WithCameras(Protocol):
    """A world in which robots' cameras see tags."""

    def cameras(self, tags: Sequence[Tag], seed: int) -> Cameras:
        """Return the cameras, which see these tags; `seed` is that of their errors.

        Raises
        ------
        MissingExtraError
            if an extra is needed and not installed.
        """
        ...


class GeometricCameras:
    """Sees tags where geometry has them, `corner_px` off in the picture; draws nothing and needs no extra."""

    detector = None

    def __init__(self, tags: Sequence[Tag], seed: int, corner_px: float = 0.2) -> None:
        self._tags = [
            GroundTag(tag.id, tag_pose(tag.position, math.radians(tag.heading_deg)), tag.size_m) for tag in tags
        ]
        self._random = np.random.default_rng((seed, 1))
        self._corner_px = corner_px

    @property
    def pixel_px(self) -> float:
        """See `Cameras`."""
        return MIDDLE_SHARE * self._corner_px

    def look(self, observer: CameraObserver, view: View, body: npt.ArrayLike, now: float) -> Look:
        """See `Cameras`."""
        sightings = sightings_of(self._tags, view, self._random, self._corner_px)
        return Look(observer.robot, now, None, observer.locate(sightings, body, now))

    def close(self) -> None:
        """See `Cameras`; nothing is held."""


def true_body(frame: Floats, axes: Floats) -> Floats:
    """(4, 4) of a body's frame (3,) and its axes (3, 3), both in the map frame."""
    body = np.eye(4)
    body[:3, 3], body[:3, :3] = frame, axes
    return body
