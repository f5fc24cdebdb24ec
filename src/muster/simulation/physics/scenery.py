"""What in the physics world is only to be seen: what the map has, and tags that lie about."""

from __future__ import annotations

from dataclasses import dataclass
from xml.etree import ElementTree as ET

from muster.mission.model import Tag
from muster.motion.map_world import World
from muster.simulation.physics.buildings import Heights, add_buildings
from muster.simulation.physics.tag_plates import add_plates, picture_files


@dataclass(frozen=True)
class Scenery:
    """Of one mission: its map, its tags, the height of the ground in metres, and how high walls are drawn."""

    map: World | None
    tags: tuple[Tag, ...]
    ground_m: float
    heights: Heights = Heights()

    def add(self, root: ET.Element, place: ET.Element) -> None:
        """Put it into a model, of which these are the root and the body of the world."""
        if self.map is not None:
            add_buildings(root, place, self.map, self.ground_m, self.heights)
        add_plates(root, place, self.tags)

    @property
    def files(self) -> dict[str, bytes]:
        """To which the model refers, by name."""
        return picture_files(self.tags)
