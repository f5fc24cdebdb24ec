"""Sightings of tags by geometry alone: for worlds without rendered pictures.

A tag is seen that lies within the picture, faces the camera and is large enough for a detector. There is no occlusion
and no poor light; the only error of detection is that of the corners.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.frames import moved
from muster.perception.camera import View
from muster.perception.detection import Sighting, Sightings
from muster.perception.tags import CORNERS

LEAST_PX = 16.0
"""The pixels across its black square with which a tag is found in every image (docs/perception.md)."""

MIDDLE_SHARE = 0.5
"""Error of a tag's middle as a share of that of its corners: it is the middle of four."""


@dataclass(frozen=True, eq=False)
class GroundTag:
    """A tag at its true pose: its id, the pose (4, 4) in the map, and the side of its black square in metres."""

    id: int
    pose: Floats
    size_m: float


def sightings_of(
    tags: Sequence[GroundTag], view: View, random: np.random.Generator, corner_px: float = 0.2
) -> Sightings:
    """The tags that a camera sees, with corners that are off by `corner_px` (standard deviation, each axis)."""
    in_picture = view.sees([tag.pose[:3, 3] for tag in tags])  # quick, as most are not
    near = [tag for tag, inside in zip(tags, in_picture, strict=True) if inside]
    seen = [sighting for tag in near if (sighting := _sighting(tag, view, random, corner_px)) is not None]
    return Sightings.of(sorted(seen, key=lambda sighting: (sighting.tag, *sighting.centre)))


def _sighting(tag: GroundTag, view: View, random: np.random.Generator, corner_px: float) -> Sighting | None:
    places = moved(tag.pose, CORNERS * tag.size_m)
    if not view.sees(places).all() or not _faces(tag, view):
        return None
    corners = view.project(places)
    sides = np.linalg.norm(corners - np.roll(corners, 1, axis=0), axis=1)
    if sides.min() < LEAST_PX:
        return None
    centre = view.project(tag.pose[None, :3, 3])[0]
    off = random.normal(0.0, corner_px, (5, 2)) * ([[MIDDLE_SHARE]] + [[1.0]] * 4)
    return Sighting(tag.id, centre + off[0], corners + off[1:], corrected=0, margin=100.0)


def _faces(tag: GroundTag, view: View) -> bool:
    """Whether the camera is on the side from which the tag is to be seen: its z points into it."""
    return float((tag.pose[:3, 3] - view.position) @ tag.pose[:3, 2]) > 0
