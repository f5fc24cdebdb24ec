"""The source of a mission: the file and line of each of its values."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from muster.mission.value_types import Path

Place = tuple[str, int | None]
"""A file and a line of it, from 1; None where there are no lines."""


@dataclass(frozen=True)
class Source:
    """A mission's main file, and the place of each value by the value's path.

    Parameters
    ----------
    file
        the main file.
    places
        file and line by path.
    fields
        what the file calls values that stand in it under another name than in the mission: headings of columns.
    numbers
        for lists of which some records were made of one in the file: for each record the number of that.
    """

    file: str
    places: Mapping[Path, Place] = field(default_factory=dict)
    fields: Mapping[Path, str] = field(default_factory=dict)
    numbers: Mapping[str, Sequence[int]] = field(default_factory=dict)

    def place(self, path: Path) -> Place:
        """The place of a value, or of the nearest thing around it that has one."""
        path = self.path(path)
        for length in range(len(path), -1, -1):
            if path[:length] in self.places:
                return self.places[path[:length]]
        return self.file, None

    def name_in_file(self, path: Path) -> str | None:
        """What the file calls a value, or the nearest thing around it that has a name of its own, and the key in it."""
        path = self.path(path)
        length = next((k for k in range(len(path), 0, -1) if path[:k] in self.fields), None)
        if length is None:
            return None
        key = path[length] if length < len(path) else None
        return f"{self.fields[path[:length]]}, {key}" if isinstance(key, str) else self.fields[path[:length]]

    def path(self, path: Path) -> Path:
        """The path of a value in the file; records that were made of one have its number there."""
        numbers = self.numbers.get(str(path[0])) if path else None
        if numbers is None or len(path) < 2 or not isinstance(path[1], int) or path[1] >= len(numbers):
            return path
        return (path[0], numbers[path[1]], *path[2:])

    def renumbered(self, numbers: Mapping[str, Sequence[int]]) -> Source:
        """The source of a mission whose lists have other records: for each its number in the list of before."""
        before = {group: [int(self.path((group, k))[1]) for k in of] for group, of in numbers.items()}
        return replace(self, numbers={**self.numbers, **before})


IN_PYTHON = Source("<mission>")
"""The source of a mission that was built in Python."""
