"""The limits that an autopilot sets where its drone may fly, read before the first order: parameters, and its fence.

Most are numbers with a fraction to PX4, which sends the bytes of a whole number in place of one; ArduPilot sends whole
numbers as such. PX4 refuses missions outside its polygons whatever GF_ACTION is; by way points one by one it acts.
[PX4: GF_MAX_HOR_DIST, GF_MAX_VER_DIST, MIS_DIST_1WP, GF_ACTION; mission_feasibility_checker.cpp; ArduCopter:
FENCE_ENABLE, FENCE_AUTOENABLE, FENCE_TYPE, FENCE_RADIUS, FENCE_ALT_MAX, FENCE_OPTIONS]
"""

from __future__ import annotations

import math
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field

from muster.motion.port import Place
from muster_robots.mavlink.autopilots import ARDUPILOT, PX4, Autopilot
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.own_fence import FenceUnreadError, OwnFence, ToMap, fence_of, read_fence
from muster_robots.mavlink.requests import Request, Script

_PX4 = ("GF_MAX_HOR_DIST", "GF_MAX_VER_DIST", "MIS_DIST_1WP", "GF_ACTION")
_ARDUPILOT = ("FENCE_ENABLE", "FENCE_TYPE", "FENCE_RADIUS", "FENCE_ALT_MAX", "FENCE_AUTOENABLE", "FENCE_OPTIONS")
_HEIGHT, _CIRCLE, _POLYGON = 1, 2, 4
"""Bits of FENCE_TYPE; polygons are polygons and circles anywhere, the circle is the one around home."""
_UNION = 2
"""Bit of FENCE_OPTIONS: the drone must be inside one of the inclusions, not inside all."""
_ASKED = 4
"""So often a parameter is asked for until it counts as one that the version does not have."""


@dataclass(frozen=True)
class Limit:
    """A greatest distance from home, or height above it, in metres, by the name of its parameter."""

    name: str
    most_m: float
    is_height: bool = False
    first_alone: bool = False

    def refusal(self, home: Place, places: Sequence[Place]) -> str:
        """Return why places in the map frame, in the order of flight, are outside; empty if they are not."""
        for place in places[:1] if self.first_alone else places:
            metres = place[2] - home[2] if self.is_height else math.dist(place[:2], home[:2])
            if metres > self.most_m:
                what = "above home" if self.is_height else "from home"
                return f"{metres:.0f} m {what}; expected at most {self.most_m:g} m by the autopilot's {self.name}"
        return ""


@dataclass
class OwnLimits:
    """Working state: what one autopilot has told of its limits.

    Parameters
    ----------
    parameters : dict of str to float
        By name those that it has.
    fence : OwnFence
        Its polygons and circles, if its fence is on.
    note : str
        Why it has none, where it does not know them or does not answer; empty else.
    unread : str
        Why its fence was not read to its end although it is on; empty else. Nothing may be flown then.
    is_read : bool
        Whether all was asked for.
    """

    parameters: dict[str, float] = field(default_factory=dict)
    fence: OwnFence = field(default_factory=OwnFence)
    note: str = ""
    unread: str = ""
    is_read: bool = False

    def refusal(
        self, autopilot: Autopilot | None, home: Place, places: Sequence[Place], here: Place | None = None
    ) -> str:
        """Return why places, in the order of flight, or legs to them are outside the limits; empty if they are not.

        Parameters
        ----------
        autopilot : Autopilot or None
            None before its first heartbeat.
        home, places : Place, sequence of Place
            In the map frame.
        here : Place, optional
            Where the first leg begins; by default that leg is not looked at.
        """
        if self.unread:
            return self.unread
        limits = () if autopilot is None else limits_of(autopilot, self.parameters)
        reasons = (limit.refusal(home, places) for limit in limits)
        return next(filter(None, reasons), "") or self.fence.refusal(places, here)


