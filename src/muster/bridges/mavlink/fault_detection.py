"""What is noticed of one drone that it did not answer: each a fault by its name."""

from __future__ import annotations

from dataclasses import dataclass

from muster.bridges.mavlink.drone import Craft
from muster.bridges.mavlink.faults import FaultError, Kind

_TWICE = 2  # one heartbeat in another mode may be older than the mode that was asked for


@dataclass
class Watch:
    """Looks at a drone.

    Parameters
    ----------
    craft
        the drone.
    astray
        how many heartbeats in a row have shown it in a mode that Muster did not choose.
    """

    craft: Craft
    astray: int = 0

    def look_at_clock(self, now: float) -> None:
        """A link that is lost; and of a drone that was asked to arm a fence that is breached, a battery that is low."""
        craft = self.craft
        silence = now - craft.seen.heartbeat_s
        if silence > craft.settings.link_lost_s:
            raise FaultError(Kind.LINK_LOST, f"no heartbeat for {silence:.1f} s")
        if craft.asked_to_arm:
            if craft.seen.breach:
                raise FaultError(Kind.FENCE_BREACHED, craft.seen.breach)
            self.require_charge()

    def require_charge(self) -> None:
        left, least = self.craft.seen.battery, self.craft.settings.low_battery
        if left is not None and left < least:
            raise FaultError(Kind.LOW_BATTERY, f"{left:.0%} left; expected {least:.0%}")

    def require_nobody_flies_it(self) -> None:
        """A drone that is armed in a mode that is none of Muster's has a pilot."""
        if self.craft.seen.armed and self.craft.seen.mode not in self.craft.kind.own_modes:
            raise FaultError(Kind.TAKEN_OVER, self._mode_in_words())

    def look_at_heartbeat(self) -> None:
        """A drone that should fly and is not armed, or in a mode that Muster did not choose.

        Somebody else flies it then: the pilot, or the autopilot's own failsafe.
        """
        craft, kind = self.craft, self.craft.kind
        flies = craft.seen.was_up or craft.route is not None or craft.follower is not None
        if flies and not craft.seen.armed and craft.mode not in (kind.back, kind.land):
            raise FaultError(Kind.DISARMED, craft.seen.text or "it says that it is not armed")
        over = craft.route is not None and craft.passed >= len(craft.route.passed_with)
        self._count(craft.mode is None or craft.seen.mode == craft.mode or (over and craft.seen.mode == kind.hold))

    def look_meanwhile(self) -> None:
        """The same while modes are being changed: then any that Muster asks for is fine."""
        kind = self.craft.kind
        self._count(not self.craft.seen.armed or self.craft.seen.mode in (*kind.own_modes, kind.back, kind.land))

    def _count(self, fine: bool) -> None:
        self.astray = 0 if fine else self.astray + 1
        if self.astray >= _TWICE:
            raise FaultError(Kind.TAKEN_OVER, self._mode_in_words())

    def _mode_in_words(self) -> str:
        return f"mode {self.craft.seen.mode:#x}; {self.craft.seen.text}".rstrip("; ")
