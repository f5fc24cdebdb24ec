"""Way points as the items of a mission (MISSION_ITEM_INT), and the way point of each item."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from muster.motion.frames import yaw_enu_to_ned
from muster.motion.port import Place, Waypoint
from muster_robots.mavlink.autopilots import Autopilot
from muster_robots.mavlink.dialect import Message, mavlink
from muster_robots.mavlink.frames import GlobalFrame

RELATIVE = mavlink.MAV_FRAME_GLOBAL_RELATIVE_ALT_INT


@dataclass(frozen=True)
class Detour(Waypoint):
    """A way point that the bridge adds to an order, and that its sender does not count."""


def given_in(waypoints: Sequence[Waypoint]) -> int:
    """Return how many way points are of the order as it was given."""
    return sum(not isinstance(waypoint, Detour) for waypoint in waypoints)


@dataclass(frozen=True)
class Item:
    """One item: `params` are its first four parameters, `x` and `y` degrees times 1e7, `z` metres above home."""

    command: int
    params: tuple[float, float, float, float]
    x: int = 0
    y: int = 0
    z: float = 0.0
    frame: int = RELATIVE


@dataclass(frozen=True)
class Route:
    """What is uploaded.

    Parameters
    ----------
    items
        in order, from item 0.
    first
        the item that it begins with.
    passed_with
        for each item that is a way point, how many way points of the order as it was given are passed when it is
        reached.
    """

    items: tuple[Item, ...]
    first: int
    passed_with: dict[int, int]

    @property
    def ends_at(self) -> int:
        """The number of way points that are passed at its end."""
        return max(self.passed_with.values(), default=0)

    def passed(self, reached: int) -> int:
        """How many way points are passed when an item is, and with it all before."""
        return max((count for seq, count in self.passed_with.items() if seq <= reached), default=0)

    def passed_by(self, message: Message) -> int:
        """How many way points are passed by what a message says; 0 if it says nothing of that."""
        if message.get_type() == "MISSION_ITEM_REACHED":
            return self.passed(message.seq)
        if message.get_type() != "MISSION_CURRENT":
            return 0
        over = message.mission_state == mavlink.MISSION_STATE_COMPLETE
        return self.passed(len(self.items) if over else message.seq - 1)


def route_of(
    waypoints: Sequence[Waypoint],
    here: Place,
    frame: GlobalFrame,
    autopilot: Autopilot,
    *,
    speed_mps: float,
    accept_m: float,
    take_off: bool,
) -> Route:
    """The items of an order.

    ArduPilot holds for whole seconds, and leaves param4 of a way point unread: a CONDITION_YAW before it turns the
    drone on its way there. After it would be too late: what follows a way point begins when that is left (AP_Mission).

    Parameters
    ----------
    here
        where the drone is.
    take_off
        whether it climbs first, straight up, to the height of the first way point.
    accept_m
        how near it must come to a way point.
    """
    items: list[Item] = []
    if autopilot.home_first:
        items.append(Item(mavlink.MAV_CMD_NAV_WAYPOINT, (0, 0, 0, 0), *frame.to_drone(here)))
    first = len(items)
    if take_off:
        above = frame.to_drone((here[0], here[1], waypoints[0].position[2]))
        items.append(Item(mavlink.MAV_CMD_NAV_TAKEOFF, (0, 0, 0, math.nan), *above))
    passed_with = {}
    told_mps = math.nan
    for count, waypoint in enumerate(waypoints, 1):
        if (most_mps := min(speed_mps, waypoint.speed_mps)) != told_mps:
            told_mps = most_mps
            items.append(Item(mavlink.MAV_CMD_DO_CHANGE_SPEED, (1, told_mps, -1, 0), frame=mavlink.MAV_FRAME_MISSION))
        yaw = math.nan if waypoint.heading is None else math.degrees(float(yaw_enu_to_ned(waypoint.heading)))
        hold_s = waypoint.hold_s
        if autopilot.home_first:
            if waypoint.heading is not None:
                turn = (yaw % 360.0, 0.0, 0.0, 0.0)
                items.append(Item(mavlink.MAV_CMD_CONDITION_YAW, turn, frame=mavlink.MAV_FRAME_MISSION))
            hold_s, yaw = math.ceil(hold_s), math.nan
        passed_with[len(items)] = given_in(waypoints[:count])
        params = (hold_s, accept_m, 0.0, yaw)
        items.append(Item(mavlink.MAV_CMD_NAV_WAYPOINT, params, *frame.to_drone(waypoint.position)))
    return Route(tuple(items), first, passed_with)
