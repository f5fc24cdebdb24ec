"""The scene of a mission with what lies under it: its floor plan, or tiles of a map of the earth."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from muster_control.contract import MissionVersion
from muster_control.pages.map.scene import scene_of
from muster_control.pages.visitor import the_services

TILES = "/tiles/{z}/{x}/{y}.png"


def ground_of(
    mission: Mapping[str, Any],
    floor: Mapping[str, Any] | None,
    kept: MissionVersion,
    impossible: Sequence[str] = (),
) -> dict[str, Any]:
    """The scene of a plain mission with its floor plan, both as its check has them; its files are those of `kept`."""
    tiles = TILES if the_services().settings.tiles else ""
    return scene_of(mission, image=image_of(floor, kept), tiles=tiles, impossible=impossible)


def image_of(floor: Mapping[str, Any] | None, kept: MissionVersion) -> dict[str, Any] | None:
    """Where a browser finds the picture of a floor plan, and how it lies; None where it is not among the files."""
    if floor is None or floor["file"] not in kept.files:
        return None
    asked = f"?version={kept.version}" if kept.version else ""
    url = f"/api/v1/missions/{quote(kept.mission)}/files/{quote(floor['file'])}{asked}"
    return {"url": url, "resolution": floor["resolution_m"], "origin": floor["origin"]}
