"""Tags in a picture as a robot sees them on the ground: in its own level axes, whatever its pose is."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.perception.camera import Intrinsics, View
from muster.perception.dead_reckoning import Seen
from muster.perception.detection import Sighting
from muster.perception.localisation import Uncertainty, by_turns, ground_covariance, on_ground

FARTHEST_M = 20.0
"""How far away a tag is at most that counts: near the horizon a pixel is worth many metres."""


@dataclass(frozen=True, kw_only=True)
class LevelCamera:
    """A camera of a robot that knows its height and tilt.

    Parameters
    ----------
    intrinsics, mount
        of the camera; `mount` is (4, 4) from body to image.
    ground_m
        height of the ground on which tags lie.
    pixel_px
        standard deviation of a tag's middle in the picture.
    """

    intrinsics: Intrinsics
    mount: Floats
    ground_m: float
    pixel_px: float

    def seen(
        self, sightings: Sequence[Sighting], height_m: float, roll: float, pitch: float, moved: Floats | None = None
    ) -> list[tuple[int, Seen]]:
        """Return the tags in a picture by id, and where the robot sees them.

        Parameters
        ----------
        height_m, roll, pitch
            what the robot takes them to be.
        moved
            (3,) metres ahead and to the left, and radians, by which the robot moved since the picture was taken, if it
            matches it with a later pose: by so much what it sees may be off.
        """
        if not sightings:
            return []
        view = View.from_body(self.intrinsics, [0.0, 0.0, height_m, roll, pitch, 0.0], self.mount)
        pixels = np.array([sighting.centre for sighting in sightings])
        places = on_ground(view, pixels, self.ground_m)
        ways = places - view.position
        near = np.linalg.norm(ways, axis=1) <= FARTHEST_M  # False where NaN
        covariances = ground_covariance(view, pixels[near], Uncertainty(pixel_px=self.pixel_px), self.ground_m)
        if moved is not None:
            passed = moved[2] * np.column_stack([-places[near, 1], places[near, 0]]) + moved[:2]
            covariances = covariances + (passed**2).sum(axis=1)[:, None, None] * np.eye(2)
        by_height = ways[near, :2] / (view.position[2] - self.ground_m)
        by_tilt = by_turns(ways[near])[:, :, :2]
        tags = [sighting.tag for sighting, is_near in zip(sightings, near, strict=True) if is_near]
        return [
            (tag, Seen(*seen))
            for tag, *seen in zip(tags, places[near, :2], covariances, by_height, by_tilt, strict=True)
        ]
