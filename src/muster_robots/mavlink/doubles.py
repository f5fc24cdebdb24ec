"""Two autopilots with one system id on a line: what they say contradicts itself, message by message."""

from __future__ import annotations

import math
from dataclasses import dataclass

from muster_robots.mavlink.dialect import Message

_BACK_MS = 1000
"""A time since the start of an autopilot that goes back by more is that of another one, or it has started anew."""
_JUMP_M, _STANDS_MPS = 1.0, 0.5
_METRES_PER_E7 = 0.0111
"""Metres north of a degree of latitude times 1e-7."""
_BACK, _JUMPS = 2, 3
"""So often a time goes back, or a drone that stands is elsewhere, that there are two: one restart is none."""


@dataclass
class Doubles:
    """Working state of the comparison of the messages of one system."""

    _boot_ms: int | None = None
    _at_e7: tuple[int, int] | None = None
    _back: int = 0
    _jumps: int = 0

    @property
    def are_there(self) -> bool:
        """Whether two autopilots speak."""
        return self._back >= _BACK or self._jumps >= _JUMPS

    def hear(self, message: Message) -> None:
        """Take in one message."""
        boot_ms = getattr(message, "time_boot_ms", None)
        if boot_ms is not None:
            self._back += self._boot_ms is not None and boot_ms < self._boot_ms - _BACK_MS
            self._boot_ms = boot_ms
        if message.get_type() == "GLOBAL_POSITION_INT" and math.hypot(message.vx, message.vy) < _STANDS_MPS * 100:
            self._jumps += self._jumps_to(message.lat, message.lon)
            self._at_e7 = message.lat, message.lon

    def _jumps_to(self, lat_e7: int, lon_e7: int) -> bool:
        if self._at_e7 is None:
            return False
        shrunk = math.cos(math.radians(lat_e7 / 1e7))
        return math.hypot(lat_e7 - self._at_e7[0], (lon_e7 - self._at_e7[1]) * shrunk) * _METRES_PER_E7 > _JUMP_M
