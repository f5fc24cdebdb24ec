"""Fleets of real robots; each is ready when it is returned."""

from __future__ import annotations

import threading
from collections.abc import Mapping
from functools import partial
from typing import Any

from muster.bridges.fleet import Fleet
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.running.fleet_registry import FLEETS, Opened
from muster.running.live import wait_for_robots
from muster.running.robot_claims import claims, mavlink_claims, ros1_claims, ros2_claims

_WAIT_S = 10.0
_ANYWHERE_M = 1e6
"""After a crash drones are where they are, in the air maybe."""


def fleet_ready(
    world: str, mission: Mission, settings: Mapping[str, Any], halt: threading.Event, *, again: bool
) -> Opened:
    """The robots of a mission, ready to go; and the function to call when all is done.

    Parameters
    ----------
    world
        the name of the fleet.
    halt
        ends waiting for robots.
    again
        whether the mission is under way already.

    Raises
    ------
    MusterError
        if there is no such fleet, the bridge lacks something, or robots do not answer.
    """
    return FLEETS.named(world)(mission, settings, halt, again)


@claims(ros1_claims)
def open_ros1(mission: Mission, settings: Mapping[str, Any], halt: threading.Event, _again: bool) -> Opened:
    from muster.bridges.ros1.extra import require_rospy

    require_rospy()
    from muster.bridges.ros1.fleet import Ros1Fleet
    from muster.bridges.ros1.node import become_node

    become_node("muster", settings.get("master"))
    own = _some(settings, "drive", "namespace", "frame", "arrival_m", "rate_hz", "avoidance", "odometry", "poses")
    fleet = Ros1Fleet(mission, joins=not settings.get("known_only", False), **own)
    return _heard(fleet, settings, halt), _nothing


@claims(ros2_claims)
def open_ros2(mission: Mission, settings: Mapping[str, Any], halt: threading.Event, _again: bool) -> Opened:
    from muster.bridges.ros2.fleet import Ros2Fleet
    from muster.bridges.ros2.open_middleware import open_middleware
    from muster.bridges.ros2.port import Arrival

    fleet = Ros2Fleet(
        mission,
        middleware=open_middleware(settings.get("by"), settings.get("domain")),
        arrival=Arrival(near_m=settings.get("arrival_m", 0.25)),
        joins=not settings.get("known_only", False),
        **_some(settings, "give", "namespace"),
    )
    return _heard(fleet, settings, halt), _nothing


@claims(mavlink_claims)
def open_mavlink(mission: Mission, settings: Mapping[str, Any], _halt: threading.Event, again: bool) -> Opened:
    from muster.bridges.mavlink import MavlinkFleet
    from muster.bridges.fleet_settings import FlightSettings

    endpoints = settings.get("endpoints")
    if not isinstance(endpoints, Mapping):
        raise ParameterError("endpoints: missing; expected for each robot how it is reached")
    if not settings.get("arm", False):
        raise ParameterError("arm: missing; expected true: without it nothing flies")
    own = _some(settings, "offboard", "local_frame", "low_battery") | ({"far_m": _ANYWHERE_M} if again else {})
    fleet = MavlinkFleet(mission, endpoints, Settings(arm=True, **own), height_m=settings.get("height_m"))
    try:
        fleet.connect(settings.get("wait_s", _WAIT_S))
    except BaseException:
        fleet.close()
        raise
    at_end = settings.get("at_end", "hold")
    return fleet, _nothing if at_end == "hold" else partial(fleet.end, at_end)


def _heard(fleet: Any, settings: Mapping[str, Any], halt: threading.Event) -> Fleet:
    try:
        wait_for_robots(fleet, halt, settings.get("wait_s", _WAIT_S))
    except BaseException:
        fleet.close()
        raise
    return fleet  # type: ignore[no-any-return]


def _some(settings: Mapping[str, Any], *names: str) -> dict[str, Any]:
    return {name: settings[name] for name in names if name in settings}


def _nothing() -> None:
    """They stay where they are."""
