"""The map frame of a site: its origin on Earth, and places in degrees as metres in it.

Metres are rounded to a tenth of a millimetre, as places are in exported files.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from statistics import median

from muster_files.antimeridian import unwrapped
from muster_files.sites.features import Coordinate

_DECIMALS = 4
_ORIGIN_DECIMALS = 6
FARTHEST_M = 100_000.0
"""A plane that touches the Earth says little of places farther from where it touches."""
_ROUNDS = 4


@dataclass(frozen=True)
class Frame:
    """Where the origin of the map frame is: latitude and longitude in degrees, metres over the ellipsoid."""

    lat: float
    lon: float
    alt: float

    @classmethod
    def around(cls, places: Sequence[Coordinate], altitudes: Iterable[float]) -> Frame:
        """A frame whose origin is in the middle of places, as low as the lowest of their altitudes."""
        first = places[0][0]
        lons = [unwrapped(place[0], first) for place in places]
        lats = [place[1] for place in places]
        lon = wrapped(round((min(lons) + max(lons)) / 2, _ORIGIN_DECIMALS))
        return cls(round((min(lats) + max(lats)) / 2, _ORIGIN_DECIMALS), lon, round(min(altitudes, default=0.0), 1))

    @classmethod
    def amid(cls, places: Sequence[Coordinate]) -> Frame:
        """A frame whose origin is amid most of the places: few that are far off do not move it."""
        first = places[0][0]
        lons = median(unwrapped(place[0], first) for place in places)
        return cls(median(place[1] for place in places), wrapped(lons), 0.0)

    def metres(self, places: Sequence[Coordinate], over_ground: bool = False) -> list[list[float]]:
        """Places in metres, each with as many coordinates as it is given in degrees.

        Without a height a place is at the altitude of the origin, and its height in the frame is left out. A height
        `over_ground` is the one in the frame.
        """
        if not places:
            return []
        from muster.mission.geodesy import wgs84_to_enu

        heights = [place[2] if len(place) > 2 else 0.0 for place in places]
        absolute = [h if len(p) > 2 and not over_ground else self.alt + h for p, h in zip(places, heights, strict=True)]
        for _ in range(_ROUNDS if over_ground else 1):
            rows = [(place[1], place[0], alt) for place, alt in zip(places, absolute, strict=True)]
            found = wgs84_to_enu(rows, (self.lat, self.lon, self.alt)).tolist()
            if over_ground:
                absolute = [a + h - row[2] for a, h, row in zip(absolute, heights, found, strict=True)]
        if over_ground:
            found = [[*row[:2], height] for row, height in zip(found, heights, strict=True)]
        return [
            [round(c, _DECIMALS) + 0.0 for c in row[: len(place)]] for row, place in zip(found, places, strict=True)
        ]

    def degrees(self, place: Sequence[float]) -> tuple[float, float]:
        """Latitude and longitude of a place on the ground, as exact as an origin that is chosen."""
        from muster.mission.geodesy import enu_to_wgs84

        ((lat, lon, _),) = enu_to_wgs84([(place[0], place[1], 0.0)], (self.lat, self.lon, self.alt)).tolist()
        return round(lat, _ORIGIN_DECIMALS), round(lon, _ORIGIN_DECIMALS)

    def is_far(self, place: Coordinate) -> bool:
        """Whether a place is so far away that it cannot be meant."""
        return self.distance(place) > FARTHEST_M

    def distance(self, place: Coordinate) -> float:
        """Metres to a place on a sphere like the Earth."""
        a, b = math.radians(self.lat), math.radians(place[1])
        turn = math.radians(place[0] - self.lon)
        half = math.sin((b - a) / 2) ** 2 + math.cos(a) * math.cos(b) * math.sin(turn / 2) ** 2
        return 2 * 6_371_000 * math.asin(min(1.0, math.sqrt(half)))


def wrapped(lon: float) -> float:
    """The same longitude from -180 to 180."""
    return unwrapped(lon, 0.0)
