"""KML 2.2 (OGC 07-147r2) and KMZ as layers, one a folder: placemarks with their points, lines and areas.

A height is read where `altitudeMode` says that it is one: over the ground, or absolute. Networks of links, overlays
and placemarks without a point, line or area (models, Google's tracks) are passed over, and named.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence
from pathlib import Path

from muster.exchange.sites.features import Coordinate, Feature, Geometry, Layer, Ring, Shape, layer_of, refused
from muster.exchange.sites.file_sizes import open_archive, read_bytes, unpacked
from muster.exchange.sites.xml_elements import Element, parse_xml, titled

_WHAT = "KML"
_KMZ = "KMZ: a ZIP archive with a .kml in it"
_SHAPES: dict[str, Shape] = {"Point": "point", "LineString": "line", "LinearRing": "line", "Polygon": "area"}
_LEAST = {"point": 1, "line": 2, "area": 3}
_PASSED_OVER = ("NetworkLink", "GroundOverlay", "ScreenOverlay", "PhotoOverlay")
_HEIGHTS = {"relativeToGround": True, "absolute": False}
"""Modes in which a height is one, and whether it is over the ground."""


def read_kml_layers(path: Path) -> Sequence[Layer]:
    """The folders of a KML file; raises MissionError with the line at which it is none."""
    return _layers(read_bytes(path), str(path))


def read_kmz_layers(path: Path) -> Sequence[Layer]:
    """The folders of the first KML file in an archive; raises MissionError where there is none."""
    with open_archive(path, _KMZ) as archive:
        names = [name for name in archive.namelist() if name.lower().endswith(".kml")]
        if not names:
            raise refused(str(path), None, "", "no .kml in it", _KMZ)
        name = "doc.kml" if "doc.kml" in names else names[0]
        return _layers(unpacked(archive, name, path, _KMZ), str(path))


def _layers(data: bytes, file: str) -> list[Layer]:
    root = parse_xml(data, file, "kml", _WHAT)
    groups: dict[tuple[str, ...], list[Feature]] = {}
    lost = [element for element in root.within() if element.name in _PASSED_OVER]
    for folder, around, mark in _placemarks(root, "", ()):
        features = list(_Placemark(mark, folder, file).features())
        groups.setdefault((folder, *around), []).extend(features)
        if not features:
            lost.append(mark)
    layers = [layer_of(file, names[0], features, names[1:]) for names, features in groups.items() if features]
    return [*layers, Layer(file, "", (), (), tuple(map(titled, lost)))] if lost else layers


def _placemarks(
    element: Element, folder: str, around: tuple[str, ...]
) -> Iterator[tuple[str, tuple[str, ...], Element]]:
    """All placemarks, each with the name of the innermost folder in which it is, and of what that is in."""
    for child in element.children:
        if child.name == "Placemark":
            yield folder, around, child
        elif child.name in ("Document", "Folder"):
            name = " ".join(child.told("name").split())
            if child.name == "Document":
                yield from _placemarks(child, folder, (name, *around) if name else around)
            else:
                outer = (folder, *around) if folder and name else around
                yield from _placemarks(child, name or folder, outer)


class _Placemark:
    """Reads one placemark."""

    def __init__(self, mark: Element, folder: str, file: str) -> None:
        self._mark, self._file = mark, file
        self._name = " ".join(mark.told("name").split())
        self._where = ", ".join(part for part in (folder, self._name) if part)

    def features(self) -> Iterator[Feature]:
        values = self._values()
        pieces: dict[tuple[Shape, bool], list[tuple[Ring, ...]]] = {}
        for element in self._mark.within():
            if element.name in _SHAPES and (found := self._piece(element)) is not None:
                shape, over_ground, rings = found
                pieces.setdefault((shape, over_ground), []).append(rings)
        for (shape, over_ground), rings_of in pieces.items():
            geometry = Geometry(shape, tuple(rings_of), over_ground)
            yield Feature(values, self._file, self._mark.line, self._where, geometry)

    def _values(self) -> dict[str, object]:
        values: dict[str, object] = {"name": self._name} if self._name else {}
        for element in self._mark.within():
            if element.name in ("Data", "SimpleData") and (key := element.attributes.get("name", "").strip()):
                told = element.text.strip() if element.name == "SimpleData" else element.told("value")
                if told:
                    values.setdefault(key, told)
        return values

    def _piece(self, element: Element) -> tuple[Shape, bool, tuple[Ring, ...]] | None:
        mode = element.told("altitudeMode")
        if element.name == "Polygon":
            outer = element.first("outerBoundaryIs", "LinearRing")
            inner = [hole.first("LinearRing") for hole in element.all("innerBoundaryIs")]
            if outer is None:
                raise self._refused(element, "Polygon", "no outer boundary", "<outerBoundaryIs> with a <LinearRing>")
            rings = [outer, *(ring for ring in inner if ring is not None)]
            return "area", False, tuple(self._ring(ring, "area", spatial=False) for ring in rings)
        if element.name == "LinearRing" and self._is_of_polygon(element):
            return None
        shape = _SHAPES[element.name]
        return shape, _HEIGHTS.get(mode, False), (self._ring(element, shape, spatial=mode in _HEIGHTS),)

    def _is_of_polygon(self, ring: Element) -> bool:
        borders = (e for e in self._mark.within() if e.name in ("outerBoundaryIs", "innerBoundaryIs"))
        return any(ring is child for border in borders for child in border.children)

    def _ring(self, element: Element, shape: Shape, *, spatial: bool) -> Ring:
        told = re.sub(r"\s*,\s*", ",", element.told("coordinates")).split()
        ring = tuple(self._coordinate(element, one, spatial=spatial) for one in told)
        if len(ring) < _LEAST[shape] or (shape == "point" and len(ring) > 1):
            several = "one place" if shape == "point" else f"at least {_LEAST[shape]} places"
            raise self._refused(element, "coordinates", " ".join(told) or "missing", several)
        return ring

    def _coordinate(self, element: Element, told: str, *, spatial: bool) -> Coordinate:
        try:
            numbers = tuple(map(float, told.split(",")))
        except ValueError:
            numbers = ()
        right = len(numbers) in (2, 3) and abs(numbers[0]) <= 360 and abs(numbers[1]) <= 90
        if not right or not all(abs(number) < 1e9 for number in numbers):
            raise self._refused(element, "coordinates", told, "longitude,latitude or longitude,latitude,height")
        return numbers if spatial else numbers[:2]

    def _refused(self, element: Element, field: str, value: str, expected: str) -> Exception:
        where = f"{self._where}, {field}" if self._where else field
        return refused(self._file, element.line, where, value if len(value) < 60 else value[:57] + "...", expected)
