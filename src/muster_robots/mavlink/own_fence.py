"""The polygons and circles of an autopilot's own fence: how they are read, and which places and legs they refuse.

A fence has no heights. Where an autopilot is in doubt, the stricter reading counts: all inclusions hold together, as
in PX4 and, unless FENCE_OPTIONS says otherwise, ArduPilot; the edge of an area is neither inside nor outside.
[mavlink.io: mission protocol; PX4: navigator/geofence.cpp; ArduPilot: AC_Fence/AC_PolyFence_loader.cpp]
"""

from __future__ import annotations

import math
from collections.abc import Callable, Generator, Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

from muster.mission.system.extras import needs_extra
from muster.motion.port import Place
from muster_robots.mavlink.dialect import Message, mavlink, name_of
from muster_robots.mavlink.requests import Request, pause

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

ToMap = Callable[[int, int, float], Place]
"""Degrees times 1e7 and metres above home in the map frame."""

_FENCE = mavlink.MAV_MISSION_TYPE_FENCE
_POLYGONS = {mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_EXCLUSION}
_CIRCLES = {mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_EXCLUSION}
_INCLUSIONS = {mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION}
_GLOBAL_FRAMES = {
    mavlink.MAV_FRAME_GLOBAL,
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT,
    mavlink.MAV_FRAME_GLOBAL_INT,
    mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT,
}
_LEAST_CORNERS, _LEAST_M2 = 3, 0.1
_QUARTER = 64
"""Segments of a quarter of a circle: the polygon and the circle differ by at most 1e-4 of the radius."""
_BEGINS = 4
"""So often reading begins anew where the autopilot breaks it off, as while another station sends it a fence."""


class FenceUnreadError(Exception):
    """A fence was not read to its end, or an item of it is not understood; never leaves the bridge."""


@dataclass(frozen=True)
class FenceArea:
    """One polygon or circle of a fence, in the map frame.

    Parameters
    ----------
    name : str
        What it is called in messages: `exclusion circle 2`, by the number of the area in the fence.
    is_inclusion : bool
        Whether the drone must stay inside; else it must stay outside.
    shape : BaseGeometry
        Its area, x east and y north, metres.
    """

    name: str
    is_inclusion: bool
    shape: BaseGeometry

    def allows(self, line: BaseGeometry) -> bool:
        """Return whether a leg or a place keeps to it."""
        return bool(self.shape.contains_properly(line) if self.is_inclusion else self.shape.disjoint(line))


@dataclass(frozen=True)
class OwnFence:
    """The areas of a fence, all of which count.

    Parameters
    ----------
    areas : tuple of FenceArea
        In the order of the fence; none where the autopilot has no fence.
    """

    areas: tuple[FenceArea, ...] = ()

    def refusal(self, places: Sequence[Place], here: Place | None = None) -> str:
        """Return why straight legs through places in the map frame are refused; empty if they are not.

        Parameters
        ----------
        places : sequence of Place
            In the order of flight.
        here : Place, optional
            Where the first leg begins; by default it is not looked at.
        """
        for place in places:
            if area := self._area_against([place]):
                side = "inside" if area.is_inclusion else "outside"
                return f"{_at(place)}; expected a place {side} {area.name} of the autopilot's fence"
        for leg in pairwise([*([] if here is None else [here]), *places]):
            if area := self._area_against(leg):
                side = "inside" if area.is_inclusion else "outside"
                way = f"straight from {_at(leg[0])} to {_at(leg[1])}"
                return f"{way}; expected a way {side} {area.name} of the autopilot's fence"
        return ""

    def _area_against(self, places: Sequence[Place]) -> FenceArea | None:
        import shapely

        points = list(dict.fromkeys(place[:2] for place in places))
        line = shapely.Point(points[0]) if len(points) == 1 else shapely.LineString(points)
        return next((area for area in self.areas if not area.allows(line)), None)


def _at(place: Place) -> str:
    return f"({', '.join(f'{round(c, 2) + 0.0:.2f}' for c in place[:2])})"  # no -0.00


def fence_of(items: Sequence[Message], to_map: ToMap | None, *, is_union: bool = False) -> OwnFence:
    """Return the fence that items describe (MISSION_ITEM_INT, all of them, in order).

    Parameters
    ----------
    items : sequence of Message
        Polygons as consecutive vertices with their number in `param1`, circles with their radius in `param1`.
    to_map : callable or None
        Degrees in the map frame; None in a mission without an origin, which cannot have an autopilot's fence.
    is_union : bool
        Whether the drone must be inside one of the inclusions; by default it must be inside all.

    Raises
    ------
    FenceUnreadError
        for an item that is not understood: it may close a place.
    """
    if items and to_map is None:
        raise FenceUnreadError("the mission has no origin_wgs84, by which its degrees are places of the mission")
    with needs_extra("mavlink", "the fence of an autopilot"):
        import shapely
    areas: list[FenceArea] = []
    for first, group in _groups(items):
        assert to_map is not None
        corners = [to_map(item.x, item.y, 0.0)[:2] for item in group]
        is_circle = first.command in _CIRCLES
        shape = _circle(first, corners[0]) if is_circle else shapely.make_valid(shapely.Polygon(corners))
        if shape.area < _LEAST_M2:
            raise FenceUnreadError(f"item {first.seq}: an area of nothing")
        is_inclusion = first.command in _INCLUSIONS
        name = f"{'inclusion' if is_inclusion else 'exclusion'} {'circle' if is_circle else 'polygon'} {len(areas) + 1}"
        areas.append(FenceArea(name, is_inclusion, shape))
    inclusions = [area for area in areas if area.is_inclusion]
    if is_union and len(inclusions) > 1:
        together = FenceArea("one of the inclusions", True, shapely.union_all([area.shape for area in inclusions]))
        areas = [together, *(area for area in areas if not area.is_inclusion)]
    return OwnFence(tuple(areas))


