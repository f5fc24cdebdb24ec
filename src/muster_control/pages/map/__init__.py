"""The map as an element of pages: drawn on canvases by its own scripts (`map.js`, `modules/`)."""

from muster_control.pages.map.element import MissionMap
from muster_control.pages.map.scene import scene_of

__all__ = ["MissionMap", "scene_of"]
