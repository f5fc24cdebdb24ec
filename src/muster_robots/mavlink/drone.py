"""Working state of one drone: its robot, its telemetry, its orders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from muster.execution.final_state import FinalState
from muster.mission.model import Robot
from muster.motion.port import Waypoint
from muster_robots.fleet_settings import FlightSettings
from muster_robots.follower import Follower
from muster_robots.mavlink.autopilots import Autopilot
from muster_robots.mavlink.dialect import Message
from muster_robots.mavlink.mission_items import Route
from muster_robots.mavlink.telemetry import DroneTelemetry

_HOME_M = 3.0
"""A drone that lands this near to its start has returned."""


@dataclass
class Drone:
    """Working state of one drone.

    Parameters
    ----------
    robot
        who it is in the mission.
    seen
        what it says of itself, and the frames in which it says it.
    settings
        what is allowed.
    height_m
        in a mission in the plane, how high above home it flies; None in space.
    """

    robot: Robot
    telemetry: DroneTelemetry
    settings: FlightSettings
    height_m: float | None
    autopilot: Autopilot | None = None  # once it was heard
    mode: int | None = None  # in which it must be
    asked_to_arm: bool = False
    changing_mode: bool = False  # whether a mode was asked for that no heartbeat has shown since
    disarming: bool = False  # whether that was asked, and to arm not since
    route: Route | None = None  # the mission that it flies
    follower: Follower | None = None  # or what leads it
    passed: int = 0

    @property
    def kind(self) -> Autopilot:
        """Its autopilot; a heartbeat must have arrived."""
        assert self.autopilot is not None
        return self.autopilot

    @property
    def target(self) -> Message:
        """A message of the drone; its sender is the target of commands."""
        assert self.telemetry.heartbeat is not None
        return self.telemetry.heartbeat

    @property
    def located(self) -> bool:
        """Whether its position is known in all frames in which it gets way points."""
        return self.telemetry.place is not None and not (self.settings.offboard and self.telemetry.local is None)

    @property
    def stands(self) -> bool:
        """Whether it was asked to arm, and was not seen in the air since: it may be armed, or be so soon."""
        return self.asked_to_arm and not self.telemetry.was_up

    @property
    def ours(self) -> bool:
        """Whether it flies, in a mode into which Muster brought it."""
        return self.asked_to_arm and self.telemetry.armed and self.telemetry.mode in self.kind.own_modes

    def forget_order(self) -> None:
        """It has no way points any more."""
        self.passed, self.route, self.follower = 0, None, None

    def flown(self, waypoints: Sequence[Waypoint]) -> list[Waypoint]:
        """Way points at the height at which they are flown."""
        ground = self.telemetry.start[2]
        lowest = ground + self.settings.lowest_m
        flat = None if self.height_m is None else ground + self.height_m

        def at_height(waypoint: Waypoint) -> Waypoint:
            x, y, z = waypoint.position
            return replace(waypoint, position=(x, y, max(z if flat is None else flat, lowest)))

        return [at_height(waypoint) for waypoint in waypoints]


def final_state_of(drone: Drone, now: float) -> FinalState:
    """Where a drone is at the end and what it does; one that is armed, or may be, counts as flying."""
    telemetry = drone.telemetry
    if drone.autopilot is None:
        return FinalState(drone.robot.id, "not heard", telemetry.place, moving=False)
    does = _activity(drone)
    silent_s = now - telemetry.heartbeat_s
    if silent_s <= drone.settings.link_lost_s:
        return FinalState(drone.robot.id, does, telemetry.place, moving=telemetry.armed)
    last = "asked to arm" if drone.stands and not telemetry.armed else does
    state = f"not answering for {silent_s:.0f} s; last seen: {last}"
    return FinalState(drone.robot.id, state, telemetry.place, moving=telemetry.armed or drone.stands)


def _activity(drone: Drone) -> str:
    telemetry, kind = drone.telemetry, drone.kind
    if not telemetry.armed:
        if not telemetry.was_up:
            return "did not fly, not armed"
        home = telemetry.place is not None and math.dist(telemetry.place, telemetry.start) <= _HOME_M
        return "returned, landed, not armed" if home else "landed, not armed"
    if telemetry.place is None:
        return "armed, its height not known"
    if not telemetry.up:
        return "on the ground, armed"
    names = {kind.hold: "hovers", kind.back: "returns", kind.land: "lands"}
    default = "flies" if telemetry.mode in kind.own_modes else "flies under a pilot or a failsafe"
    return f"{names.get(telemetry.mode, default)}, armed"
