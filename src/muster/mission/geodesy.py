"""Places on Earth in the map frame and back: WGS84 to ENU about an origin, by pymap3d (extra `map`)."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from muster.mission.system.extras import needs_extra
from muster.mission.values.arrays import Floats


def wgs84_to_enu(places: npt.ArrayLike, origin: npt.ArrayLike) -> Floats:
    """Places in metres east, north and up of an origin, in the plane that touches the ellipsoid's level there.

    Parameters
    ----------
    places
        (n, 3) latitude and longitude in degrees, altitude above the ellipsoid in metres.
    origin
        (3,) of the same.

    Raises
    ------
    MissingExtraError
        without pymap3d.
    """
    lat, lon, alt = _columns(places)
    return np.stack(_pymap3d().geodetic2enu(lat, lon, alt, *_numbers(origin)), axis=-1)


def enu_to_wgs84(points: npt.ArrayLike, origin: npt.ArrayLike) -> Floats:
    """The inverse of `wgs84_to_enu`: (n, 3) metres in the map frame to (n, 3) latitude, longitude, altitude."""
    east, north, up = _columns(points)
    return np.stack(_pymap3d().enu2geodetic(east, north, up, *_numbers(origin)), axis=-1)


def _columns(values: npt.ArrayLike) -> Floats:
    return np.asarray(values, dtype=np.float64).reshape(-1, 3).T


def _numbers(origin: npt.ArrayLike) -> tuple[float, ...]:
    lat, lon, alt = np.asarray(origin, dtype=np.float64)
    return float(lat), float(lon), float(alt)


def _pymap3d() -> Any:
    with needs_extra("map", "a place in degrees (lat_lon)"):
        import pymap3d
    return pymap3d
