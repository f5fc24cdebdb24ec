"""A plan as KML 2.2 (OGC 07-147r2): longitude first; a folder each of areas, routes, tasks and robots.

Heights are those of the mission, over the ground (`relativeToGround`): KML's own zero is the mean sea level, which a
height above the ellipsoid does not tell. Lines and areas are cut at the meridian of 180 degrees.
The order of elements is that of the schema. A `TimeSpan` says in UTC when a task or a route starts and ends; there is
none where the mission does not start at a time in a zone.
"""

from __future__ import annotations

import json
import re
from collections.abc import Sequence
from dataclasses import replace
from typing import Any
from xml.etree import ElementTree as Tree

from muster_files.antimeridian import cut_line, cut_ring
from muster_files.earth import Spot
from muster_files.geographic_features import AREAS, Feature, PlanFeatures
from muster_files.xml_text import add, decimal, text_of, time_text

_IN_NAMES = re.compile(r"[\s;,|\[]")
_OF_WORDS = ("requires", "skills")
"""Properties that are read as one where nothing but spaces stands in them."""
_NAMESPACE = "http://www.opengis.net/kml/2.2"


def kml_text(plan: PlanFeatures) -> str:
    """A KML document."""
    root = Tree.Element("kml", {"xmlns": _NAMESPACE})
    document = add(root, "Document")
    add(document, "name", plan.mission)
    parts = ("areas", "routes", "tasks", "stations", "robots")
    groups = [(name, getattr(plan, name)) for name in parts if name != "stations" or plan.stations]
    for name, features in groups:
        folder = add(document, "Folder")
        add(folder, "name", name)
        for feature in features:
            _placemark(folder, feature)
    return text_of(root)


def _placemark(folder: Tree.Element, feature: Feature) -> None:
    mark = add(folder, "Placemark")
    add(mark, "name", feature.name)
    if feature.times:
        span = add(mark, "TimeSpan")
        add(span, "begin", time_text(feature.times[0]))
        add(span, "end", time_text(feature.times[-1]))
    data = add(mark, "ExtendedData")
    for name, value in feature.properties.items():
        if name != "name" and value is not None:
            add(add(data, "Data", name=name), "value", _listed(name, value) if isinstance(value, list) else value)
    heights = (0.0,) * len(feature.spots) if feature.heights_m is None or feature.kind in AREAS else feature.heights_m
    spots = [replace(spot, alt=height) for spot, height in zip(feature.spots, heights, strict=True)]
    if feature.kind in AREAS:
        rings = cut_ring(spots)
        for ring in rings:
            outer = add(add(_parent(mark, rings), "Polygon"), "outerBoundaryIs")
            add(add(outer, "LinearRing"), "coordinates", _coordinates([*ring, ring[0]]))
        return
    lines = cut_line(spots)
    for line in lines:
        shape = add(_parent(mark, lines), "LineString" if feature.kind == "route" else "Point")
        if feature.heights_m is not None:
            add(shape, "altitudeMode", "relativeToGround")
        elif feature.kind == "route":
            add(shape, "tessellate", 1)
        add(shape, "coordinates", _coordinates(line))


def _listed(name: str, items: Sequence[Any]) -> str:
    """Names one after another; as JSON lists of numbers, of skills, and of names with spaces or separators in them."""
    plain = all(isinstance(item, str) and not _IN_NAMES.search(item) for item in items) and name not in _OF_WORDS
    return " ".join(items) if plain else json.dumps(items, ensure_ascii=False)


def _parent(mark: Tree.Element, pieces: Sequence[Sequence[Spot]]) -> Tree.Element:
    """The parent element of a shape: the placemark, or a MultiGeometry in it for several shapes."""
    if len(pieces) == 1:
        return mark
    found = mark.find("MultiGeometry")
    return add(mark, "MultiGeometry") if found is None else found


def _coordinates(spots: Sequence[Spot]) -> str:
    return " ".join(f"{decimal(spot.lon)},{decimal(spot.lat)},{decimal(spot.alt)}" for spot in spots)
