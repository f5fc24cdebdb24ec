"""A plan as GPX 1.1 (topografix.com/GPX/1/1): a way point for each place, then a route for each robot that has tasks.

The order of elements is that of the schema. `ele` is metres above the ellipsoid, in 3-D missions alone. `time` is in
UTC, as the standard asks: when work at a task starts, and when a robot arrives at a point of its route. There is none
where the mission does not start at a time in a zone.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any
from xml.etree import ElementTree as Tree

from muster_files.earth import Spot
from muster_files.geographic_features import Feature, PlanFeatures
from muster_files.xml_text import add, decimal, text_of, time_text

_NAMESPACE = "http://www.topografix.com/GPX/1/1"
_OWN_NAMESPACE = "urn:muster:1"
_OF_STATIONS = ("services", "slots", "charge_per_s", "swap_s")
"""What stations have in `extensions`, so that a file that is read again has them."""


def gpx_text(plan: PlanFeatures) -> str:
    """A GPX document."""
    root = Tree.Element("gpx", {"version": "1.1", "creator": "Muster", "xmlns": _NAMESPACE})
    if plan.stations:
        root.set("xmlns:muster", _OWN_NAMESPACE)
    add(add(root, "metadata"), "name", plan.mission)
    for feature in (*plan.robots, *plan.tasks, *plan.stations):
        point = _point(root, "wpt", feature.spots[0], feature)
        add(point, "name", feature.name)
        add(point, "desc", _told(feature))
        add(point, "type", feature.kind)
        if feature.kind == "station":
            _add_own(point, feature.properties)
    for number, feature in enumerate(plan.routes, 1):
        route = add(root, "rte")
        add(route, "name", feature.name)
        add(route, "desc", f"tasks {' '.join(feature.properties.get('stops') or feature.properties['tasks'])}")
        add(route, "number", number)
        for k, spot in enumerate(feature.spots):
            _point(route, "rtept", spot, feature, k)
    return text_of(root)


def _point(parent: Tree.Element, tag: str, spot: Spot, feature: Feature, k: int = 0) -> Tree.Element:
    """The k-th point of a feature; longitudes of GPX lie in [-180, 180)."""
    lon = -180.0 if spot.lon >= 180 else spot.lon
    point = add(parent, tag, lat=decimal(spot.lat), lon=decimal(lon))
    if feature.heights_m is not None:
        add(point, "ele", spot.alt)
    if feature.times:
        add(point, "time", time_text(feature.times[k]))
    return point


def _add_own(point: Tree.Element, properties: Mapping[str, Any]) -> None:
    extensions = add(point, "extensions")
    for name in _OF_STATIONS:
        if (value := properties.get(name)) is not None:
            add(extensions, f"muster:{name}", " ".join(value) if isinstance(value, list) else value)


def _told(feature: Feature) -> str:
    """The description of a place."""
    own = feature.properties
    if feature.kind == "robot":
        return f"start of robot {feature.name}"
    if feature.kind == "station":
        return _told_of_station(own)
    if not own["robots"]:
        return "left out"
    members = [f"robot {robot}, number {order}" for robot, order in zip(own["robots"], own["orders"], strict=True)]
    late = f", {own['late_s']:.1f} s late" if own.get("late_s") else ""
    return f"{' and '.join(members)}, from {own['starts_s']:.1f} s to {own['ends_s']:.1f} s{late}"


def _told_of_station(own: Mapping[str, Any]) -> str:
    """The description of a station: what it does, and who comes when."""
    calls = zip(*(own[name] for name in ("robots", "orders", "starts_s", "ends_s")), strict=True)
    told = [f"robot {r}, number {order}, from {starts:.1f} s to {ends:.1f} s" for r, order, starts, ends in calls]
    return "; ".join([f"station, {', '.join(own['services'])}", *told])
