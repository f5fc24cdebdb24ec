"""What a drone is told from first to last when it is given an order: to fly way points, to hover, to stand down."""

from __future__ import annotations

from collections.abc import Sequence

from muster.bridges.follower import Follower
from muster.bridges.mavlink import procedures
from muster.bridges.mavlink.drone import Craft
from muster.bridges.mavlink.faults import FaultError
from muster.bridges.mavlink.mission_items import route_of
from muster.bridges.mavlink.position_targets import TURNED_RAD
from muster.bridges.mavlink.requests import Script, pause
from muster.motion.port import Waypoint


def mission(craft: Craft, waypoints: Sequence[Waypoint]) -> Script:
    """Stay, be given a mission, arm if it stands on the ground, fly it. Missions are never changed in flight."""
    seen, kind = craft.seen, craft.kind
    yield from into(craft, kind.hold if seen.up else kind.ready)
    assert seen.place is not None
    assert seen.earth is not None
    route = route_of(
        waypoints,
        seen.place,
        seen.earth,
        kind,
        speed_mps=craft.robot.speed_mps,
        accept_m=craft.settings.accept_m,
        take_off=not seen.up,
    )
    yield from procedures.upload(craft.target, route)
    yield from _armed(craft)
    craft.mode, craft.changing_mode = None, True
    yield from procedures.started(craft.target, kind, route.first)
    craft.route, craft.mode, craft.changing_mode = route, kind.mission, False


def guided(craft: Craft, waypoints: Sequence[Waypoint]) -> Script:
    """PX4: way points are said for a second, then it follows them. ArduPilot: it climbs first."""
    follower = Follower(arrival_m=craft.settings.accept_m, turned_rad=TURNED_RAD, flat=False)
    follower.take(waypoints)
    if craft.kind.streams:
        craft.follower = follower
        yield pause(1.2)
        yield from into(craft, craft.kind.guided)
        yield from _armed(craft)
        return
    yield from into(craft, craft.kind.guided)
    yield from _armed(craft)
    if not craft.seen.up:
        yield from procedures.climb(craft.target, waypoints[0].position[2] - craft.seen.start[2])
    craft.follower = follower


def into(craft: Craft, mode: int) -> Script:
    """Into a mode, in which it must be from then on.

    Where another was asked for a moment ago, a heartbeat that shows this one may be older than that: one is not enough.
    """
    shown = craft.seen.mode == mode
    craft.mode = None
    if craft.changing_mode or not shown:
        craft.changing_mode = True
        yield from procedures.mode(craft.target, craft.kind, mode, sightings=2 if shown else 1)
    craft.mode, craft.changing_mode = mode, False


def stand_down(craft: Craft) -> Script:
    """Nobody watches an armed drone on the ground: it is disarmed, never by force; if it flies after all it hovers.

    To be armed may have been asked a moment ago, and may still be under way.
    """
    yield pause(0.0)  # an order that follows at once takes the place of this
    if not craft.seen.was_up:
        craft.disarming = craft.changing_mode = True
        try:
            yield from procedures.disarmed(craft.target, craft.kind)
        except FaultError:  # refused: it does not stand on the ground any more
            pass
        else:
            craft.asked_to_arm = craft.changing_mode = False
            return
    yield from into(craft, craft.kind.hold)


def _armed(craft: Craft) -> Script:
    craft.asked_to_arm = True
    if craft.disarming or not craft.seen.armed:
        yield from procedures.armed(craft.target)
    craft.disarming = False
