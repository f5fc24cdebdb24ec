"""The source of a mission: the file and line of each of its values."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from dataclasses import field as data_field

from muster.mission.value_types import Path

Place = tuple[str, int | None]
"""A file and a line of it, from 1; None where there are no lines."""


@dataclass(frozen=True)
class Source:
    """A mission's main file, and the place of each value by the value's path."""

    file: str
    places: Mapping[Path, Place] = data_field(default_factory=dict)
    fields: Mapping[Path, str] = data_field(default_factory=dict)
    """What the file calls values that stand in it under another name than in the mission: headings of columns."""

    def place(self, path: Path) -> Place:
        """The place of a value, or of the nearest thing around it that has one."""
        for length in range(len(path), -1, -1):
            if path[:length] in self.places:
                return self.places[path[:length]]
        return self.file, None

    def field(self, path: Path) -> str | None:
        """What the file calls a value, or the nearest thing around it that has a name of its own."""
        return next((self.fields[path[:k]] for k in range(len(path), 0, -1) if path[:k] in self.fields), None)


IN_PYTHON = Source("<mission>")
"""The source of a mission that was built in Python."""
