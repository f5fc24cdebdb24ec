"""GeoJSON (RFC 7946) as a layer: a collection, a feature or a geometry; longitude first, heights over the ellipsoid.

A `crs`, which the standard no longer has, is kept to where it stands. Route graphs of Nav2, which have the same form,
are lines of lanes in the map's frame.
"""

from __future__ import annotations

import json
import math
from collections.abc import Callable, Iterator, Mapping, Sequence
from pathlib import Path
from typing import Any

from muster.mission.import_ledger import Fate, LedgerBook, Source, passed_over, read_as
from muster.mission.reading.json_reader import JsonPlaces
from muster.mission.value_types import Path as Where
from muster_files.sites.coordinate_systems import to_wgs84
from muster_files.sites.csv_reader import decoded
from muster_files.sites.features import (
    Coordinate,
    Feature,
    Geometry,
    Layer,
    Ring,
    Shape,
    layer_of,
    refused,
    with_name,
)
from muster_files.sites.file_sizes import read_bytes, require_moderate_json
from muster_files.sites.route_graph import RouteGraph, is_edge
from muster_files.tracked_json import Tracked, enter_json, parse_tracked

_WHAT = "GeoJSON: a FeatureCollection"
_SHAPES: Mapping[str, tuple[Shape, int, bool]] = {
    "Point": ("point", 0, False),
    "MultiPoint": ("point", 0, True),
    "LineString": ("line", 1, False),
    "MultiLineString": ("line", 1, True),
    "Polygon": ("area", 2, False),
    "MultiPolygon": ("area", 2, True),
}
"""By type: the shape, how deep the lists of positions are, and whether there are several."""
_LEAST = {"point": 1, "line": 2, "area": 4}
_SELDOM_DEEPER = 8
_BOX = passed_over("says where the geometry is, which does so itself", minor=True)
_IN_METRES = passed_over("is not that of a route graph, which stands in the frame of the map, in metres", minor=True)
_TOLD: Mapping[Shape, str] = {"point": "a point", "line": "a line", "area": "an area"}


def read_geojson_layers(path: Path) -> Sequence[Layer]:
    """The features of a file as one layer.

    Raises
    ------
    MissionError
        with the line at which it is no GeoJSON.
    MissingExtraError
        if it has another coordinate system, and pyproj is not installed.
    """
    file = str(path)
    text = decoded(read_bytes(path), file)
    require_moderate_json(text, file)
    try:
        data = parse_tracked(text)
    except json.JSONDecodeError as error:
        raise refused(file, error.lineno, "", error.msg, _WHAT) from None
    except (RecursionError, ValueError) as error:
        raise refused(file, None, "", str(error) or "nested too deep", _WHAT) from None
    return [_Reading(file, text, data).layer(data)]


class _Document:
    """The members of a file; the properties of a feature have the fates of its values."""

    def __init__(self, root: object) -> None:
        self._root = root
        self._features: dict[int, Source] = {}
        self._properties: dict[int, Source] = {}

    def add(self, item: Tracked, properties: object, source: Source) -> None:
        """Say of which feature of the site a feature of the file is the source."""
        self._features[id(item)] = source
        if isinstance(properties, Tracked):
            self._properties[id(properties)] = source

    def enter(self, book: LedgerBook) -> None:
        """Give the ledger every member."""
        enter_json(book, self._root, self._fate)

    def _fate(self, item: Tracked, key: str) -> Fate | None:
        if (source := self._properties.get(id(item))) is not None:
            return source.fate(key, item.peek(key))
        source = self._features.get(id(item))
        if key == "bbox" and (source is None or source.whole is None):
            return _BOX
        if source is None:
            return None
        return source.whole or (source.fate(key, item.peek(key)) if key == "id" and key not in item.fates else None)


