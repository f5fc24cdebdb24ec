"""A plan as GeoJSON (RFC 7946): longitude first, then latitude, and in 3-D metres above the ellipsoid (section 4).

Polygons are closed and follow the right-hand rule (section 3.1.6). What crosses the meridian of 180 degrees is cut
there (section 3.1.9). Numbers in properties are those of the schedule.
"""

from __future__ import annotations

import json
from collections.abc import Sequence
from typing import Any

from muster_files.antimeridian import cut_line, cut_ring
from muster_files.earth import Spot
from muster_files.geographic_features import AREAS, Feature, PlanFeatures


def geojson_text(plan: PlanFeatures) -> str:
    """A FeatureCollection; one line a feature."""
    features = ",\n".join(json.dumps(_feature(feature), ensure_ascii=False) for feature in plan.features)
    head = json.dumps(plan.mission, ensure_ascii=False)
    return f'{{"type": "FeatureCollection", "name": {head}, "features": [\n{features}\n]}}\n'


def _feature(feature: Feature) -> dict[str, Any]:
    return {"type": "Feature", "geometry": _geometry(feature), "properties": feature.properties}


def _geometry(feature: Feature) -> dict[str, Any]:
    if feature.kind == "route":
        return one_or_many("LineString", [_places(line, feature) for line in cut_line(feature.spots)])
    if feature.kind in AREAS:
        rings = [_places([*ring, ring[0]], feature) for ring in cut_ring(feature.spots)]
        return one_or_many("Polygon", [[ring] for ring in rings])
    return {"type": "Point", "coordinates": _places(feature.spots, feature)[0]}


def one_or_many(kind: str, pieces: list[Any]) -> dict[str, Any]:
    """A geometry of one piece, or of its `Multi` kind."""
    if len(pieces) == 1:
        return {"type": kind, "coordinates": pieces[0]}
    return {"type": f"Multi{kind}", "coordinates": pieces}


def _places(spots: Sequence[Spot], feature: Feature) -> list[list[float]]:
    """[longitude, latitude], and the height of what has one: areas lie on the ground."""
    flat = feature.heights_m is None or feature.kind in AREAS
    return [[spot.lon, spot.lat] if flat else [spot.lon, spot.lat, spot.alt] for spot in spots]
