"""The limits that an autopilot has by its parameters, read before the first order: its fence, its first way point.

All of these are numbers with a fraction to PX4; ArduPilot sends whole numbers as such.
[PX4: GF_MAX_HOR_DIST, GF_MAX_VER_DIST, MIS_DIST_1WP; ArduCopter: FENCE_ENABLE, FENCE_TYPE, FENCE_RADIUS, FENCE_ALT_MAX]
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster.motion.port import Place
from muster_robots.mavlink.autopilots import ARDUPILOT, Autopilot
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.requests import Request, Script

_PX4 = ("GF_MAX_HOR_DIST", "GF_MAX_VER_DIST", "MIS_DIST_1WP")
_ARDUPILOT = ("FENCE_ENABLE", "FENCE_TYPE", "FENCE_RADIUS", "FENCE_ALT_MAX")
_HEIGHT, _CIRCLE = 1, 2
"""Bits of FENCE_TYPE."""


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


def limits_of(autopilot: Autopilot, values: Mapping[str, float]) -> tuple[Limit, ...]:
    """Return the limits by the parameters that were read; a parameter of 0 limits nothing."""
    if autopilot is ARDUPILOT:
        kinds = int(values.get("FENCE_TYPE", 0)) if values.get("FENCE_ENABLE") else 0
        far = values.get("FENCE_RADIUS", 0.0) if kinds & _CIRCLE else 0.0
        high = values.get("FENCE_ALT_MAX", 0.0) if kinds & _HEIGHT else 0.0
        found = [Limit("FENCE_RADIUS", far), Limit("FENCE_ALT_MAX", high, is_height=True)]
    else:
        horizontal, vertical, first = (values.get(name, 0.0) for name in _PX4)
        found = [Limit(_PX4[0], horizontal), Limit(_PX4[1], vertical, is_height=True)]
        found.append(Limit(_PX4[2], first, first_alone=True))
    return tuple(limit for limit in found if limit.most_m > 0)


def refusal_of(autopilot: Autopilot | None, values: Mapping[str, float], home: Place, places: Sequence[Place]) -> str:
    """Return why places, in the order of flight, are outside the limits of an autopilot; empty if they are not."""
    limits = () if autopilot is None else limits_of(autopilot, values)
    return next((why for limit in limits if (why := limit.refusal(home, places))), "")


def read_parameters(target: Message, autopilot: Autopilot, into: dict[str, float]) -> Script:
    """PARAM_REQUEST_READ of each, until all have been answered, or asked for twice: some versions lack some."""
    names = _ARDUPILOT if autopilot is ARDUPILOT else _PX4
    to = target.get_srcSystem(), target.get_srcComponent()

    def answer(message: Message) -> Message | None:
        if message.get_type() == "PARAM_VALUE" and message.param_id in names and math.isfinite(message.param_value):
            into[message.param_id] = float(message.param_value)
        return message if len(into) == len(names) else None

    asked = [mavlink.MAVLink_param_request_read_message(*to, name.encode(), -1) for name in names]
    yield Request(asked, answer, "PARAM_REQUEST_READ", within_s=1.0, tries=2, may_fail=True)
