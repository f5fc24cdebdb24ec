"""A plan as KML 2.2 (OGC 07-147r2): longitude first; a folder each of areas, routes, tasks and robots.

Heights are those of the mission, over the ground (`relativeToGround`): KML's own zero is the mean sea level, which a
height above the ellipsoid does not tell. The order of elements is that of the schema.
"""

from __future__ import annotations

from xml.etree import ElementTree as Tree

from muster.exchange.survey import Feature, Survey
from muster.exchange.xml_text import add, decimal, text_of

_NAMESPACE = "http://www.opengis.net/kml/2.2"


def kml_text(survey: Survey) -> str:
    """A KML document."""
    root = Tree.Element("kml", {"xmlns": _NAMESPACE})
    document = add(root, "Document")
    add(document, "name", survey.mission)
    groups = (("areas", survey.areas), ("routes", survey.routes), ("tasks", survey.tasks), ("robots", survey.robots))
    for name, features in groups:
        folder = add(document, "Folder")
        add(folder, "name", name)
        for feature in features:
            _placemark(folder, feature)
    return text_of(root)


def _placemark(folder: Tree.Element, feature: Feature) -> None:
    mark = add(folder, "Placemark")
    add(mark, "name", feature.name)
    data = add(mark, "ExtendedData")
    for name, value in feature.properties.items():
        if name != "name" and value is not None:
            told = " ".join(value) if isinstance(value, list) else value
            add(add(data, "Data", name=name), "value", told)
    if feature.kind in ("boundary", "zone"):
        ring = add(add(add(mark, "Polygon"), "outerBoundaryIs"), "LinearRing")
        add(ring, "coordinates", _coordinates(feature, [0.0] * len(feature.spots), closed=True))
        return
    shape = add(mark, "LineString" if feature.kind == "route" else "Point")
    if feature.heights_m is not None:
        add(shape, "altitudeMode", "relativeToGround")
    elif feature.kind == "route":
        add(shape, "tessellate", 1)
    add(shape, "coordinates", _coordinates(feature, feature.heights_m or [0.0] * len(feature.spots), closed=False))


def _coordinates(feature: Feature, heights: tuple[float, ...] | list[float], *, closed: bool) -> str:
    tuples = [
        f"{decimal(spot.lon)},{decimal(spot.lat)},{decimal(height)}"
        for spot, height in zip(feature.spots, heights, strict=True)
    ]
    return " ".join([*tuples, *(tuples[:1] if closed else ())])
