"""Names of the files of robots."""

from __future__ import annotations

from collections.abc import Iterable


def file_names(ids: Iterable[str], suffix: str) -> list[str]:
    """A name for each robot's file: its id without characters that files cannot have. No two differ by case alone."""
    names: list[str] = []
    for robot in ids:
        stem = "".join(c if c.isalnum() or c in "_-." else "_" for c in robot).lstrip(".") or "robot"
        taken, name, k = {known.casefold() for known in names}, f"{stem}{suffix}", 2
        while name.casefold() in taken:
            name, k = f"{stem}-{k}{suffix}", k + 1
        names.append(name)
    return names
