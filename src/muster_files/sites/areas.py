"""Areas of a site in metres: zones, the boundary, and areas to survey, each with its holes."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from muster.mission.errors import Finding
from muster.mission.system.extras import needs_extra
from muster_files.antimeridian import unwrapped
from muster_files.sites.decisions import is_open_line, is_wall
from muster_files.sites.entries import Entry
from muster_files.sites.features import Coordinate, Ring
from muster_files.sites.frame import Frame
from muster_files.sites.keys import COVERAGE
from muster_files.sites.labels import quoted
from muster_files.sites.shapes import mended, require_valid, without_holes

if TYPE_CHECKING:
    import shapely

_SEAM = 1e-8
"""Degrees within which a corner on the meridian of 180 degrees lies on the line between its neighbours."""
_MARGIN_M = 50.0
_WALL_M = 0.25
"""How far to each side of an open line that is closed robots may not come."""
_LEAST_CORNERS = 3
_EXPECTED = "an area whose sides meet at its corners alone"


def areas_of(
    entry: Entry, frame: Frame, findings: list[Finding], mends: dict[str, list[str]] | None = None
) -> list[shapely.Polygon]:
    """The areas of an entry in metres; those cut at the meridian of 180 degrees are whole again.

    Parameters
    ----------
    mends
        notes by what was done to areas that are none: with it such areas are made to contain all that they may mean.

    Raises
    ------
    MissingExtraError
        without shapely.
    """
    with needs_extra("map", f"{entry.feature.file}: areas"):
        import shapely
    assert entry.geometry is not None
    pieces = [[_open(ring) for ring in piece] for piece in entry.geometry.pieces]
    if entry.geometry.shape == "line":
        pieces = [[[place for piece in pieces for place in piece[0]]]]  # a track around an area
    found: list[shapely.Polygon] = []
    wrong: list[Finding] = []
    if mends is not None and is_open_line(entry.feature):
        found += _walls(pieces, frame)
        mends.setdefault(f"closed lines are closed {_WALL_M:g} m to each side", []).append(entry.told)
        if is_wall(entry.reason) or len(pieces[0][0]) < _LEAST_CORNERS:
            return [shapely.orient_polygons(area) for area in found]
    for rings in _whole(pieces, frame):
        metres = [frame.metres([place[:2] for place in ring]) for ring in rings]
        try:
            found.append(require_valid(metres))
        except ValueError as error:
            told, *places = error.args
            told += "".join(f" at latitude {lat}, longitude {lon}" for lat, lon in map(frame.degrees, places))
            wrong.append(entry.feature.finding("geometry", told, _EXPECTED))
            if mends is not None:
                found += _mended(entry, metres, told, mends)
    if mends is None or not found:
        findings += wrong
    return [shapely.orient_polygons(area) for area in found]


def _walls(pieces: list[list[list[Coordinate]]], frame: Frame) -> list[shapely.Polygon]:
    """What is closed along open lines."""
    import shapely

    lines = [shapely.LineString(frame.metres([place[:2] for place in line])) for (line,) in pieces if len(line) > 1]
    walls = shapely.union_all([line.buffer(_WALL_M, cap_style="square", join_style="mitre") for line in lines])
    return [one for one in shapely.get_parts(walls).tolist() if one.area > 0]


def _mended(
    entry: Entry, rings: list[list[list[float]]], told: str, mends: dict[str, list[str]]
) -> list[shapely.Polygon]:
    """What contains an area that is none; nothing where it encloses nothing."""
    try:
        found = mended(rings)
    except ValueError:
        return []
    filled = ", its holes too" if len(rings) > 1 else ""
    mends.setdefault(f"closed areas whose sides cross are closed as a whole{filled}", []).append(
        f"{entry.told} ({told})"
    )
    return found


def _open(ring: Ring) -> list[Coordinate]:
    """The corners of a ring, none of them twice in a row."""
    corners = [ring[0][:2], *(b[:2] for a, b in pairwise(ring) if a[:2] != b[:2])]
    return corners[:-1] if len(corners) > 1 and corners[0] == corners[-1] else corners


def _whole(pieces: list[list[list[Coordinate]]], frame: Frame) -> list[list[list[Coordinate]]]:
    """Areas that were cut at the meridian of 180 degrees (RFC 7946, section 3.1.9), put together."""
    cut = [any(abs(abs(place[0]) - 180) < _SEAM for ring in piece for place in ring) for piece in pieces]
    if sum(cut) < 2:
        return pieces
    import shapely

    sides = [
        shapely.Polygon(*_rings([[(unwrapped(place[0], frame.lon), place[1]) for place in ring] for ring in piece]))
        for piece, is_cut in zip(pieces, cut, strict=True)
        if is_cut and all(len(ring) > 2 for ring in piece)
    ]
    if not all(side.is_valid for side in sides):
        return pieces
    joined = [
        [_without_seam(line.coords[:-1]) for line in (area.exterior, *area.interiors)]
        for area in shapely.get_parts(shapely.union_all(sides, grid_size=1e-9))
        if area.geom_type == "Polygon"
    ]
    return [*joined, *(piece for piece, is_cut in zip(pieces, cut, strict=True) if not is_cut)]


def _rings(rings: list[list[Coordinate]]) -> tuple[list[Coordinate], list[list[Coordinate]]]:
    return rings[0], rings[1:]


def _without_seam(corners: Sequence[Sequence[float]]) -> list[Coordinate]:
    """The corners without those that the cut has made."""
    kept: list[Coordinate] = []
    for k, here in enumerate(corners):
        before, after = corners[k - 1], corners[(k + 1) % len(corners)]
        turn = abs((here[0] - before[0]) * (after[1] - before[1]) - (here[1] - before[1]) * (after[0] - before[0]))
        length = max(abs(after[0] - before[0]), abs(after[1] - before[1]))
        if abs(abs(here[0]) - 180) > _SEAM or turn > _SEAM * length:
            kept.append((here[0], here[1]))
    return kept


_OF_ZONES = ("floor_m", "ceiling_m", "forbidden_to", "open")


def circle_of(entry: Entry, center: Sequence[float], findings: list[Finding]) -> dict[str, Any]:
    """The zone of a mission's map around a point."""
    values = entry.values
    radius = values.get("radius_m")
    if radius is None and isinstance(across := values.get("diameter_m"), float):
        radius = across / 2
    if radius is None:
        expected = (
            f"a column radius (m), an area in place of the point; or --as {quoted(f'{entry.told}=task')} or =skip"
        )
        told = f"a closed area at a point, without a radius: {entry.reason}"
        findings.append(entry.feature.finding("radius", told, expected))
    own = {key: values[key] for key in _OF_ZONES if key in values}
    door = {"id": values["door"]} if "door" in values else {}
    return {"circle": {"center": list(center[:2]), "radius_m": radius}, **own, **door}