def limits_of(autopilot: Autopilot, values: Mapping[str, float]) -> tuple[Limit, ...]:
    """Return the limits by the parameters that were read; a parameter of 0 limits nothing."""
    if autopilot is ARDUPILOT:
        is_enabled = values.get("FENCE_ENABLE") or values.get("FENCE_AUTOENABLE")
        kinds = int(values.get("FENCE_TYPE", 0)) if is_enabled else 0
        far = values.get("FENCE_RADIUS", 0.0) if kinds & _CIRCLE else 0.0
        high = values.get("FENCE_ALT_MAX", 0.0) if kinds & _HEIGHT else 0.0
        found = [Limit("FENCE_RADIUS", far), Limit("FENCE_ALT_MAX", high, is_height=True)]
    else:
        horizontal, vertical, first = (values.get(name, 0.0) for name in _PX4[:3])
        found = [Limit(_PX4[0], horizontal), Limit(_PX4[1], vertical, is_height=True)]
        found.append(Limit(_PX4[2], first, first_alone=True))
    return tuple(limit for limit in found if limit.most_m > 0)


def has_fence_on(autopilot: Autopilot, values: Mapping[str, float], *, offboard: bool) -> bool | None:
    """Return whether the fence of polygons and circles is on by the parameters; None where these do not say.

    Parameters
    ----------
    offboard : bool
        Whether way points are sent one by one, without a mission that PX4 would refuse.
    """
    if autopilot is ARDUPILOT:
        enabled, kinds = values.get("FENCE_ENABLE"), values.get("FENCE_TYPE")
        if enabled == 0 and not values.get("FENCE_AUTOENABLE"):
            return False
        if kinds is not None and not int(kinds) & _POLYGON:
            return False
        return None if enabled is None or kinds is None else True
    action = values.get("GF_ACTION")
    if action == 0:
        return False if offboard else None
    return None if action is None else True


def read_limits(
    target: Message, autopilot: Autopilot, into: OwnLimits, to_map: ToMap | None, *, offboard: bool
) -> Script:
    """Ask for the parameters that limit where a drone may fly, and for its fence unless that is off.

    Parameters
    ----------
    target : Message
        Any message of the autopilot.
    into : OwnLimits
        Takes what is told.
    to_map : callable or None
        Degrees in the map frame; None in a mission without an origin.
    offboard : bool
        As `has_fence_on`.
    """
    yield from _read_parameters(target, autopilot, into.parameters)
    is_on = has_fence_on(autopilot, into.parameters, offboard=offboard)
    if is_on is not False:
        items: list[Message] = []
        is_union = autopilot is ARDUPILOT and bool(int(into.parameters.get("FENCE_OPTIONS", 0)) & _UNION)
        try:
            into.note = yield from read_fence(target, items)
            into.fence = fence_of(items, to_map, is_union=is_union)
            if into.note and is_on and "UNSUPPORTED" not in into.note:
                raise FenceUnreadError(into.note)
        except FenceUnreadError as error:
            into.unread = f"the fence of its autopilot is on and was not read to its end: {error}"
    into.is_read = True


def _read_parameters(target: Message, autopilot: Autopilot, into: dict[str, float]) -> Script:
    """PARAM_REQUEST_READ of each that was not answered, until all were, or asked for several times."""
    names = _ARDUPILOT if autopilot is ARDUPILOT else _PX4
    to = target.get_srcSystem(), target.get_srcComponent()

    def answer(message: Message) -> Message | None:
        if message.get_type() == "PARAM_VALUE" and message.param_id in names:
            value = _value_of(message, autopilot)
            if math.isfinite(value):
                into[message.param_id] = value
        return message if len(into) == len(names) else None

    for _ in range(_ASKED):
        missing = [name for name in names if name not in into]
        asked = [mavlink.MAVLink_param_request_read_message(*to, name.encode(), -1) for name in missing]
        if missing:
            yield Request(asked, answer, "PARAM_REQUEST_READ", within_s=1.0, tries=1, may_fail=True)


def _value_of(message: Message, autopilot: Autopilot) -> float:
    """Return the value of a parameter; PX4 sends the four bytes of a whole number in place of those of a fraction."""
    if autopilot is PX4 and message.param_type == mavlink.MAV_PARAM_TYPE_INT32:
        return float(struct.unpack("<i", struct.pack("<f", message.param_value))[0])
    return float(message.param_value)
