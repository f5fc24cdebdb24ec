"""The sequence of requests for each order: fly way points, change the mode, stand down."""

from __future__ import annotations

from collections.abc import Callable, Sequence

from muster.motion.port import Waypoint
from muster_robots.follower import Follower
from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.faults import FaultError, Kind
from muster_robots.mavlink.fence_detours import MapCheck, within_limits
from muster_robots.mavlink.mission_items import route_of
from muster_robots.mavlink.own_limits import read_limits
from muster_robots.mavlink.position_targets import TURNED_RAD
from muster_robots.mavlink.procedures import armed, climb, disarmed, started, upload
from muster_robots.mavlink.procedures import mode as change_mode
from muster_robots.mavlink.requests import Script, pause


def with_limits(drone: Drone) -> Script:
    """Read what limits where a drone may fly."""
    if not drone.telemetry.armed:
        drone.home = drone.telemetry.place
    earth, offboard = drone.telemetry.earth, drone.settings.offboard
    to_map = None if earth is None else earth.to_map
    yield from read_limits(drone.target, drone.kind, drone.limits, to_map, offboard=offboard)


def after_limits(
    drone: Drone, waypoints: Sequence[Waypoint], check: MapCheck, way: Callable[[Drone, Sequence[Waypoint]], Script]
) -> Script:
    """Fly way points if the limits of the autopilot allow them; these are read first if the drone was silent before.

    Areas of its own fence are passed by detours, as far as the mission's map allows these; see `within_limits`.

    Raises
    ------
    FaultError
        if they do not.
    """
    if not drone.limits.is_read:
        yield from with_limits(drone)
    assert drone.telemetry.place is not None
    kept = within_limits(drone, waypoints, drone.telemetry.place, check)
    if isinstance(kept, str):
        raise FaultError(Kind.OUTSIDE_FENCE, kept)
    yield from way(drone, kept)


def mission(drone: Drone, waypoints: Sequence[Waypoint]) -> Script:
    """Stay, be given a mission, arm if it stands on the ground, fly it. Missions are never changed in flight."""
    telemetry, kind = drone.telemetry, drone.kind
    yield from into(drone, kind.hold if telemetry.up else kind.ready)
    assert telemetry.place is not None
    assert telemetry.earth is not None
    route = route_of(
        waypoints,
        telemetry.place,
        telemetry.earth,
        kind,
        speed_mps=drone.robot.speed_mps,
        accept_m=drone.settings.accept_m,
        take_off=not telemetry.up,
    )
    yield from upload(drone.target, route)
    yield from _armed(drone)
    drone.mode, drone.changing_mode = None, True
    yield from started(drone.target, kind, route.first)
    drone.route, drone.mode = route, kind.mission
    drone.changing_mode = telemetry.mode != kind.mission  # the start may have been shown by an item that is reached


def guided(drone: Drone, waypoints: Sequence[Waypoint]) -> Script:
    """PX4: way points are said for a second, then it follows them. ArduPilot: it climbs first."""
    follower = Follower(arrival_m=drone.settings.accept_m, turned_rad=TURNED_RAD, flat=False)
    follower.take(waypoints)
    if drone.kind.streams:
        drone.follower = follower
        yield pause(1.2)
        yield from into(drone, drone.kind.guided)
        yield from _armed(drone)
        return
    yield from into(drone, drone.kind.guided)
    yield from _armed(drone)
    if not drone.telemetry.up:
        yield from climb(drone.target, waypoints[0].position[2] - drone.telemetry.start[2])
    drone.follower = follower


def into(drone: Drone, mode: int) -> Script:
    """Into a mode, in which it must be from then on.

    Where another was asked for a moment ago, a heartbeat that shows this one may be older than that: one is not enough.
    """
    shown = drone.telemetry.mode == mode
    drone.mode = None
    if drone.changing_mode or not shown:
        drone.changing_mode = True
        yield from change_mode(drone.target, drone.kind, mode, sightings=2 if shown else 1)
    drone.mode, drone.changing_mode = mode, False


def stand_down(drone: Drone) -> Script:
    """Nobody watches an armed drone on the ground: it is disarmed, never by force; if it flies after all it hovers.

    To be armed may have been asked a moment ago, and may still be under way.
    """
    yield pause(0.0)  # an order that follows at once takes the place of this
    if not drone.telemetry.was_up:
        drone.disarming = drone.changing_mode = True
        try:
            yield from disarmed(drone.target, drone.kind)
        except FaultError:  # refused: it does not stand on the ground any more
            pass
        else:
            drone.asked_to_arm = drone.changing_mode = False
            return
    yield from into(drone, drone.kind.hold)


def _armed(drone: Drone) -> Script:
    if drone.telemetry.doubles.are_there and not drone.asked_to_arm:
        system = drone.target.get_srcSystem()
        raise FaultError(Kind.ARM_REFUSED, f"two autopilots have the system id {system}; expected one")
    drone.asked_to_arm = True
    if drone.disarming or not drone.telemetry.armed:
        yield from armed(drone.target)
    drone.disarming = False