class _Reading:
    def __init__(self, file: str, text: str, root: object) -> None:
        self._file = file
        self._document = _Document(root)
        self._places = JsonPlaces(text, file)
        self._transform: Callable[[Coordinate], Coordinate] | None = None

    def layer(self, data: Any) -> Layer:
        kind = data.get("type") if isinstance(data, dict) else None
        if kind not in ("FeatureCollection", "Feature", "GeometryCollection", *_SHAPES):
            told = data if kind is None else kind
            raise self._refused((), "type" if isinstance(data, dict) else "", told, _WHAT)
        items = data.peek("features")
        if isinstance(items, list) and any(map(is_edge, items)):
            return self._graph(data)
        if data.get("crs") is not None:
            self._transform = to_wgs84(_crs(data["crs"]), self._file, "crs")
        name = data.get("name")
        title = name if isinstance(name, str) and kind == "FeatureCollection" else ""
        if kind != "FeatureCollection":
            given = [("type", "Feature"), ("geometry", data), ("properties", None)]
            feature = data if kind == "Feature" else Tracked(given)
            found = list(self._features(feature, (), () if kind != "Feature" else ("geometry",)))
            return layer_of(self._file, "", found, self._document)
        items = data.get("features")
        if not isinstance(items, list):
            raise self._refused(("features",), "features", items, "a list of features")
        found = [
            feature
            for k, item in enumerate(items)
            for feature in self._features(item, ("features", k), ("features", k, "geometry"))
        ]
        return layer_of(self._file, title, found, self._document)

    def _graph(self, data: Tracked) -> Layer:
        """The edges of a route graph, which stands in the frame of the map."""
        data.say(_IN_METRES, "crs")
        name = data.get("name")
        graph = RouteGraph(self._file, lambda k: self._line(("features", k)), self._document.add)
        edges = list(graph.features(data.get("features")))
        return layer_of(self._file, name if isinstance(name, str) else "", edges, self._document)

    def _features(self, item: Any, at: Where, geometry_at: Where) -> Iterator[Feature]:
        where = f"features[{at[1]}]" if at else ""
        if not isinstance(item, Tracked) or item.get("type") != "Feature":
            told = item.get("type") if isinstance(item, dict) else item
            raise self._refused(at, where, told, 'a mapping of type "Feature"')
        properties = item.get("properties")
        if properties is not None and not isinstance(properties, dict):
            raise self._refused((*at, "properties"), f"{where}.properties", properties, "a mapping, or null")
        values = {str(key): value for key, value in (properties or {}).items() if value not in (None, "")}
        number = item.peek("id")
        if isinstance(number, str | int) and not isinstance(number, bool):
            if "id" in values:
                item.say(passed_over("stands beside an id among the properties"), "id")
            values.setdefault("id", number)
        source = Source()
        self._document.add(item, properties, source)
        given, inside = item.get("geometry"), f"{where}.geometry".lstrip(".")
        found: list[Geometry | None] = []
        found += [] if given is None else self._geometries(given, geometry_at, inside)
        for geometry in found or [None]:
            yield Feature(values, self._file, self._line(at), with_name(where, values), geometry, source)

    def _geometries(self, data: Any, at: Where, where: str) -> Iterator[Geometry]:
        kind = data.get("type") if isinstance(data, dict) else None
        if kind == "GeometryCollection":
            parts = data.get("geometries")
            if not isinstance(parts, list) or len(at) > _SELDOM_DEEPER:
                raise self._refused(at, f"{where}.geometries", parts, "a list of geometries, not nested deep")
            for k, part in enumerate(parts):
                yield from self._geometries(part, (*at, "geometries", k), f"{where}.geometries[{k}]")
            return
        if not isinstance(kind, str) or kind not in _SHAPES:
            raise self._refused(at, f"{where}.type", kind if isinstance(data, dict) else data, ", ".join(_SHAPES))
        shape, depth, several = _SHAPES[kind]
        at, where = (*at, "coordinates"), f"{where}.coordinates"
        given = data.get("coordinates")
        items = self._list(given, at, where) if several else [given]
        pieces = []
        for k, piece in enumerate(items):
            own_at, own_where = ((*at, k), f"{where}[{k}]") if several else (at, where)
            pieces.append(self._piece(piece, shape, depth, own_at, own_where))
        if shape != "point" and any(
            len(place) > 2 and place[2] for piece in pieces for ring in piece for place in ring
        ):
            data.say(read_as(f"places of {_TOLD[shape]}, without their heights"), "coordinates")
        if pieces:
            yield Geometry(shape, tuple(pieces))

    def _piece(self, data: Any, shape: Shape, depth: int, at: Where, where: str) -> tuple[Ring, ...]:
        if depth == 0:
            return ((self._coordinate(data, at, where),),)
        if depth == 1:
            return (self._ring(data, shape, at, where),)
        rings = self._list(data, at, where)
        if not rings:
            raise self._refused(at, where, data, "a ring of corners, then its holes")
        return tuple(self._ring(ring, shape, (*at, k), f"{where}[{k}]") for k, ring in enumerate(rings))

    def _ring(self, data: Any, shape: Shape, at: Where, where: str) -> Ring:
        ring = self._list(data, at, where)
        if len(ring) < _LEAST[shape]:
            closed = ", the last as the first" if shape == "area" else ""
            raise self._refused(at, where, data, f"at least {_LEAST[shape]} positions{closed}")
        return tuple(self._coordinate(item, (*at, k), f"{where}[{k}]") for k, item in enumerate(ring))

    def _coordinate(self, data: Any, at: Where, where: str) -> Coordinate:
        numbers = data[:3] if isinstance(data, list) else []
        if len(numbers) < 2 or not all(map(_is_number, numbers)):
            raise self._refused(at, where, data, "[longitude, latitude], perhaps with a height")
        found = tuple(map(float, numbers))
        if self._transform is not None:
            return self._transform(found)
        if abs(found[1]) > 90 or abs(found[0]) > 360:
            raise self._refused(at, where, data, "[longitude, latitude] in degrees, longitude first")
        return found

    def _list(self, data: Any, at: Where, where: str) -> list[Any]:
        if not isinstance(data, list):
            raise self._refused(at, where, data, "a list of positions")
        return data

    def _line(self, at: Where) -> int | None:
        for length in range(len(at), -1, -1):
            if at[:length] in self._places:
                return self._places[at[:length]][1]
        return None

    def _refused(self, at: Where, where: str, value: object, expected: str) -> Exception:
        return refused(self._file, self._line(at), where, "missing" if value is None else value, expected)


def _is_number(value: object) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and abs(value) < 1e12 and math.isfinite(value)


def _crs(given: Any) -> str:
    """The name of a coordinate system, as old GeoJSON has it."""
    named = given.get("properties") if isinstance(given, dict) else None
    name = named.get("name") if isinstance(named, dict) else None
    return name if isinstance(name, str) else "?"
