"""Reads the fields of a plan file, and says which of them is not as it should be."""

from __future__ import annotations

from pathlib import Path
from typing import Any, TypeGuard

from muster.mission.errors import Finding, MissionError
from muster.mission.value_types import shown

Degrees = tuple[float, float, float]
"""Latitude and longitude in degrees, and the height in metres in the datum of the planned home."""


class PlanFields:
    """The fields of one file; the first that is wrong is raised, as a `MissionError`."""

    def __init__(self, file: Path, line: int | None = None) -> None:
        self.file, self._line = file, line

    def of(self, data: dict[str, Any], key: str, kind: type, expected: str, at: str) -> Any:
        """The value of a key, of a type."""
        if not isinstance(data.get(key), kind):
            raise self.refused(at, data.get(key), expected)
        return data[key]

    def positive(self, data: dict[str, Any], key: str, expected: str, at: str) -> float:
        """The value of a key: a number above 0."""
        value = data.get(key)
        if not is_number(value) or not value > 0:
            raise self.refused(at, value, expected)
        return float(value)

    def place(self, value: object, at: str) -> Degrees:
        """Latitude, longitude, altitude."""
        if not isinstance(value, list) or len(value) != 3 or not all(map(is_number, value)):
            raise self.refused(at, value, "latitude and longitude in degrees, altitude in metres")
        lat, lon, height = (float(number) for number in value)
        if abs(lat) > 90 or abs(lon) > 180:
            raise self.refused(at, value, "a latitude from -90 to 90, then a longitude from -180 to 180")
        return lat, lon, height

    def items(self, data: dict[str, Any], key: str, at: str) -> list[Any]:
        """The list under a key; empty where there is none."""
        found = data.get(key)
        if found is not None and not isinstance(found, list):
            raise self.refused(at, found, "a list")
        return found or []

    def require_version(self, data: dict[str, Any], at: str, *known: int) -> None:
        """Raise MissionError if a part of a file says that it is of a version that is not known."""
        version = data.get("version", known[-1])
        if isinstance(version, bool) or version not in known:
            raise self.refused(f"{at}.version".lstrip("."), version, " or ".join(map(str, known)))

    def require_known(self, data: dict[str, Any], at: str, *known: str) -> None:
        """Raise MissionError for a member that is not known, where an unknown one may close or open a place."""
        for key in data:
            if key not in known and data[key] not in (None, [], {}):
                raise self.refused(f"{at}.{key}", data[key], f"no more than {', '.join(known)}")

    def corners(self, data: dict[str, Any], key: str, at: str) -> tuple[tuple[float, float], ...]:
        """The corners of a polygon, latitude and longitude each."""
        found = self.of(data, key, list, "a list of corners", at)
        return tuple(self._corner(value, f"{at}[{k}]") for k, value in enumerate(found))

    def _corner(self, value: object, at: str) -> tuple[float, float]:
        if not isinstance(value, list) or len(value) != 2:
            raise self.refused(at, value, "[latitude, longitude] in degrees")
        return self.place([*value, 0.0], at)[:2]

    def refused(self, field: str, value: object, expected: str) -> MissionError:
        """The error for a field that is missing, or not what was expected."""
        return self.refused_as(field, "missing" if value is None else shown(value), expected)

    def refused_as(self, field: str, told: str, expected: str) -> MissionError:
        """The error for a field whose value is told in words."""
        return MissionError([Finding(str(self.file), self._line, field, told, expected)])


def is_number(value: Any) -> TypeGuard[float]:
    """Whether a value of JSON is a finite number."""
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e300
