"""GPX 1.0 and 1.1 (topografix.com/GPX) as layers: way points, routes and tracks; `ele` is metres over the ellipsoid.

Muster's own files have the kinds of places in `type`, and routes of a plan, which are no lanes.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from pathlib import Path

from muster.mission.import_ledger import Source, passed_over, read_as
from muster_files.sites.features import HEIGHT, Coordinate, Feature, Geometry, Layer, Ring, layer_of, refused
from muster_files.sites.file_sizes import read_bytes
from muster_files.sites.xml_elements import Element, XmlDocument, parse_xml, titled

_OWN = "Muster"
_TEXTS = ("name", "type", "sym")
_UNSAID = {"sym": "symbol"}
_OWN_UNSAID = {**_UNSAID, "type": "kind"}


def read_gpx_layers(path: Path) -> Sequence[Layer]:
    """The way points, routes and tracks of a file; raises MissionError with the line at which it is none."""
    file = str(path)
    root = parse_xml(read_bytes(path), file, "gpx", "GPX")
    document = XmlDocument(root.take())
    own = root.attribute("creator") == _OWN
    points = [_point(one, file, own=own) for one in root.all("wpt")]
    drawn = [(one, list(_line(one, file, own=own))) for one in root.children if one.name in ("rte", "trk")]
    lines = [feature for _, features in drawn for feature in features]
    lost = tuple(titled(one) for one, features in drawn if not features)
    for one, features in drawn:
        one.take(read_as("a line") if features else passed_over("has less than two points", noted=True))
    layers = [layer_of(file, "", features, document) for features in (points, lines) if features]
    return [*layers, Layer(file, "", (), (), lost, document=document)] if lost else layers


def _point(element: Element, file: str, *, own: bool) -> Feature:
    """A way point; its height is one of its values for the ledger."""
    values = _values(element, own=own)
    geometry = Geometry("point", (((_coordinate(element, file),),),))
    if (height := element.first("ele")) is not None:
        height.value = element.whole or Source(), HEIGHT
    return Feature(values, file, element.line, element.told("name"), geometry, element.whole or Source())


def _line(element: Element, file: str, *, own: bool) -> Iterator[Feature]:
    """A route or track; nothing, where it has less than two points."""
    if element.name == "rte":
        rings = [_ring(element.all("rtept"), file)]
    else:
        rings = [_ring(segment.all("trkpt"), file) for segment in element.all("trkseg")]
    pieces = tuple((ring,) for ring in rings if len(ring) > 1)
    if pieces:
        values = _values(element, own=own) | ({"kind": "route"} if own and element.name == "rte" else {})
        source = element.whole or Source()
        yield Feature(values, file, element.line, element.told("name"), Geometry("line", pieces), source)


def _values(element: Element, *, own: bool) -> dict[str, object]:
    """Its texts, and those of its extensions."""
    said_as = _OWN_UNSAID if own else _UNSAID
    source = element.whole = Source()
    told: dict[str, object] = {}
    for name in _TEXTS:
        if (text := element.told(name)) and (one := element.first(name)) is not None:
            told[said_as.get(name, name)] = text
            one.value = source, said_as.get(name, name)
    extensions = element.first("extensions")
    for one in () if extensions is None else extensions.within():
        if one.text.strip() and not one.children:
            if one.name in told:
                one.take(passed_over("stands beside another value of this name"))
            else:
                told[one.name] = one.text.strip()
                one.value = source, one.name
        elif one.children:
            one.take()
    return told


def _ring(points: Sequence[Element], file: str) -> Ring:
    return tuple(_coordinate(point, file, spatial=False)[:2] for point in points)


def _coordinate(point: Element, file: str, *, spatial: bool = True) -> Coordinate:
    numbers = []
    for name, most in (("lon", 180.0), ("lat", 90.0)):
        told = point.attribute(name)
        number = _number(told)
        if number is None or not abs(number) <= most:  # not a number is refused too
            field = ", ".join(part for part in (point.told("name"), f"{point.name} {name}") if part)
            raise refused(file, point.line, field, told or "missing", f"degrees from -{most:g} to {most:g}")
        numbers.append(number)
    told = point.told("ele") if spatial else ""
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
