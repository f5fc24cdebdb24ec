"""The functions that open the fleets of the bridges; each fleet is ready when it is returned."""

from __future__ import annotations

import threading
from contextlib import closing
from functools import partial
from typing import Any

from muster.execution.final_state import RobotsLeftError
from muster.execution.fleet import Fleet
from muster.mission.errors import MusterError, ParameterError
from muster.mission.model import Mission
from muster.running.fleet_type import AIR, BATTERY, CHARGES, GROUND, HOLDS, JOINS, RESUMES, RETURNS, FleetType, Opened
from muster.running.live import wait_for_robots
from muster_robots.claims import mavlink_claims, ros1_claims, ros2_claims
from muster_robots.fleet_settings import MavlinkSettings, Ros1Settings, Ros2Settings
from muster_robots.ros1.extra import require_rospy


def open_ros1(mission: Mission, settings: Ros1Settings, halt: threading.Event, again: bool) -> Opened:
    from muster_robots.ros1.fleet import Ros1Fleet
    from muster_robots.ros1.node import become_node

    become_node("muster", settings.master)
    return _heard(Ros1Fleet(mission, settings), settings.wait_s, halt, some=again), _nothing


def open_ros2(mission: Mission, settings: Ros2Settings, halt: threading.Event, again: bool) -> Opened:
    from muster_robots.ros2.fleet import Ros2Fleet

    return _heard(Ros2Fleet(mission, settings), settings.wait_s, halt, NEEDED[settings.give], some=again), _nothing


NEEDED = {"goals": "its pose", "nav2": "its pose, and Nav2"}
"""What robots on ROS 2 must have said before a mission begins, by how goals are sent."""


def open_mavlink(mission: Mission, settings: MavlinkSettings, halt: threading.Event, again: bool) -> Opened:
    from muster_robots.mavlink import MavlinkFleet

    if not settings.arm:
        raise ParameterError("arm: missing; expected true: without it nothing flies")
    fleet = MavlinkFleet(mission, settings.endpoints, settings, height_m=settings.height_m)
    try:
        fleet.connect(settings.wait_s, again=again)
    except MusterError as error:
        with closing(fleet):
            states = fleet.final_states()
        if any(state.moving for state in states):
            raise RobotsLeftError(str(error), states) from error
        raise
    except BaseException:
        fleet.close()
        raise
    return fleet, partial(fleet.finish, settings.at_end, halt.is_set)


def _heard(fleet: Any, wait_s: float, halt: threading.Event, needed: str = "its pose", *, some: bool = False) -> Fleet:
    try:
        wait_for_robots(fleet, halt, wait_s, needed, some=some)
    except BaseException:
        fleet.close()
        raise
    return fleet  # type: ignore[no-any-return]


def _nothing() -> None:
    """They stay where they are."""


_ROS = (GROUND, AIR, JOINS, HOLDS, RETURNS, CHARGES, RESUMES)

ROS1 = FleetType(
    name="ros1",
    open=open_ros1,
    abilities=_ROS,
    settings=Ros1Settings,
    claims=ros1_claims,
    require_installed=require_rospy,
)
ROS2 = FleetType(name="ros2", open=open_ros2, abilities=_ROS, settings=Ros2Settings, claims=ros2_claims)
MAVLINK = FleetType(
    name="mavlink",
    open=open_mavlink,
    abilities=(AIR, HOLDS, RETURNS, BATTERY, RESUMES),
    settings=MavlinkSettings,
    claims=mavlink_claims,
)