def zones_of(entry: Entry, areas: Sequence[shapely.Polygon], findings: list[Finding]) -> list[dict[str, Any]]:
    """The zones of a mission's map: areas with holes are cut into several without."""
    polygons = [_corners(part.exterior) for area in areas for part in without_holes(area)]
    own = {key: entry.values[key] for key in _OF_ZONES if key in entry.values}
    if "door" in entry.values:
        own["id"] = entry.values["door"]
        if len(polygons) > 1:
            findings.append(entry.finding("door", entry.values["door"], "one area without holes for a door"))
    return [{"polygon": polygon, **own} for polygon in polygons]


def boundary_of(
    entry: Entry, areas: Sequence[shapely.Polygon], findings: list[Finding]
) -> tuple[list[list[float]], list[dict[str, Any]]]:
    """The boundary of a mission's map, and its holes as zones."""
    if len(areas) != 1:
        if areas:
            findings.append(entry.feature.finding("geometry", f"{len(areas)} areas", "one area for the boundary"))
        return [], []
    (area,) = areas
    return _corners(area.exterior), [{"polygon": _corners(hole)} for hole in area.interiors]


def seen_from(entry: Entry, stated: Mapping[str, float | None], *, has_camera: bool, findings: list[Finding]) -> Entry:
    """Return an area to survey with what is stated for all; a finding where nothing says how wide its lanes are."""
    own = {key: value for key, value in stated.items() if value is not None}
    if "width_m" in entry.values or "fov_deg" in entry.values:
        own = {key: value for key, value in own.items() if key == "height_m"}
    values = {**own, **entry.values}
    if "width_m" not in values and "height_m" not in values:
        expected = "a property height_m, or --height-m METRES: from how high it is seen; or --width-m of a tool"
        findings.append(entry.feature.finding("height_m", "missing", expected))
    elif "width_m" not in values and "fov_deg" not in values and not has_camera:
        expected = "a property fov_deg, or --fov-deg DEGREES: how wide the camera sees; or robots with a camera"
        findings.append(entry.feature.finding("fov_deg", "missing", expected))
    return replace(entry, values=values)


def survey_tasks(
    entry: Entry, areas: Sequence[shapely.Polygon], holes: Sequence[shapely.Polygon], at: Sequence[float]
) -> list[dict[str, Any]]:
    """Tasks to survey areas; what the action is to know comes from the entry, under the names of its keys.

    `holes` are those beside the ones in the areas; `at` is where the task is, or only its height, if it has any.
    """
    from muster.mission.action_keys import ACTION_KEYS

    keys = ACTION_KEYS[COVERAGE].names
    found = []
    for area in areas:
        action: dict[str, Any] = {"name": COVERAGE, "area": _corners(area.exterior)}
        if rings := [*area.interiors, *(hole.exterior for hole in holes)]:
            action["holes"] = [_corners(ring) for ring in rings]
        action |= {key: value for key, value in entry.values.items() if key in keys}
        inside = area.representative_point()
        place = list(at) if len(at) > 1 else [round(inside.x, 4), round(inside.y, 4), *at]
        found.append({"position": place, "action": action})
    return found


def corners_of(zone: dict[str, Any]) -> list[list[float]]:
    """The corners of a zone, those of a square around one that is a circle."""
    if "polygon" in zone:
        return list(zone["polygon"])
    (x, y), radius = zone["circle"]["center"], zone["circle"]["radius_m"] or 0.0
    return [[x - radius, y - radius], [x + radius, y + radius]]


def around(points: Sequence[Sequence[float]]) -> list[list[float]]:
    """A rectangle around all points, with a margin, in whole metres."""
    west, south = (float(int(min(p[k] for p in points) - _MARGIN_M)) for k in (0, 1))
    east, north = (float(int(max(p[k] for p in points) + _MARGIN_M)) for k in (0, 1))
    return [[west, south], [east, south], [east, north], [west, north]]


def _corners(line: shapely.LinearRing) -> list[list[float]]:
    return [[round(x, 4) + 0.0, round(y, 4) + 0.0] for x, y in line.coords[:-1]]
