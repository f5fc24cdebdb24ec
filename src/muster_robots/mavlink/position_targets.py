"""Way points sent one by one, repeatedly: SET_POSITION_TARGET_LOCAL_NED."""

from __future__ import annotations

import math

from muster.motion.port import Waypoint
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.frames import LocalFrame

_IGNORE = mavlink.POSITION_TARGET_TYPEMASK_VX_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_VY_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_VZ_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_AX_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_AY_IGNORE | mavlink.POSITION_TARGET_TYPEMASK_AZ_IGNORE
_IGNORE |= mavlink.POSITION_TARGET_TYPEMASK_YAW_RATE_IGNORE
PLACE_AND_YAW = _IGNORE
"""Type mask, 2552: what counts is the place and the heading."""
PLACE_ALONE = _IGNORE | mavlink.POSITION_TARGET_TYPEMASK_YAW_IGNORE
"""Type mask, 3576: the place alone."""

TURNED_RAD = math.radians(10.0)
"""How near to its heading counts as turned."""
EVERY_S = 0.2
"""Seconds from one to the next: PX4 leaves its offboard mode below 2 Hz."""


def position_target(aim: Waypoint, target: Message, local: LocalFrame, now: float) -> Message:
    """Where a drone is to be now.

    Parameters
    ----------
    target
        a message of the drone.
    """
    yaw = 0.0 if aim.heading is None else local.heading_to_drone(aim.heading)
    return mavlink.MAVLink_set_position_target_local_ned_message(
        int(now * 1000) & 0xFFFFFFFF,
        target.get_srcSystem(),
        target.get_srcComponent(),
        mavlink.MAV_FRAME_LOCAL_NED,
        PLACE_ALONE if aim.heading is None else PLACE_AND_YAW,
        *local.to_drone(aim.position),
        *(0.0,) * 6,
        yaw,
        0.0,
    )
