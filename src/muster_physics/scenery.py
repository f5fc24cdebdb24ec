"""Visible objects of the physics world that touch nothing: buildings of the map, and tags on the ground."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as ET

from muster.mission.model import Tag
from muster.motion.map_world import World
from muster_physics.buildings import Heights, add_buildings
from muster_physics.tag_plates import add_plates, picture_files


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
