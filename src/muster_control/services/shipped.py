"""Shipped missions as mission control lists and stores them: their texts and the files that they name.

They are not parsed here: all are written in one form (see `library.shelf`). Missions without robots are left out.
"""

from __future__ import annotations

import re
from functools import cache
from pathlib import Path
from typing import Any

from muster.library import mission_names, mission_path, mission_summary
from muster_control.contract import MissionEntry, MissionVersion

AUTHOR = "muster"


@cache
def shipped_entries() -> dict[str, MissionEntry]:
    """All shipped missions by id, which is their name."""
    return {name: _entry(name) for name in mission_names() if _file(name) is not None}


def shipped_version(name: str) -> MissionVersion:
    """A shipped mission before it is stored (version 0), with its map among its files."""
    file = _file(name)
    if file is None:
        raise KeyError(name)
    text = file.read_text(encoding="utf-8")
    files: dict[str, bytes] = {}
    named = re.search(r"ros_yaml: (\S+)", text)
    if named is not None:
        ros_map = file.parent / named[1]
        text = text.replace(named[1], ros_map.name)
        files = {beside.name: beside.read_bytes() for beside in sorted(ros_map.parent.glob(f"{ros_map.stem}.*"))}
    return MissionVersion(mission=name, version=0, text=text, author=AUTHOR, at=None, files=files)


def shipped_summary(name: str) -> dict[str, Any]:
    """The summary of a shipped mission."""
    entry = shipped_entries()[name]
    return {"name": entry.name, "robots": entry.robots, "tasks": entry.tasks, "dimensions": entry.dimensions}


def _file(name: str) -> Path | None:
    path = mission_path(name)
    return path if path is not None and path.suffix == ".yaml" else None


def _entry(name: str) -> MissionEntry:
    summary, file = mission_summary(name), _file(name)
    assert file is not None
    position = re.search(r"position: \[([^\]]+)\]", file.read_text(encoding="utf-8"))
    return MissionEntry(
        id=name,
        name=name,
        shipped=True,
        version=0,
        robots=summary.robots or 0,
        tasks=summary.tasks,
        dimensions=2 if position is None else len(position[1].split(",")),
        changed_at=None,
    )
