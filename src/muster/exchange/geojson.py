"""A plan as GeoJSON (RFC 7946): longitude first, then latitude, and in 3-D metres above the ellipsoid (section 4).

Polygons are closed and follow the right-hand rule (section 3.1.6). Numbers in properties are those of the schedule.
"""

from __future__ import annotations

import json
from typing import Any

from muster.exchange.earth import Spot
from muster.exchange.survey import Feature, Survey


def geojson_text(survey: Survey) -> str:
    """A FeatureCollection; one line a feature."""
    features = ",\n".join(json.dumps(_feature(feature), ensure_ascii=False) for feature in survey.features)
    head = json.dumps(survey.mission, ensure_ascii=False)
    return f'{{"type": "FeatureCollection", "name": {head}, "features": [\n{features}\n]}}\n'


def _feature(feature: Feature) -> dict[str, Any]:
    return {"type": "Feature", "geometry": _geometry(feature), "properties": feature.properties}


def _geometry(feature: Feature) -> dict[str, Any]:
    places = [_coordinates(spot, feature) for spot in feature.spots]
    if feature.kind == "route":
        return {"type": "LineString", "coordinates": places}
    if feature.kind in ("boundary", "zone"):
        return {"type": "Polygon", "coordinates": [[*places, places[0]]]}
    return {"type": "Point", "coordinates": places[0]}


def _coordinates(spot: Spot, feature: Feature) -> list[float]:
    """[longitude, latitude], and the height of what has one: areas lie on the ground."""
    flat = feature.heights_m is None or feature.kind in ("boundary", "zone")
    return [spot.lon, spot.lat] if flat else [spot.lon, spot.lat, spot.alt]
