"""KML 2.2 (OGC 07-147r2) and KMZ as layers, one a folder: placemarks with their points, lines and areas.

A height is read where `altitudeMode` says that it is one: over the ground, or absolute. Networks of links, overlays
and placemarks without a point, line or area (models, Google's tracks) are passed over, and named.
"""

from __future__ import annotations

import re
from collections.abc import Iterator, Sequence

from muster.mission.import_ledger import EMPTY, Source, passed_over, read_as
from muster_files.sites.features import Coordinate, Feature, Geometry, Layer, Ring, Shape, layer_of, refused
from muster_files.sites.xml_elements import Element, XmlDocument, titled

_SHAPES: dict[str, Shape] = {"Point": "point", "LineString": "line", "LinearRing": "line", "Polygon": "area"}
_LEAST = {"point": 1, "line": 2, "area": 3}
_PASSED_OVER = ("NetworkLink", "GroundOverlay", "ScreenOverlay", "PhotoOverlay")
_WITHOUT_SHAPE = "has no point, line or area"
_HEIGHTS = {"relativeToGround": True, "absolute": False}
"""Modes in which a height is one, and whether it is over the ground."""


def kml_layers(root: Element, file: str, others: Sequence[str] = ()) -> list[Layer]:
    """The folders of a document; `others` are the files beside it in its archive."""
    document = XmlDocument(root.take(), others)
    groups: dict[tuple[str, ...], list[Feature]] = {}
    lost = [element for element in root.within() if element.name in _PASSED_OVER]
    for folder, around, mark in placemarks(root):
        features = list(Placemark(mark, folder, file).features())
        groups.setdefault((folder, *around), []).extend(features)
        if not features:
            lost.append(mark)
    for element in lost:
        element.fate, element.whole = passed_over(_WITHOUT_SHAPE, noted=True), None
    layers = [layer_of(file, names[0], features, document, names[1:]) for names, features in groups.items() if features]
    return [*layers, Layer(file, "", (), (), tuple(map(titled, lost)), document=document)] if lost else layers


def placemarks(
    element: Element, folder: str = "", around: tuple[str, ...] = ()
) -> Iterator[tuple[str, tuple[str, ...], Element]]:
    """All placemarks, each with the name of the innermost folder in which it is, and of what that is in."""
    for child in element.children:
        if child.name == "Placemark":
            yield folder, around, child.take()
        elif child.name in ("Document", "Folder"):
            name = " ".join(child.take().told("name").split())
            if child.name == "Document":
                yield from placemarks(child, folder, (name, *around) if name else around)
            else:
                outer = (folder, *around) if folder and name else around
                yield from placemarks(child, name or folder, outer)


class Placemark:
    """Reads one placemark."""

    def __init__(self, mark: Element, folder: str, file: str) -> None:
        self._mark, self._file = mark, file
        self._name = " ".join(mark.told("name").split())
        self._where = ", ".join(part for part in (folder, self._name) if part)
        self._borders: set[int] = set()
        """The ids of rings that are borders of polygons."""

    def features(self) -> Iterator[Feature]:
        """The features of a placemark: one for each kind of shape in it."""
        source = self._mark.whole = Source()
        if (name := self._mark.first("name")) is not None:
            name.value = source, "name"
        values = self._values(source)
        pieces: dict[tuple[Shape, bool], list[tuple[Ring, ...]]] = {}
        for element in self._mark.within():
            if element.name == "MultiGeometry":
                element.take()
            if element.name in ("outerBoundaryIs", "innerBoundaryIs"):
                self._borders |= {id(child) for child in element.children}
            if element.name in _SHAPES and (found := self.piece(element)) is not None:
                shape, over_ground, rings = found
                pieces.setdefault((shape, over_ground), []).append(rings)
        for (shape, over_ground), rings_of in pieces.items():
            geometry = Geometry(shape, tuple(rings_of), over_ground)
            yield Feature(values, self._file, self._mark.line, self._where, geometry, source)

    def _values(self, source: Source) -> dict[str, object]:
        values: dict[str, object] = {"name": self._name} if self._name else {}
        for element in self._mark.within():
            if element.name in ("ExtendedData", "SchemaData"):
                element.take()
            if element.name in ("Data", "SimpleData") and (key := element.attribute("name").strip()):
                for child in element.children:
                    child.take(passed_over("stands beside the value"))
                told = element.text.strip() if element.name == "SimpleData" else element.told("value")
                if key in values:
                    element.fate = passed_over("stands beside another value of this name")
                elif told:
                    values[key] = told
                    element.value = source, key
                    if (value := element.first("value")) is not None:
                        value.fate = None
                else:
                    element.fate = EMPTY
        return values

    def piece(self, element: Element) -> tuple[Shape, bool, tuple[Ring, ...]] | None:
        """The shape of an element, whether its heights are over the ground, and its rings; None for a border."""
        element.take()
        mode = element.told("altitudeMode")
        if element.name == "Polygon":
            outer = element.first("outerBoundaryIs", "LinearRing")
            inner = [hole.first("LinearRing") for hole in element.all("innerBoundaryIs")]
            if outer is None:
                raise self._refused(element, "Polygon", "no outer boundary", "<outerBoundaryIs> with a <LinearRing>")
            rings = [outer, *(ring for ring in inner if ring is not None)]
            return "area", False, tuple(self._ring(ring, "area", spatial=False) for ring in rings)
        if id(element) in self._borders:
            return None
        shape = _SHAPES[element.name]
        return shape, _HEIGHTS.get(mode, False), (self._ring(element, shape, spatial=mode in _HEIGHTS),)

    def point(self, element: Element) -> Coordinate:
        """The place of a point, without its height."""
        return self._ring(element, "point", spatial=False)[0]

    def _ring(self, element: Element, shape: Shape, *, spatial: bool) -> Ring:
        told = re.sub(r"\s*,\s*", ",", element.told("coordinates")).split()
        ring = tuple(self._coordinate(element, one, spatial=spatial) for one in told)
        coordinates = element.first("coordinates")
        if coordinates is not None and (shape != "point" or not spatial) and any(map(_is_high, told)):
            why = "altitudeMode does not say what they are" if shape == "point" else "lines and areas have none"
            coordinates.fate = read_as(f"places without their heights: {why}")
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


def _is_high(told: str) -> bool:
    """Whether a coordinate has a height other than 0."""
    return told.count(",") == 2 and float(told.rpartition(",")[2]) != 0
