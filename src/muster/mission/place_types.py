"""The kinds of value that say where on Earth a place is: `lat_lon`, and a place in metres or by `lat_lon`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from muster.mission.value_types import INVALID, Fault, JsonSchema, Many, Number, Path, Position, shown

_BOUNDS = (Number(minimum=-90, maximum=90), Number(minimum=-180, maximum=180), Number())


@dataclass(frozen=True)
class LatLon:
    """`[lat, lon]` or `[lat, lon, alt]`: degrees, and metres above the ellipsoid; with `planar` only the first."""

    filler: ClassVar[tuple[float, ...]] = ()
    planar: bool = False

    @property
    def expected(self) -> str:
        return "[lat, lon] in degrees" if self.planar else "[lat, lon] or [lat, lon, alt] in degrees and metres"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence) or len(value) not in self._lengths:
            faults.append(Fault(at, shown(value), self.expected))
            return INVALID
        bounds = _BOUNDS[: len(value)]
        numbers = [kind.read(item, (*at, k), faults) for k, (kind, item) in enumerate(zip(bounds, value, strict=True))]
        return INVALID if INVALID in numbers else tuple(numbers)

    @property
    def _lengths(self) -> tuple[int, ...]:
        return (2,) if self.planar else (2, 3)

    def schema(self) -> JsonSchema:
        bounds = [kind.schema() for kind in _BOUNDS[: self._lengths[-1]]]
        return {"type": "array", "prefixItems": bounds, "minItems": 2, "maxItems": self._lengths[-1]}


@dataclass(frozen=True)
class Place(Position):
    """A position in metres, where a file may also have `{lat_lon: [lat, lon]}`: metres by the time it is read."""

    def schema(self) -> JsonSchema:
        return {"anyOf": [super().schema(), _in_degrees(LatLon(planar=self.planar).schema())]}


@dataclass(frozen=True)
class Corners(Many):
    """The corners of an area, `[x, y]` each in metres; in a file also `{lat_lon: [[lat, lon], ...]}`."""

    kind: Position = Position(planar=True)
    minimum: int = 3

    @property
    def expected(self) -> str:
        return f"{super().expected}, or {{lat_lon: [[lat, lon], ...]}}"

    def schema(self) -> JsonSchema:
        degrees = {"type": "array", "items": LatLon(planar=True).schema(), "minItems": self.minimum}
        return {"anyOf": [super().schema(), _in_degrees(degrees)]}


def _in_degrees(schema: JsonSchema) -> JsonSchema:
    """A mapping with degrees of this form in it."""
    return {
        "type": "object",
        "properties": {"lat_lon": schema},
        "required": ["lat_lon"],
        "additionalProperties": False,
    }
