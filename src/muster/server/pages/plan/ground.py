"""The scene of a draft's map: its mission as it was last read, with its floor plan and tiles."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from urllib.parse import quote

from muster.mission.errors import MissionError
from muster.server.pages.asking import the_desk
from muster.server.pages.editing.draft import Draft
from muster.server.pages.map import scene_of
from muster.server.work.editing.edits import data_of

_LONGEST_ROS_YAML = 16 * 1024  # six lines, usually: short enough to be read here
TILES = "/tiles/{z}/{x}/{y}.png"


def scene_of_draft(draft: Draft) -> dict[str, Any]:
    """The scene of a draft that has been read at least once."""
    assert draft.checked.mission is not None
    impossible = [task["task"] for task in draft.checked.impossible]
    return ground_of(draft.checked.mission, draft.id, draft.base.files, impossible, draft.base.version)


def ground_of(
    mission: Mapping[str, Any],
    name: str,
    files: Mapping[str, bytes],
    impossible: list[str] | None = None,
    version: int | None = None,
) -> dict[str, Any]:
    """The scene of a plain mission whose files are kept under the name."""
    tiles = TILES if the_desk().settings.tiles else ""
    image = floor_plan(mission.get("map") or {}, name, files, version)
    return scene_of(mission, image=image, tiles=tiles, impossible=impossible or [])


def floor_plan(
    ground: Mapping[str, Any], mission: str, files: Mapping[str, bytes], version: int | None = None
) -> dict[str, Any] | None:
    """Where the picture of a map is, and how it lies; None where there is none, or it cannot be read."""
    picture, resolution, origin = ground.get("image"), ground.get("resolution_m"), ground.get("origin")
    if ground.get("ros_yaml"):
        text = files.get(ground["ros_yaml"], b"")
        if len(text) > _LONGEST_ROS_YAML:
            return None
        try:
            described = data_of(text.decode("utf-8", "replace"))
        except MissionError:
            return None
        folder = ground["ros_yaml"].rpartition("/")[0]
        picture = "/".join(part for part in (folder, str(described.get("image") or "")) if part)
        resolution, origin = described.get("resolution"), described.get("origin")
    if not picture or not isinstance(resolution, (int, float)) or picture not in files:
        return None
    asked = f"?version={version}" if version else ""
    return {
        "url": f"/api/v1/missions/{quote(mission)}/files/{quote(picture)}{asked}",
        "resolution": resolution,
        "origin": [*(origin or []), 0, 0, 0][:3],
    }
