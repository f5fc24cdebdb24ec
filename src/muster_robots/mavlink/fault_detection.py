"""Detects faults of one drone that are not answers to requests; each has a name."""

from __future__ import annotations

from dataclasses import dataclass

from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.faults import FaultError, Kind

_TWICE = 2  # one heartbeat in another mode may be older than the mode that was asked for


@dataclass
class FaultDetector:
    """Looks at a drone.

    Parameters
    ----------
    drone
        the drone.
    astray
        how many heartbeats in a row have shown it in a mode that Muster did not choose.
    """

    drone: Drone
    astray: int = 0

    def check_clock(self, now: float) -> None:
        """A link that is lost; and of a drone that was asked to arm a fence that is breached, a battery that is low."""
        drone = self.drone
        silence = now - drone.telemetry.heartbeat_s
        if silence > drone.settings.link_lost_s:
            raise FaultError(Kind.LINK_LOST, f"no heartbeat for {silence:.1f} s")
        if drone.asked_to_arm:
            if drone.telemetry.breach:
                raise FaultError(Kind.FENCE_BREACHED, drone.telemetry.breach)
            self.require_charge()

    def require_charge(self) -> None:
        left, least = self.drone.telemetry.battery, self.drone.settings.low_battery
        if left is not None and left < least:
            raise FaultError(Kind.LOW_BATTERY, f"{left:.0%} left; expected {least:.0%}")

    def require_nobody_flies_it(self) -> None:
        """A drone that is armed in a mode that is none of Muster's has a pilot."""
        if self.drone.telemetry.armed and self.drone.telemetry.mode not in self.drone.kind.own_modes:
            raise FaultError(Kind.TAKEN_OVER, self._mode_in_words())

    def check_heartbeat(self) -> None:
        """A drone that should fly and is not armed, or in a mode that Muster did not choose.

        Somebody else flies it then: the pilot, or the autopilot's own failsafe.
        """
        drone, kind = self.drone, self.drone.kind
        flies = drone.telemetry.was_up or drone.route is not None or drone.follower is not None
        if flies and not drone.telemetry.armed and drone.mode not in (kind.back, kind.land):
            raise FaultError(Kind.DISARMED, drone.telemetry.text or "it says that it is not armed")
        over = drone.route is not None and drone.passed >= len(drone.route.passed_with)
        self._count(
            drone.mode is None or drone.telemetry.mode == drone.mode or (over and drone.telemetry.mode == kind.hold)
        )

    def check_heartbeat_meanwhile(self) -> None:
        """The same while modes are being changed: then any that Muster asks for is fine."""
        kind = self.drone.kind
        self._count(
            not self.drone.telemetry.armed or self.drone.telemetry.mode in (*kind.own_modes, kind.back, kind.land)
        )

    def _count(self, fine: bool) -> None:
        self.astray = 0 if fine else self.astray + 1
        if self.astray >= _TWICE:
            raise FaultError(Kind.TAKEN_OVER, self._mode_in_words())

    def _mode_in_words(self) -> str:
        return f"mode {self.drone.telemetry.mode:#x}; {self.drone.telemetry.text}".rstrip("; ")
