"""GPX 1.0 and 1.1 (topografix.com/GPX) as layers: way points, routes and tracks; `ele` is metres over the ellipsoid.

Muster's own files have the kinds of places in `type`, and routes of a plan, which are no lanes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from muster.exchange.sites.features import Coordinate, Feature, Geometry, Layer, Ring, layer_of, refused
from muster.exchange.sites.file_sizes import read_bytes
from muster.exchange.sites.xml_elements import Element, parse_xml, titled

_OWN = "Muster"
_TEXTS = ("name", "type", "sym")
_UNSAID = {"sym": "symbol"}
_OWN_UNSAID = {**_UNSAID, "type": "kind"}


def read_gpx_layers(path: Path) -> Sequence[Layer]:
    """The way points, routes and tracks of a file; raises MissionError with the line at which it is none."""
    file = str(path)
    root = parse_xml(read_bytes(path), file, "gpx", "GPX")
    own = root.attributes.get("creator") == _OWN
    points = [
        Feature(
            _values(one, own=own), file, one.line, one.told("name"), Geometry("point", (((_coordinate(one, file),),),))
        )
        for one in root.all("wpt")
    ]
    drawn = [(one, list(_line(one, file, own=own))) for one in root.children if one.name in ("rte", "trk")]
    lines = [feature for _, features in drawn for feature in features]
    lost = tuple(titled(one) for one, features in drawn if not features)
    layers = [layer_of(file, "", features) for features in (points, lines) if features]
    return [*layers, Layer(file, "", (), (), lost)] if lost else layers


def _line(element: Element, file: str, *, own: bool) -> Iterator[Feature]:
    """A route or track; nothing, where it has less than two points."""
    if element.name == "rte":
        rings = [_ring(element.all("rtept"), file)]
    else:
        rings = [_ring(segment.all("trkpt"), file) for segment in element.all("trkseg")]
    pieces = tuple((ring,) for ring in rings if len(ring) > 1)
    if pieces:
        values = _values(element, own=own) | ({"kind": "route"} if own and element.name == "rte" else {})
        yield Feature(values, file, element.line, element.told("name"), Geometry("line", pieces))


def _values(element: Element, *, own: bool) -> dict[str, object]:
    """Its texts, and those of its extensions."""
    said_as = _OWN_UNSAID if own else _UNSAID
    told: dict[str, object] = {said_as.get(name, name): element.told(name) for name in _TEXTS if element.told(name)}
    extensions = element.first("extensions")
    for one in () if extensions is None else extensions.within():
        if one.text.strip() and not one.children:
            told.setdefault(one.name, one.text.strip())
    return told


def _ring(points: Sequence[Element], file: str) -> Ring:
    return tuple(_coordinate(point, file)[:2] for point in points)


def _coordinate(point: Element, file: str) -> Coordinate:
    numbers = []
    for name, most in (("lon", 180.0), ("lat", 90.0)):
        told = point.attributes.get(name, "")
        number = _number(told)
        if number is None or not abs(number) <= most:  # not a number is refused too
            field = ", ".join(part for part in (point.told("name"), f"{point.name} {name}") if part)
            raise refused(file, point.line, field, told or "missing", f"degrees from -{most:g} to {most:g}")
        numbers.append(number)
    told = point.told("ele")
    if not told:
        return tuple(numbers)
    height = _number(told)
    if height is None or not abs(height) <= 1e6:
        raise refused(file, point.line, f"{point.name} ele", told, "metres")
    return (*numbers, height)


def _number(told: str) -> float | None:
    try:
        return float(told)
    except ValueError:
        return None
