"""Closed areas and lanes far from a site: cut at a distance from its origin, or passed over, and named.

What becomes a task or a robot is never far: that is an error, which the builder of the mission reports.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

from muster.mission.errors import Finding
from muster_files.antimeridian import unwrapped
from muster_files.sites.entries import Entry, some_of
from muster_files.sites.features import Coordinate, Geometry, Ring
from muster_files.sites.frame import FARTHEST_M, Frame
from muster_files.sites.keys import CIRCLE
from muster_files.sites.shapes import mended

if TYPE_CHECKING:
    import shapely

MAY_BE_FAR = ("zone", "lane", CIRCLE)
"""Roles of features that are not needed where the robots are not."""
_KEPT_DEG = 0.85
"""Degrees of latitude from the origin at which areas are cut: a little less than `FARTHEST_M`."""
_PIECE_DEG = 0.01
"""Sides of areas that are cut have corners this close: a side that is straight on a map bends in the plane."""
_EXPECTED = "a place within {} km of the origin; are latitude and longitude swapped, or 0?"


def degrees_of(entry: Entry) -> Iterator[Coordinate]:
    """Yield the places of an entry that are in degrees."""
    if entry.degrees is not None:
        yield entry.degrees
    elif entry.geometry is not None:
        yield from (place for piece in entry.geometry.pieces for ring in piece for place in ring)


def without_far(entries: Sequence[Entry], frame: Frame, findings: list[Finding], notes: list[str]) -> list[Entry]:
    """Return the entries; closed areas and lanes that lead far away are cut there, those that are far are left out."""
    kept: list[Entry] = []
    far: list[str] = []
    cut: list[str] = []
    limit = f"{FARTHEST_M / 1000:g} km from the origin"
    for entry in entries:
        if entry.role not in MAY_BE_FAR or not any(map(frame.is_far, degrees_of(entry))):
            kept.append(entry)
            continue
        if (place := _mistaken(entry, frame)) is not None:
            told = f"latitude {place[1]:g}, longitude {place[0]:g}"
            findings.append(entry.feature.finding("", told, _EXPECTED.format(f"{FARTHEST_M / 1000:g}")))
            continue
        near = _near(entry, frame)
        (far if near is None else cut).append(entry.told)
        if near is None:
            entry.feature.source.drop(f"is farther than {limit}")
        else:
            kept.append(near)
    notes += [f"passed over, farther than {limit}: {some_of(far)}"] if far else []
    notes += [f"cut at {limit}: {some_of(cut)}"] if cut else []
    return kept


def _mistaken(entry: Entry, frame: Frame) -> Coordinate | None:
    """Return a far place that would be near with latitude and longitude swapped, or that is at 0, 0."""
    for place in degrees_of(entry):
        swapped = (place[1], place[0])
        if frame.is_far(place) and (place[:2] == (0, 0) or (abs(place[0]) <= 90 and not frame.is_far(swapped))):
            return place
    return None


def _near(entry: Entry, frame: Frame) -> Entry | None:
    """Return what of an entry is near the origin; None where nothing is."""
    if entry.role == CIRCLE:
        assert entry.degrees is not None
        radius = entry.values.get("radius_m", entry.values.get("diameter_m", 0.0))
        reaches = isinstance(radius, float) and frame.distance(entry.degrees) - radius < FARTHEST_M
        return entry if reaches else None
    assert entry.geometry is not None
    pieces: list[tuple[Ring, ...]]
    if entry.role == "lane":
        pieces = [(run,) for piece in entry.geometry.pieces for run in _near_runs(piece[0], frame)]
    else:
        pieces = list(_cut(entry.geometry, frame))
    shape = entry.geometry.shape if entry.role == "lane" else "area"
    return replace(entry, geometry=replace(entry.geometry, shape=shape, pieces=tuple(pieces))) if pieces else None


def _near_runs(line: Ring, frame: Frame) -> Iterator[Ring]:
    """Yield the parts of a line between places that are far."""
    run: list[Coordinate] = []
    for place in (*line, None):
        if place is not None and not frame.is_far(place):
            run.append(place)
            continue
        if len(run) > 1:
            yield tuple(run)
        run = []


def _cut(geometry: Geometry, frame: Frame) -> Iterator[tuple[Ring, ...]]:
    """Yield the rings of the parts of areas that are near; areas that are none as `mended` makes them."""
    import shapely

    around = _box(frame)
    for piece in geometry.pieces:
        rings = [[(unwrapped(place[0], frame.lon), place[1]) for place in ring] for ring in piece]
        for area in _areas(rings if geometry.shape == "area" else rings[:1]):
            for part in shapely.get_parts(shapely.intersection(area, around)):
                if part.geom_type == "Polygon" and part.area > 0:
                    yield tuple(_ring(line) for line in (part.exterior, *part.interiors))


def _areas(rings: list[list[tuple[float, float]]]) -> list[shapely.Polygon]:
    import shapely

    try:
        area = shapely.Polygon(rings[0], rings[1:])
    except (ValueError, shapely.errors.ShapelyError):
        return []
    if area.is_valid:
        return [area]
    try:
        return mended(rings)
    except ValueError:
        return []


def _ring(line: shapely.LinearRing) -> Ring:
    import shapely

    return tuple((x, y) for x, y in shapely.segmentize(line, _PIECE_DEG).coords)


def _box(frame: Frame) -> shapely.Polygon:
    import shapely

    wide = min(180.0, _KEPT_DEG / max(math.cos(math.radians(frame.lat)), 1e-3))
    return shapely.box(frame.lon - wide, frame.lat - _KEPT_DEG, frame.lon + wide, frame.lat + _KEPT_DEG)
