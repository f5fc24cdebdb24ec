"""The robots and tasks in a mission's plain data, with their paths, before it is read."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from muster.mission.value_types import Path

Raw = tuple[Path, dict[str, Any]]
"""A mapping in the data, and its path."""


def robots_in(data: object) -> Iterator[Raw]:
    """Robots, and those that join later."""
    yield from listed(data, "robots")
    yield from of_events(data, "robot_joins")


def tasks_in(data: object) -> Iterator[Raw]:
    """Tasks, those that come later, and what becomes of tags."""
    yield from listed(data, "tasks")
    yield from of_events(data, "new_task")
    for at, found in listed(data, "found"):
        if isinstance(found.get("becomes"), dict):
            yield (*at, "becomes"), found["becomes"]


def of_events(data: object, key: str) -> Iterator[Raw]:
    """The mappings that events have under a key."""
    for at, event in listed(data, "events"):
        if isinstance(event.get(key), dict):
            yield (*at, key), event[key]


def listed(data: object, group: str) -> Iterator[Raw]:
    """The mappings in one of the mission's lists."""
    items = data.get(group) if isinstance(data, dict) else None
    if isinstance(items, list):
        yield from (((group, k), item) for k, item in enumerate(items) if isinstance(item, dict))
