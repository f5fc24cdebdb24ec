"""The position of a simulated drone on Earth, by pymap3d alone, so that the bridge's own frames are tested."""

from __future__ import annotations

import pymap3d

from muster.mission.model import Origin
from muster.motion.port import Place


def ned_of(home: Origin, lat_deg: float, lon_deg: float, above_m: float) -> Place:
    """Metres north, east and down of home of a place on Earth so high above home."""
    at_home = home.lat_deg, home.lon_deg, home.alt_m
    north, east, _ = pymap3d.geodetic2ned(lat_deg, lon_deg, home.alt_m + above_m, *at_home)
    return float(north), float(east), -above_m


def degrees_of(home: Origin, ned: Place) -> tuple[float, float]:
    """Latitude and longitude of a place that is so far north, east and down of home."""
    lat, lon, _ = pymap3d.ned2geodetic(*ned, home.lat_deg, home.lon_deg, home.alt_m)
    return float(lat), float(lon)


def origin_at(origin: Origin, place: Place) -> Origin:
    """Where on Earth a place of a map (east, north, up) is, for a drone that is switched on there."""
    lat, lon, alt = pymap3d.enu2geodetic(*place, origin.lat_deg, origin.lon_deg, origin.alt_m)
    return Origin(lat_deg=float(lat), lon_deg=float(lon), alt_m=float(alt))
