"""The fence of a simulated autopilot: what it says of it, and whether the drone is outside. Geometry of its own.

The drone must be inside all inclusions and outside all exclusions; a polygon is judged as PX4 and ArduPilot judge it,
by how often a line from the place crosses its edges.
"""

from __future__ import annotations

import math
import struct
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import Literal

from muster.mission.model import Origin
from muster.motion.port import Place
from muster_robots.mavlink.autopilots import PX4, Autopilot
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.simulated.earth import degrees_of

Said = tuple[str, tuple[object, ...]]
"""A message by its name in lower case, and its fields."""

HOLDS, RETURNS, LANDS = 2, 3, 5
"""Values of PX4's GF_ACTION."""
_FENCE, _RELATIVE = mavlink.MAV_MISSION_TYPE_FENCE, mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT


@dataclass(frozen=True)
class Area:
    """A polygon or a circle of a fence.

    Parameters
    ----------
    is_inclusion : bool
        Whether the drone must be inside.
    corners : tuple of (float, float)
        Metres east and north of home; of a circle its centre alone.
    radius_m : float
        Of a circle; 0 of a polygon.
    """

    is_inclusion: bool
    corners: tuple[tuple[float, float], ...]
    radius_m: float = 0.0

    @property
    def command(self) -> int:
        """The command of its items."""
        polygon, circle = mavlink.MAV_CMD_NAV_FENCE_POLYGON_VERTEX_INCLUSION, mavlink.MAV_CMD_NAV_FENCE_CIRCLE_INCLUSION
        return int((circle if self.radius_m > 0 else polygon) + (not self.is_inclusion))  # exclusions are the next ones

    def holds(self, east: float, north: float) -> bool:
        """Return whether a place is in it."""
        if self.radius_m > 0:
            return math.dist(self.corners[0], (east, north)) < self.radius_m
        crossed = 0
        for (x1, y1), (x2, y2) in pairwise([*self.corners, self.corners[0]]):
            if (y1 > north) != (y2 > north):
                crossed += east < (x2 - x1) * (north - y1) / (y2 - y1) + x1
        return crossed % 2 == 1


@dataclass(frozen=True)
class Geofence:
    """The fence of one drone.

    Parameters
    ----------
    areas : tuple of Area
        Polygons and circles.
    return_point : bool
        Whether its first item is a return point.
    is_on : bool
        FENCE_ENABLE of ArduPilot, whether GF_ACTION of PX4 is above 0.
    action : int
        GF_ACTION of PX4: `HOLDS`, `RETURNS`, `LANDS`; ArduPilot returns.
    types, options : int
        FENCE_TYPE and FENCE_OPTIONS of ArduPilot.
    answers : str
        Whether it is told on request, or the autopilot does not know fences, or does not answer.
    untold : int or None
        Index of an item that is never told.
    denied : int
        So many requests for it are denied first, as while another station sends one.
    begins_s : float
        Seconds after the first arming at which another station has sent it; until then there is none.
    """

    areas: tuple[Area, ...] = ()
    return_point: bool = False
    is_on: bool = True
    action: int = HOLDS
    types: int = 7
    options: int = 0
    answers: Literal["yes", "unsupported", "silent"] = "yes"
    untold: int | None = None
    denied: int = 0
    begins_s: float = 0.0

    def is_left_at(self, ned: Place, armed_for_s: float) -> bool:
        """Return whether a place, north, east and down of home, is outside."""
        north, east, _ = ned
        there = self.areas if armed_for_s >= self.begins_s else ()
        return any(area.holds(east, north) != area.is_inclusion for area in there)

    def parameters(self, kind: Autopilot) -> dict[str, tuple[float, int]]:
        """Return the values of its parameters as they are sent, and their types."""
        if kind is PX4:
            action = struct.unpack("<f", struct.pack("<i", self.action * self.is_on))[0]
            return {"GF_ACTION": (action, mavlink.MAV_PARAM_TYPE_INT32)}
        values = {"FENCE_ENABLE": self.is_on, "FENCE_TYPE": self.types, "FENCE_OPTIONS": self.options}
        return {name: (float(value), mavlink.MAV_PARAM_TYPE_INT8) for name, value in values.items()}

    def reply(self, message: Message, home: Origin, asked_before: int) -> Iterator[Said]:
        """Yield what is said to MISSION_REQUEST_LIST and MISSION_REQUEST_INT, the `asked_before`th request of it."""
        to = message.get_srcSystem(), message.get_srcComponent()
        if message.mission_type != _FENCE or self.answers == "silent":
            return
        items = self._items(home) if self.begins_s == 0.0 else []
        if self.answers == "unsupported" or asked_before < self.denied:
            refusals = (mavlink.MAV_MISSION_UNSUPPORTED, mavlink.MAV_MISSION_DENIED)
            yield "mission_ack", (*to, refusals[self.answers == "yes"], _FENCE)
        elif message.get_type() == "MISSION_REQUEST_LIST":
            yield "mission_count", (*to, len(items), _FENCE)
        elif message.seq != self.untold:
            command, param, lat, lon = items[message.seq]
            head = (*to, message.seq, _RELATIVE, command, 0, 1)
            yield "mission_item_int", (*head, param, 0.0, 0.0, 0.0, round(lat * 1e7), round(lon * 1e7), 0.0, _FENCE)

    def _items(self, home: Origin) -> list[tuple[int, float, float, float]]:
        """Return of each item the command, its first parameter, and degrees."""
        told = [(mavlink.MAV_CMD_NAV_FENCE_RETURN_POINT, 0.0, home.lat_deg, home.lon_deg)] * self.return_point
        for area in self.areas:
            for east, north in area.corners:
                degrees = degrees_of(home, (north, east, 0.0))
                told.append((area.command, area.radius_m or float(len(area.corners)), *degrees))
        return told
