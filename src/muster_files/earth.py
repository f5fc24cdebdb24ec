"""Places of a mission on Earth: latitude, longitude and height above the ellipsoid, from its `origin_wgs84`."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise

from muster.mission.errors import Finding, MissionError
from muster.mission.geodesy import enu_to_wgs84
from muster.mission.model import Mission, Origin, Point

_DEGREES, _METRES = 9, 4
"""Decimals that are written: a tenth of a millimetre."""


@dataclass(frozen=True)
class Spot:
    """A place on Earth: degrees, and metres above the ellipsoid."""

    lat: float
    lon: float
    alt: float


@dataclass(frozen=True)
class Earth:
    """Where the map frame lies."""

    origin: Origin

    @classmethod
    def of(cls, mission: Mission, purpose: str) -> Earth:
        """Where a mission's map frame lies.

        Raises
        ------
        MissionError
            if the mission has no origin_wgs84; `purpose` names what needs it.
        """
        if mission.origin_wgs84 is None:
            form = "origin_wgs84: {lat_deg: 35.53, lon_deg: 24.06}"
            expected = f"{form} in the mission, the place of its origin on Earth, for {purpose}"
            raise MissionError([Finding(mission.source.file, None, "origin_wgs84", "missing", expected)])
        return cls(mission.origin_wgs84)

    def spots(self, points: Iterable[Point]) -> list[Spot]:
        """Points of the map frame, metres; without a height they lie in its plane."""
        rows = [(*point, 0.0)[:3] for point in points]
        if not rows:
            return []
        origin = self.origin
        found = enu_to_wgs84(rows, (origin.lat_deg, origin.lon_deg, origin.alt_m))
        return [Spot(round(a, _DEGREES), round(b, _DEGREES), round(c, _METRES)) for a, b, c in found.tolist()]

    def spot(self, point: Point) -> Spot:
        return self.spots([point])[0]


def anticlockwise(polygon: Sequence[Point]) -> list[Point]:
    """The corners in the order in which the area is to their left, seen from above."""
    corners = [*polygon, polygon[0]]
    doubled = sum(a[0] * b[1] - b[0] * a[1] for a, b in pairwise(corners))
    return list(polygon) if doubled >= 0 else list(polygon)[::-1]
