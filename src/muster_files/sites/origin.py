"""The origin of a site's map frame, and its entries as far as they are near it.

Closed areas and lanes far from a site are cut at a distance from its origin, or passed over, and named. What becomes a
task or a robot is never far: that is an error, which the builder of the mission reports.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

from muster.mission.errors import Finding
from muster.mission.value_types import shown
from muster_files.antimeridian import unwrapped
from muster_files.sites.entries import Entry, some_of
from muster_files.sites.features import Coordinate, Geometry, Ring
from muster_files.sites.frame import FARTHEST_M, Frame
from muster_files.sites.keys import CIRCLE
from muster_files.sites.shapes import mended

if TYPE_CHECKING:
    import shapely

_MAY_BE_FAR = ("zone", "lane", CIRCLE)
"""Roles of features that are not needed where the robots are not."""
_KEPT_DEG = 0.85
"""Degrees of latitude from the origin at which areas are cut: a little less than `FARTHEST_M`."""
_PIECE_DEG = 0.01
"""Sides of areas that are cut have corners this close: a side that is straight on a map bends in the plane."""
_EXPECTED = "a place within {} km of the origin; are latitude and longitude swapped, or 0?"


@dataclass
class SiteOrigin:
    """The frame of a site; None where nothing is in degrees.

    Parameters
    ----------
    entries
        those of the site, without what is far away and not needed there.
    chosen
        the origin as mission files have it, where the mission has none yet.
    """

    frame: Frame | None
    entries: list[Entry]
    chosen: dict[str, Any] | None = None
    findings: list[Finding] = field(default_factory=list)
    notes: list[str] = field(default_factory=list)


def choose_origin(
    entries: Sequence[Entry], base: Mapping[str, Any], stated: Sequence[float] | None, *, flat: bool
) -> SiteOrigin:
    """Return the origin of the mission that is there, the one that a user states, or the middle of the site."""
    found = SiteOrigin(None, list(entries))
    given = base.get("origin_wgs84")
    is_middle = False
    if given is not None:
        if stated is not None:
            told = "none beside origin_wgs84 of the mission that is there"
            found.findings.append(Finding("--origin", None, "", shown(list(stated)), told))
        found.frame = Frame(given["lat_deg"], given["lon_deg"], given.get("alt_m", 0.0))
    elif stated is not None:
        found.frame = Frame(stated[0], stated[1], stated[2] if len(stated) > 2 else 0.0)
    else:
        is_middle = _choose_middle(found, has_base=bool(base), flat=flat)
    if found.frame is None:
        return found
    if given is None:
        found.chosen = {"lat_deg": found.frame.lat, "lon_deg": found.frame.lon, "alt_m": found.frame.alt}
    found.entries = _without_far(entries, found.frame, found.findings, found.notes)
    _refuse_far(found, is_middle=is_middle)
    return found


def _choose_middle(found: SiteOrigin, *, has_base: bool, flat: bool) -> bool:
    """Choose the middle of all places, as far as there are any in degrees and none in metres beside them."""
    in_degrees = [entry for entry in found.entries if any(True for _ in _degrees_of(entry))]
    in_metres = next((entry for entry in found.entries if _is_in_metres(entry)), None)
    if not in_degrees:
        return False
    if in_metres is not None or has_base:
        expected = "--origin LAT,LON, the place of [0, 0] on Earth, as others are in metres"
        where = "" if in_metres is None else f" ({in_metres.feature.file})"
        found.findings.append(in_degrees[0].feature.finding("", "a place in degrees", expected + where))
        return False
    altitudes = [e.height for e in found.entries if e.height is not None and not e.over_ground and not flat]
    frame = Frame.around(list(_places(in_degrees)), altitudes)
    needed = [entry for entry in in_degrees if entry.role not in _MAY_BE_FAR]
    if needed and any(map(frame.is_far, _places(in_degrees))):
        frame = Frame.around(list(_places(needed)), altitudes)
    found.frame = frame
    found.notes.append(
        f"origin_wgs84 chosen: lat_deg {frame.lat}, lon_deg {frame.lon}, alt_m {frame.alt}; --origin says another"
    )
    return True


def _is_in_metres(entry: Entry) -> bool:
    return entry.metres is not None or (entry.geometry is not None and entry.geometry.in_metres)


def _places(entries: Iterable[Entry]) -> Iterable[Coordinate]:
    return (place for entry in entries for place in _degrees_of(entry))


def _refuse_far(found: SiteOrigin, *, is_middle: bool) -> None:
    """Refuse places that cannot be meant: the first that is far from a given origin, or that far from most others.

    An origin in the middle is far from all places, where one of them is wrong.
    """
    frame = found.frame
    assert frame is not None
    needed = [entry for entry in found.entries if entry.role not in _MAY_BE_FAR]
    far = next(((entry, place) for entry in needed for place in _degrees_of(entry) if frame.is_far(place)), None)
    if far is None or found.findings:
        return
    limit = f"{FARTHEST_M / 1000:g} km"
    if not is_middle:
        told = f"within {limit} of the origin, not {frame.distance(far[1]) / 1000:,.0f}"
    else:
        places = [(entry, place) for entry in needed for place in _degrees_of(entry)]
        most = Frame.amid([place for _, place in places])
        far = max(places, key=lambda one: most.distance(one[1]))
        origin = f"the origin, which is chosen in the middle of all places: latitude {frame.lat}, longitude {frame.lon}"
        told = f"within {limit} of {origin}; this place is {most.distance(far[1]) / 1000:,.0f} km from most others"
    entry, place = far
    value = f"latitude {place[1]:g}, longitude {place[0]:g}"
    found.findings.append(entry.feature.finding("", value, f"{told}; are latitude and longitude swapped, or 0?"))


def _degrees_of(entry: Entry) -> Iterator[Coordinate]:
    """Yield the places of an entry that are in degrees."""
    if entry.degrees is not None:
        yield entry.degrees
    elif entry.geometry is not None and not entry.geometry.in_metres:
        yield from (place for piece in entry.geometry.pieces for ring in piece for place in ring)


def _without_far(entries: Sequence[Entry], frame: Frame, findings: list[Finding], notes: list[str]) -> list[Entry]:
    """Return the entries; closed areas and lanes that lead far away are cut there, those that are far are left out."""
    kept: list[Entry] = []
    far: list[str] = []
    cut: list[str] = []
    limit = f"{FARTHEST_M / 1000:g} km from the origin"
    for entry in entries:
        if entry.role not in _MAY_BE_FAR or not any(map(frame.is_far, _degrees_of(entry))):
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
    for place in _degrees_of(entry):
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
