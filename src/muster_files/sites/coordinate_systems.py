"""Coordinates of other systems (UTM, national grids) in WGS84, by pyproj (extra `sites`)."""

from __future__ import annotations

import math
import re
from collections.abc import Callable

from muster.mission.system.extras import needs_extra
from muster_files.sites.features import Coordinate, refused

_WGS84 = re.compile(r"(urn:ogc:def:crs:)?(OGC:[\d.]*:?CRS84h?|EPSG:[\d.]*:?(4326|4979))", re.IGNORECASE)
_EXPECTED = "a coordinate system that is known, as EPSG:4326"


def to_wgs84(system: str, file: str, field: str) -> Callable[[Coordinate], Coordinate] | None:
    """What makes longitude and latitude of coordinates of a system; None where they are that already.

    Raises
    ------
    MissionError
        if nobody knows the system.
    MissingExtraError
        without pyproj, for another system than WGS84.
    """
    if _WGS84.fullmatch(system.strip()):
        return None
    with needs_extra("sites", f"{file}: coordinates in {system}"):
        from pyproj import Transformer
        from pyproj.exceptions import ProjError
    try:
        transformer = Transformer.from_crs(system, "EPSG:4326", always_xy=True)
    except (ProjError, UnicodeError) as error:
        told = f"{system} ({' '.join(str(error).split())[:80]})"
        raise refused(file, None, field, told, _EXPECTED) from None

    def converted(place: Coordinate) -> Coordinate:
        lon, lat = transformer.transform(place[0], place[1])
        if not (math.isfinite(lon) and math.isfinite(lat)):
            raise refused(file, None, field, list(place), f"a place within {system}")
        return (lon, lat, *place[2:])

    return converted
