"""Visible objects of the physics world that touch nothing: buildings of the map, and tags on the ground.

AprilTags that lie in the physics world: thin plates with the tag's picture, which touch nothing.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from muster.mission.model import Tag
from muster.motion.map_world import World
from muster.perception.optional_parts import require_physics
from muster.perception.tags import CELLS, CELLS_OF_PICTURE, tag_image
from muster_physics.bodies import quaternion
from muster_physics.buildings import Heights, add_buildings
from muster_physics.xml import add

ABOVE_GROUND_M = 0.002
"""So that it is drawn over the ground on which it lies."""
_CELL_PX = 16


def add_plates(root: ET.Element, world: ET.Element, tags: Sequence[Tag]) -> None:
    """Put a plate for each tag into the model, and each picture once."""
    asset = ET.SubElement(root, "asset")
    for name in _names(tags):
        add(asset, "texture", name=name, type="2d", file=f"{name}.png")
        add(asset, "material", name=name, texture=name, specular=0, shininess=0)
    for tag in tags:
        x, y, z = (*tag.position, 0.0)[:3]
        half = tag.size_m * CELLS_OF_PICTURE / CELLS / 2
        add(
            world,
            "geom",
            type="plane",
            pos=(x, y, z + ABOVE_GROUND_M),
            size=(half, half, 1),
            quat=quaternion(math.radians(tag.heading_deg) - math.pi / 2),
            material=_name(tag),
            contype=0,
            conaffinity=0,
        )


def picture_files(tags: Sequence[Tag]) -> dict[str, bytes]:
    """The pictures to which the model refers, by name: PNG."""
    return {f"{name}.png": _png(tag) for name, tag in _names(tags).items()}


def _name(tag: Tag) -> str:
    return f"tag{tag.id}"


def _names(tags: Sequence[Tag]) -> dict[str, int]:
    """Each id once, by the name of its picture."""
    return {_name(tag): tag.id for tag in tags}


def _png(tag: int) -> bytes:
    require_physics("a picture of a tag", "cv2")
    import cv2

    return bytes(cv2.imencode(".png", tag_image(tag, _CELL_PX))[1])


@dataclass(frozen=True)
class Scenery:
    """The scenery of a mission: its map, its tags, the height of the ground in metres, and the heights of walls."""

    map: World | None
    tags: tuple[Tag, ...]
    ground_m: float
    heights: Heights = Heights()

    def add(self, root: ET.Element, place: ET.Element) -> None:
        """Add the scenery to a model with this root element and this world body."""
        if self.map is not None:
            add_buildings(root, place, self.map, self.ground_m, self.heights)
        add_plates(root, place, self.tags)

    @property
    def files(self) -> dict[str, bytes]:
        """The files to which the model refers, by name."""
        return picture_files(self.tags)
