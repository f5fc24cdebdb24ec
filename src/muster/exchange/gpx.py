"""A plan as GPX 1.1 (topografix.com/GPX/1/1): a way point for each place, then a route for each robot that has tasks.

The order of elements is that of the schema. `ele` is metres above the ellipsoid, in 3-D missions alone.
"""

from __future__ import annotations

from xml.etree import ElementTree as Tree

from muster.exchange.earth import Spot
from muster.exchange.geographic_features import Feature, Survey
from muster.exchange.xml_text import add, decimal, text_of

_NAMESPACE = "http://www.topografix.com/GPX/1/1"


def gpx_text(survey: Survey) -> str:
    """A GPX document."""
    root = Tree.Element("gpx", {"version": "1.1", "creator": "Muster", "xmlns": _NAMESPACE})
    add(add(root, "metadata"), "name", survey.mission)
    for feature in (*survey.robots, *survey.tasks):
        point = _point(root, "wpt", feature.spots[0], feature)
        add(point, "name", feature.name)
        add(point, "desc", _told(feature))
        add(point, "type", feature.kind)
    for number, feature in enumerate(survey.routes, 1):
        route = add(root, "rte")
        add(route, "name", feature.name)
        add(route, "desc", f"tasks {' '.join(feature.properties['tasks'])}")
        add(route, "number", number)
        for spot in feature.spots:
            _point(route, "rtept", spot, feature)
    return text_of(root)


def _point(parent: Tree.Element, tag: str, spot: Spot, feature: Feature) -> Tree.Element:
    """A point; longitudes of GPX lie in [-180, 180)."""
    lon = -180.0 if spot.lon >= 180 else spot.lon
    point = add(parent, tag, lat=decimal(spot.lat), lon=decimal(lon))
    if feature.heights_m is not None:
        add(point, "ele", spot.alt)
    return point


def _told(feature: Feature) -> str:
    """The description of a place."""
    own = feature.properties
    if feature.kind == "robot":
        return f"start of robot {feature.name}"
    if own["robot"] is None:
        return "left out"
    return f"robot {own['robot']}, number {own['order']}, from {own['starts_s']:.1f} s to {own['ends_s']:.1f} s"
