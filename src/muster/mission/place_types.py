"""The kinds of value that say where on Earth a place is: `lat_lon`, and a place in metres or by `lat_lon`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, ClassVar

from muster.mission.value_types import INVALID, Fault, JsonSchema, Number, Path, Position, shown

_BOUNDS = (Number(minimum=-90, maximum=90), Number(minimum=-180, maximum=180), Number())


@dataclass(frozen=True)
class LatLon:
    """`[lat, lon]` or `[lat, lon, alt]`: degrees, and metres above the ellipsoid."""

    filler: ClassVar[tuple[float, ...]] = ()
    expected: ClassVar[str] = "[lat, lon] or [lat, lon, alt] in degrees and metres"

    def read(self, value: object, at: Path, faults: list[Fault]) -> Any:
        if isinstance(value, str) or not isinstance(value, Sequence) or len(value) not in (2, 3):
            faults.append(Fault(at, shown(value), self.expected))
            return INVALID
        bounds = _BOUNDS[: len(value)]
        numbers = [kind.read(item, (*at, k), faults) for k, (kind, item) in enumerate(zip(bounds, value, strict=True))]
        return INVALID if INVALID in numbers else tuple(numbers)

    def schema(self) -> JsonSchema:
        return {"type": "array", "prefixItems": [kind.schema() for kind in _BOUNDS], "minItems": 2, "maxItems": 3}


@dataclass(frozen=True)
class Place(Position):
    """A position in metres, where a file may also have `{lat_lon: [lat, lon]}`: metres by the time it is read."""

    def schema(self) -> JsonSchema:
        degrees = {
            "type": "object",
            "properties": {"lat_lon": LatLon().schema()},
            "required": ["lat_lon"],
            "additionalProperties": False,
        }
        return {"anyOf": [super().schema(), degrees]}
