"""The scene of a draft's map: its mission as it was last read, with its floor plan and tiles."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any
from urllib.parse import quote

from muster.server.contract import MissionVersion
from muster.server.pages.editing.draft import Draft
from muster.server.pages.map import scene_of
from muster.server.pages.visitor import the_services

TILES = "/tiles/{z}/{x}/{y}.png"


def scene_of_draft(draft: Draft) -> dict[str, Any]:
    """The scene of a draft that has been read at least once."""
    assert draft.checked.mission is not None
    impossible = [task["task"] for task in draft.checked.impossible]
    return ground_of(draft.checked.mission, draft.checked.floor, draft.base, impossible)


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