def _groups(items: Sequence[Message]) -> Iterator[tuple[Message, Sequence[Message]]]:
    """Yield the items of each area, with the first of them apart; return points limit nothing."""
    k = 0
    while k < len(items):
        item = items[k]
        count = 1
        if item.command in _POLYGONS:
            count = round(item.param1) if math.isfinite(item.param1) else 0
        elif item.command not in _CIRCLES and item.command != mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT:
            raise FenceUnreadError(f"item {k}: {name_of('MAV_CMD', item.command)}")
        group = items[k : k + count]
        if item.command in _POLYGONS and count < _LEAST_CORNERS:
            raise FenceUnreadError(f"item {k}: a polygon of {item.param1:g} corners")
        if len(group) < count or any((one.command, one.param1) != (item.command, item.param1) for one in group):
            raise FenceUnreadError(f"item {k}: a polygon of {count} corners, of which some are missing")
        if any(one.frame not in _GLOBAL_FRAMES for one in group):
            raise FenceUnreadError(f"item {k}: {name_of('MAV_FRAME', item.frame)}")
        if item.command != mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT:
            yield item, group
        k += count


def _circle(item: Message, center: Sequence[float]) -> BaseGeometry:
    """Return a polygon within a circle that is an inclusion, around one that is an exclusion."""
    import shapely

    radius = item.param1
    if not math.isfinite(radius) or radius <= 0:
        raise FenceUnreadError(f"item {item.seq}: a circle of {radius:g} m")
    grown = 1.0 if item.command in _INCLUSIONS else 1.0 / math.cos(math.pi / (4 * _QUARTER))
    return shapely.Point(center).buffer(radius * grown, quad_segs=_QUARTER)


def read_fence(target: Message, into: list[Message]) -> Generator[Request, Any, str]:
    """Download the items of a fence: MISSION_REQUEST_LIST, MISSION_REQUEST_INT each, MISSION_ACK; each until answered.

    The script returns why the autopilot has no fence of the kind, in words; empty if it has told all items.

    Parameters
    ----------
    target : Message
        Any message of the autopilot.
    into : list of Message
        Is filled with the items.

    Raises
    ------
    FenceUnreadError
        if the autopilot has told that there are items, and not all of these.
    """
    to = target.get_srcSystem(), target.get_srcComponent()
    why = ""
    for _ in range(_BEGINS):
        asked = [mavlink.MAVLink_mission_request_list_message(*to, _FENCE)]
        said = yield Request(asked, _answer("MISSION_COUNT"), "MISSION_REQUEST_LIST", may_fail=True)
        if said is None:
            return "it does not answer MISSION_REQUEST_LIST of a fence"
        if said.get_type() == "MISSION_ACK":
            why = name_of("MAV_MISSION_RESULT", said.type)
            if said.type == mavlink.MAV_MISSION_UNSUPPORTED:
                return f"it answers {why}"
        else:
            into.clear()
            why = yield from _read_items(to, said.count, into)
            if not why:
                yield _said(mavlink.MAVLink_mission_ack_message(*to, mavlink.MAV_MISSION_ACCEPTED, _FENCE))
                return ""
        yield pause(1.0)
    raise FenceUnreadError(why)


def _read_items(to: tuple[int, int], count: int, into: list[Message]) -> Generator[Request, Any, str]:
    """Download so many items; the script returns why one of them was not told, in words, or nothing."""
    for seq in range(count):
        asked = [mavlink.MAVLink_mission_request_int_message(*to, seq, _FENCE)]
        said = yield Request(asked, _answer("MISSION_ITEM_INT", seq), "MISSION_REQUEST_INT", may_fail=True)
        if said is None:
            raise FenceUnreadError(f"item {seq} of {count} was not told")
        if said.get_type() == "MISSION_ACK":
            return f"item {seq} of {count}: {name_of('MAV_MISSION_RESULT', said.type)}"
        into.append(said)
    return ""


def _answer(name: str, seq: int | None = None) -> Callable[[Message], Message | None]:
    """Return what finds a message about the fence by its name, or an acknowledgement that refuses one."""

    def answer(message: Message) -> Message | None:
        kind = message.get_type()
        if getattr(message, "mission_type", None) != _FENCE:
            return None
        if kind == "MISSION_ACK":
            return None if message.type == mavlink.MAV_MISSION_ACCEPTED else message
        return message if kind == name and seq in (None, getattr(message, "seq", None)) else None

    return answer


def _said(message: Message) -> Request:
    """Return a request that is said once and needs no answer."""
    return Request([message], lambda _: None, "", 0.0, 1, may_fail=True)
