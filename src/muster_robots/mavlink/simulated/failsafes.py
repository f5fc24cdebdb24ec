"""What an autopilot does of itself: failsafes that come and go, a pilot, another station. Sans-I/O.

PX4 keeps the mode that was asked for beside the one in which it flies: when a failsafe is over it resumes the former,
a mission too. ArduCopter stays in the mode of its failsafe. [PX4: commander, `set_nav_state`; ArduCopter: events.cpp]
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

from muster_robots.mavlink.autopilots import PX4, Autopilot
from muster_robots.mavlink.dialect import mavlink
from muster_robots.mavlink.simulated.faults import Faults
from muster_robots.mavlink.simulated.geofence import HOLDS, LANDS, RETURNS

FLASH_S = 3.0
"""Seconds for which a failsafe is on after the process of an autopilot stood still."""
_STICKS_MISSED_S = 1.0
_CRITICAL, _WARNING, _INFO = mavlink.MAV_SEVERITY_CRITICAL, mavlink.MAV_SEVERITY_WARNING, mavlink.MAV_SEVERITY_INFO


@dataclass
class OwnModes:
    """Modes of one autopilot that nobody but itself, a pilot or another station has chosen.

    Parameters
    ----------
    kind : Autopilot
        PX4 or ArduPilot.
    faults : Faults
        What goes wrong.
    tell : callable
        Sends a status text of a severity.
    fence_action : int
        GF_ACTION of PX4; ArduPilot returns when it leaves its fence.
    """

    kind: Autopilot
    faults: Faults
    tell: Callable[[int, str], None]
    fence_action: int = HOLDS
    on: str = ""  # cause of the failsafe that is on
    asked: int = 0  # the mode that flies on when it is over
    _outside: bool = False  # whether the drone was outside its fence when that was looked at last
    _happened: set[str] = field(default_factory=set)

    @property
    def _stick_mode(self) -> int:
        return self.kind.stick_modes[1]

    def is_on(self, what: str, since_armed_s: float) -> bool:
        """Return whether a fault with a begin, and maybe an end, is on: `silent`, `gps_lost`, `breach_text` ..."""
        at_s = getattr(self.faults, f"{what}_at_s")
        for_s = getattr(self.faults, f"{what.removesuffix('_text')}_for_s")
        return at_s is not None and at_s <= since_armed_s < at_s + for_s

    def _once(self, what: str, due: bool) -> bool:
        if not due or what in self._happened:
            return False
        self._happened.add(what)
        return True

    def mode_after(self, mode: int, since_armed_s: float, *, outside: bool = False) -> int:
        """Return the mode in which the autopilot flies on, from the one in which it flies.

        Parameters
        ----------
        mode : int
            In which it flies.
        since_armed_s : float
            Seconds since the first arming.
        outside : bool
            Whether the drone is outside its fence.
        """
        faults = self.faults
        if self._once("rtl", faults.rtl_at_s is not None and since_armed_s >= faults.rtl_at_s):
            self.tell(_INFO, "RTL: climb to 502 m (2 m above destination)")
            mode = self.kind.back
        mode = self._under_a_pilot(mode, since_armed_s)
        leaves, self._outside = outside and not self._outside, outside
        if leaves and self.kind is not PX4:
            self.tell(_CRITICAL, "Polygon fence breached")
            mode = self.kind.back
        cause = self._cause(mode, since_armed_s) or ("geofence" if leaves or self.on == "geofence" else "")
        cause = "" if cause == "geofence" and self.kind is not PX4 else cause
        if cause and not self.on:
            self.asked = mode
            self.tell(_CRITICAL, f"Failsafe enabled: {cause}")
            self.tell(_CRITICAL, "Failsafe mode activated")
            mode = self._mode_in(cause)
        elif self.on and not cause:
            self.tell(_INFO, "Failsafe mode deactivated")
            mode = self.asked if self.kind is PX4 else mode
        self.on = cause
        return mode

    def ask(self, mode: int, flying: int) -> int:
        """Another mode is asked for; return the one in which it flies then: during a failsafe that of the failsafe."""
        if self.on in ("no manual control", "geofence"):  # both are over when another mode is asked for
            self.on = ""
        if not self.on:
            return mode
        self.asked = mode
        return flying

    def _mode_in(self, cause: str) -> int:
        """Return the mode in which the autopilot flies during a failsafe."""
        kind = self.kind
        if cause == "geofence":
            return {HOLDS: kind.hold, RETURNS: kind.back, LANDS: kind.land}[self.fence_action]
        return {"no global position": kind.land, "no datalink": kind.back}.get(cause, kind.hold)

    def _under_a_pilot(self, mode: int, since_armed_s: float) -> int:
        if self.faults.no_sticks:
            begins = self._once("pilot", self.is_on("pilot", since_armed_s))
            return self._stick_mode if begins else mode
        if self.is_on("pilot", since_armed_s):
            return self._stick_mode
        over = self.faults.pilot_at_s is not None and since_armed_s >= self.faults.pilot_at_s
        return self.kind.hold if self._once("released", over) else mode

    def _cause(self, mode: int, since_armed_s: float) -> str:
        faults = self.faults
        if self.is_on("gps_lost", since_armed_s):
            return "no global position"
        thaw_s = None if faults.frozen_at_s is None else faults.frozen_at_s + faults.frozen_for_s
        if thaw_s is not None and thaw_s <= since_armed_s < thaw_s + FLASH_S:
            return "no datalink"
        missed_s = since_armed_s - (faults.pilot_at_s or 0.0)
        missed = faults.no_sticks and self.kind is PX4 and mode == self._stick_mode and missed_s >= _STICKS_MISSED_S
        return "no manual control" if missed or self.on == "no manual control" else ""
