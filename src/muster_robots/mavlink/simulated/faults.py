"""The configurable faults of a simulated drone."""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True, kw_only=True)
class Faults:
    """Faults of one flight. Fields `*_at_s` are seconds after the drone was armed first, fields `*_for_s` durations.

    Parameters
    ----------
    loss : float
        Share of packets that are lost, both ways.
    refuse_arm, refuse_start, mute : bool
        The drone does not arm; starts no mission and follows no way points; answers no command.
    slow_arm_s : float
        Seconds from the command to arm until the drone is armed.
    reject_item : int or None
        Index of the mission item that is rejected.
    repeat_reached : bool
        Every item that is reached is reported three times.
    silent_at_s, silent_for_s : float
        The link is interrupted, both ways.
    mute_at_s, mute_for_s : float
        Commands do not arrive, while telemetry does.
    late_heartbeats_s, late_by_s : float
        Heartbeats of the next `late_by_s` seconds arrive at the end of these; other telemetry arrives in time.
    frozen_at_s, frozen_for_s : float
        The process of the autopilot stands still. It handles the packets that have arrived when it goes on, and a
        failsafe is on for `FLASH_S`; then PX4 resumes the mission.
    gps_lost_at_s, gps_lost_for_s : float
        The position is not known: the drone descends, and lands if that lasts.
    no_position_at_s, no_position_for_s : float
        The drone says nothing of its position, and flies on.
    low_battery_at_s, low_battery_for_s, low_battery : float
        The battery reports the share `low_battery`.
    breach_at_s, breach_text_at_s, breach_for_s : float
        The drone leaves the autopilot's fence, and says so by FENCE_STATUS, or by STATUSTEXT alone.
    fence_m, first_item_m : float or None
        Distance from home beyond which a mission is refused (PX4: GF_MAX_HOR_DIST); the same of its first way point
        (PX4: MIS_DIST_1WP).
    mute_parameters : bool
        Requests for parameters are not answered: a drone says at the start of a mission what it refuses.
    pilot_at_s, pilot_for_s : float
        A pilot takes over by a stick mode, and leaves the drone in the hold mode afterwards.
    no_sticks : bool
        The stick mode is set without sticks: the autopilot falls to its hold mode (PX4).
    rtl_at_s : float
        Another station commands the return.
    disarm_at_s : float
        The motors stop: the drone falls.
    """

    loss: float = 0.0
    refuse_arm: bool = False
    refuse_start: bool = False
    mute: bool = False
    slow_arm_s: float = 0.0
    reject_item: int | None = None
    repeat_reached: bool = False
    silent_at_s: float | None = None
    silent_for_s: float = math.inf
    mute_at_s: float | None = None
    mute_for_s: float = math.inf
    late_heartbeats_s: float | None = None
    late_by_s: float = 7.0
    frozen_at_s: float | None = None
    frozen_for_s: float = 8.0
    gps_lost_at_s: float | None = None
    gps_lost_for_s: float = math.inf
    no_position_at_s: float | None = None
    no_position_for_s: float = math.inf
    low_battery_at_s: float | None = None
    low_battery_for_s: float = math.inf
    low_battery: float = 0.1
    breach_at_s: float | None = None
    breach_text_at_s: float | None = None
    breach_for_s: float = math.inf
    mute_parameters: bool = False
    fence_m: float | None = None
    first_item_m: float | None = None
    pilot_at_s: float | None = None
    pilot_for_s: float = math.inf
    no_sticks: bool = False
    rtl_at_s: float | None = None
    disarm_at_s: float | None = None
