"""Detects faults of one drone that are not answers to requests, and have nothing to do with who has it."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.faults import FaultError, Kind

_LOW_S = 2.0
"""Seconds for which a battery must be low: its voltage sags while a drone climbs."""


@dataclass
class FaultDetector:
    """Looks at a drone.

    Parameters
    ----------
    drone
        the drone.
    """

    drone: Drone
    _low_since_s: float = math.inf

    def check_clock(self, now: float) -> None:
        """Raise `FaultError` if the battery of a drone that was asked to arm is low."""
        if not self.drone.asked_to_arm:
            return
        if not self._low_in_words():
            self._low_since_s = math.inf
        elif self.drone.stands or now >= self._low_since_s + _LOW_S:
            self.require_charge()
        else:
            self._low_since_s = min(now, self._low_since_s)

    def require_charge(self) -> None:
        """Raise `FaultError` if the battery is low."""
        if words := self._low_in_words():
            raise FaultError(Kind.LOW_BATTERY, words)

    def check_heartbeat(self) -> None:
        """Raise `FaultError` if a drone that should fly is not armed."""
        drone, kind = self.drone, self.drone.kind
        flies = drone.telemetry.was_up or drone.route is not None or drone.follower is not None
        if not flies or drone.telemetry.armed or drone.mode in (kind.back, kind.land):
            return
        fell_m = drone.telemetry.motors_off_m
        if fell_m is not None:
            raise FaultError(Kind.DISARMED, f"its motors stopped {fell_m:.1f} m above its start")
        if drone.telemetry.was_up:
            raise FaultError(Kind.LANDED, "not on Muster's command")
        raise FaultError(Kind.DISARMED, "it says that it is not armed")

    def _low_in_words(self) -> str:
        left, least = self.drone.telemetry.battery, self.drone.settings.low_battery
        return f"{left:.0%} left; expected {least:.0%}" if left is not None and left < least else ""
