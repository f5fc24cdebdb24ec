"""Working state of one drone: its robot, its telemetry, its orders."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field, replace

from muster.execution.final_state import FinalState
from muster.mission.model import Robot
from muster.motion.port import Place, Waypoint
from muster_robots.custody import Holder, Seen, Wants
from muster_robots.fleet_settings import FlightSettings
from muster_robots.follower import Follower
from muster_robots.mavlink.autopilots import Autopilot
from muster_robots.mavlink.dialect import Message
from muster_robots.mavlink.mission_items import Route
from muster_robots.mavlink.own_limits import OwnLimits
from muster_robots.mavlink.telemetry import DroneTelemetry

_SILENT_S = 5.0
"""Seconds without any message after which a drone is told to be silent at the end."""
POSITION_LOST_S = 5.0
"""Seconds without a position after which a drone that is heard does not know where it is."""
_HOME_M = 3.0
"""A drone that lands this near to its start has returned."""


@dataclass
class UnheardOrder:
    """An order that was replaced while the drone was not heard, and that it may fly all the same."""

    number: int
    route: Route
    passed: int


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
    home: Place | None = None  # where it stood before it was armed
    limits: OwnLimits = field(default_factory=OwnLimits)  # that its autopilot sets

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

    @property
    def is_left_to_us(self) -> bool:
        """Whether nobody flies it but Muster: no pilot, and no failsafe of its autopilot."""
        return self.ours or (self.stands and (not self.telemetry.armed or self.telemetry.mode in self.kind.own_modes))

    @property
    def has_passed_all(self) -> bool:
        """Whether it has flown the mission that it was given to the end."""
        return self.route is not None and self.passed >= self.route.ends_at

    def seen(self, *, busy: bool) -> Seen:
        """What it shows of itself; `busy`: a command is under way, so that any mode that Muster asks for is fine."""
        telemetry = self.telemetry
        lost_s = telemetry.heard_s - max(telemetry.place_s, telemetry.heard_since_s)
        blind = f"no position for {lost_s:.1f} s" if lost_s > POSITION_LOST_S and telemetry.place is not None else ""
        return Seen(
            telemetry.heard_s,
            telemetry.heartbeat_s,
            self._does,
            self._holder(busy=busy),
            telemetry.breach or blind,
            telemetry.sticks,
        )

    @property
    def _does(self) -> Wants | None:
        kind, mode = self.kind, self.telemetry.mode
        if not self.telemetry.armed:
            return Wants.IDLE
        if self.stands:  # armed on the ground it is about to take off, whatever its mode
            return Wants.ORDER
        does = {kind.hold: Wants.HOLD, kind.back: Wants.RETURN, kind.land: Wants.LAND}
        return does.get(mode, Wants.ORDER if mode in kind.own_modes else None)

    def _holder(self, *, busy: bool) -> Holder:
        """Who has it, by its mode, and by whether its autopilot says that a failsafe is on."""
        telemetry, kind = self.telemetry, self.kind
        if not telemetry.armed or telemetry.mode == self.mode:
            return Holder.MUSTER
        if telemetry.mode in kind.stick_modes:
            return Holder.PILOT
        if telemetry.critical:
            return Holder.FAILSAFE
        if telemetry.mode in kind.own_modes:
            flies = (self.route is not None or self.follower is not None) and self.mode in (kind.mission, kind.guided)
            held = flies and telemetry.mode == kind.hold and not self.has_passed_all
            return Holder.STATION if held else Holder.MUSTER
        return Holder.MUSTER if busy and telemetry.mode in (kind.back, kind.land) else Holder.STATION

    def refusal(self, places: Sequence[Place], here: Place | None = None) -> str:
        """Return why places, in the order of flight, or legs to them are outside the limits of its autopilot.

        Parameters
        ----------
        places : sequence of Place
            In the map frame.
        here : Place, optional
            Where the first leg begins; by default that leg is not looked at.
        """
        return self.limits.refusal(self.autopilot, self.home or self.telemetry.start, places, here)

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
    does, place = _activity(drone), telemetry.place
    silent_s = now - telemetry.heard_s
    if place is not None and not telemetry.is_located:
        at = ", ".join(f"{c:.2f}" for c in place)
        does += f"; its position is not known, {telemetry.heard_s - telemetry.place_s:.0f} s before it was ({at})"
        place = None
    crashed = telemetry.motors_off_m is not None
    if silent_s <= _SILENT_S:
        return FinalState(drone.robot.id, does, place, moving=telemetry.armed, crashed=crashed)
    last = "asked to arm" if drone.stands and not telemetry.armed else does
    state = f"not answering for {silent_s:.0f} s; last seen: {last}"
    return FinalState(drone.robot.id, state, place, moving=telemetry.armed or drone.stands, crashed=crashed)


def _activity(drone: Drone) -> str:
    telemetry, kind = drone.telemetry, drone.kind
    if telemetry.motors_off_m is not None:
        return f"crashed: its motors stopped {telemetry.motors_off_m:.1f} m above its start; not armed"
    if not telemetry.armed:
        if not telemetry.was_up:
            return "did not fly, not armed"
        home = (
            telemetry.place is not None
            and telemetry.is_located
            and math.dist(telemetry.place, telemetry.start) <= _HOME_M
        )
        return "returned, landed, not armed" if home else "landed, not armed"
    if telemetry.place is None:
        return "armed, its height not known"
    if not telemetry.up:
        return "on the ground, armed"
    names = {kind.hold: "hovers", kind.back: "returns", kind.land: "lands"}
    by = "a pilot" if telemetry.mode in kind.stick_modes else "a failsafe or another station"
    default = "flies" if telemetry.mode in kind.own_modes else f"flies under {by}"
    return f"{names.get(telemetry.mode, default)}, armed"
