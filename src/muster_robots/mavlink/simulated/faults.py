"""The configurable faults of a simulated drone."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Faults:
    """What goes wrong.

    Parameters
    ----------
    loss
        share of packets that are lost, both ways.
    refuse_arm, refuse_start, mute
        whether it does not arm; does not start a mission, nor follow way points; answers nothing that it is told.
    slow_arm_s
        seconds from when it is told to arm until it is armed.
    reject_item, repeat_reached
        which item of a mission it rejects; whether it says three times that one is reached.
    low_battery_at_s, silent_at_s, breach_at_s, breach_text_at_s, pilot_at_s, disarm_at_s
        when, in seconds after it was armed, its battery falls to 10 %, it is heard no more, it leaves its fence (and
        says so by FENCE_STATUS, or by STATUSTEXT alone), a pilot takes it over, its motors stop.
    late_heartbeats_s, late_by_s
        when, in seconds after it was armed, heartbeats begin to be late: those of the next `late_by_s` seconds come at
        their end.
    """

    loss: float = 0.0
    refuse_arm: bool = False
    refuse_start: bool = False
    mute: bool = False
    slow_arm_s: float = 0.0
    reject_item: int | None = None
    repeat_reached: bool = False
    low_battery_at_s: float | None = None
    silent_at_s: float | None = None
    breach_at_s: float | None = None
    breach_text_at_s: float | None = None
    pilot_at_s: float | None = None
    disarm_at_s: float | None = None
    late_heartbeats_s: float | None = None
    late_by_s: float = 7.0
