"""Polygons as the core takes them: rings with the inside on their left."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from muster.mission.values.arrays import Floats

if TYPE_CHECKING:
    import shapely


def rings_of(region: shapely.Polygon | shapely.MultiPolygon) -> list[Floats]:
    """Rings (k, 2) in metres, the first point not repeated: outer ones anticlockwise, holes clockwise."""
    polygons = getattr(region, "geoms", [region])
    rings = []
    for polygon in polygons:
        if polygon.is_empty:
            continue
        rings.append(_turned(polygon.exterior, anticlockwise=True))
        rings += [_turned(hole, anticlockwise=False) for hole in polygon.interiors]
    return rings


def _turned(ring: shapely.LinearRing, *, anticlockwise: bool) -> Floats:
    points = np.asarray(ring.coords, dtype=np.float64)[:-1, :2]
    return np.ascontiguousarray(points if ring.is_ccw == anticlockwise else points[::-1])
