"""The functions that open the fleets of the bridges; each fleet is ready when it is returned."""

from __future__ import annotations

import threading
from dataclasses import replace
from functools import partial
from typing import Any

from muster.execution.fleet import Fleet
from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.running.fleet_registry import AIR, Opened, declares
from muster.running.live import wait_for_robots
from muster_robots.claims import mavlink_claims, ros1_claims, ros2_claims
from muster_robots.fleet_settings import MavlinkSettings, Ros1Settings, Ros2Settings
from muster_robots.ros1.extra import require_rospy

_ANYWHERE_M = 1e6
"""After a crash drones are where they are, in the air maybe."""


@declares(settings=Ros1Settings, claims=ros1_claims, require_installed=require_rospy)
def open_ros1(mission: Mission, settings: Ros1Settings, halt: threading.Event, _again: bool) -> Opened:
    from muster_robots.ros1.fleet import Ros1Fleet
    from muster_robots.ros1.node import become_node

    become_node("muster", settings.master)
    return _heard(Ros1Fleet(mission, settings), settings.wait_s, halt), _nothing


@declares(settings=Ros2Settings, claims=ros2_claims)
def open_ros2(mission: Mission, settings: Ros2Settings, halt: threading.Event, _again: bool) -> Opened:
    return _heard(ros2_fleet(mission, settings), settings.wait_s, halt, NEEDED[settings.give]), _nothing


NEEDED = {"goals": "its pose", "nav2": "its pose, and Nav2"}
"""What robots on ROS 2 must have said before a mission begins, by how goals are sent."""


def ros2_fleet(mission: Mission, settings: Ros2Settings, **more: Any) -> Any:
    """Return the fleet of robots on ROS 2, before anything is heard of them."""
    from muster_robots.ros2.fleet import Ros2Fleet
    from muster_robots.ros2.open_middleware import open_middleware
    from muster_robots.ros2.port import Arrival

    return Ros2Fleet(
        mission,
        middleware=open_middleware(settings.by, settings.domain),
        give=settings.give,
        namespace=settings.namespace,
        arrival=Arrival(near_m=settings.arrival_m),
        frame=settings.frame,
        odometry=settings.odometry,
        poses=settings.poses,
        use_sim_time=settings.use_sim_time,
        joins=not settings.known_only,
        **more,
    )


@declares(settings=MavlinkSettings, claims=mavlink_claims, abilities=(AIR,))
def open_mavlink(mission: Mission, settings: MavlinkSettings, _halt: threading.Event, again: bool) -> Opened:
    from muster_robots.mavlink import MavlinkFleet

    if not settings.arm:
        raise ParameterError("arm: missing; expected true: without it nothing flies")
    how = replace(settings, far_m=_ANYWHERE_M) if again else settings
    fleet = MavlinkFleet(mission, how.endpoints, how, height_m=how.height_m)
    try:
        fleet.connect(how.wait_s)
    except BaseException:
        fleet.close()
        raise
    return fleet, _nothing if how.at_end == "hold" else partial(fleet.end, how.at_end)


def _heard(fleet: Any, wait_s: float, halt: threading.Event, needed: str = "its pose") -> Fleet:
    try:
        wait_for_robots(fleet, halt, wait_s, needed)
    except BaseException:
        fleet.close()
        raise
    return fleet  # type: ignore[no-any-return]


def _nothing() -> None:
    """They stay where they are."""
