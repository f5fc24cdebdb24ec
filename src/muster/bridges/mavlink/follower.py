"""Way points that are said one by one: SET_POSITION_TARGET_LOCAL_NED, again and again."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.bridges.mavlink.dialect import Message, mavlink
from muster.bridges.mavlink.frames import LocalFrame
from muster.motion.frames import wrapped, yaw_enu_to_ned
from muster.motion.port import Place, Waypoint

_IGNORE = mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
PLACE_AND_YAW = _IGNORE
"""Type mask, 2552: what counts is the place and the heading."""
PLACE_ALONE = _IGNORE | mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE
"""Type mask, 3576: the place alone."""

_TURNED_RAD = math.radians(10.0)
"""How near to its heading counts as turned."""
EVERY_S = 0.2
"""Seconds from one to the next: PX4 leaves its offboard mode below 2 Hz."""


@dataclass
class Follower:
    """Leads a drone through way points.

    Parameters
    ----------
    waypoints
        in order.
    accept_m
        how near counts as there; where there is a heading it must be turned too.
    """

    waypoints: Sequence[Waypoint]
    accept_m: float
    passed: int = 0
    _there_s: float | None = None  # since when it is at the next

    @property
    def aim(self) -> Waypoint:
        """The way point to which it goes, or at which it stays."""
        return self.waypoints[min(self.passed, len(self.waypoints) - 1)]

    def look(self, place: Place, heading: float, now: float) -> None:
        """See how far it is."""
        while self.passed < len(self.waypoints):
            if self._there_s is None and not self._is_there(place, heading):
                return
            self._there_s = now if self._there_s is None else self._there_s
            if now < self._there_s + self.aim.hold_s:
                return
            self.passed, self._there_s = self.passed + 1, None

    def _is_there(self, place: Place, heading: float) -> bool:
        aim = self.aim
        turned = aim.heading is None or abs(float(wrapped(aim.heading - heading))) <= _TURNED_RAD
        return turned and math.dist(place, aim.position) <= self.accept_m

    def message(self, target: Message, local: LocalFrame, now: float) -> Message:
        """Where it is to be now."""
        heading = self.aim.heading
        yaw = 0.0 if heading is None else float(yaw_enu_to_ned(heading))
        return mavlink.MAVLink_set_position_target_local_ned_message(
            int(now * 1000) & 0xFFFFFFFF,
            target.get_srcSystem(),
            target.get_srcComponent(),
            mavlink.MAV_FRAME_LOCAL_NED,
            PLACE_ALONE if heading is None else PLACE_AND_YAW,
            *local.to_drone(self.aim.position),
            *(0.0,) * 6,
            yaw,
            0.0,
        )
