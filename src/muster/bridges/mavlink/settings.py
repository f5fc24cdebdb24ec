"""Settings of flights: what Muster may command, and its limits."""

from __future__ import annotations

from dataclasses import dataclass, fields
from typing import Literal

from muster.mission.errors import ParameterError


@dataclass(frozen=True, kw_only=True)
class Settings:
    """Of one fleet.

    Parameters
    ----------
    arm
        whether Muster may arm, and fly. Without it nothing is sent but heartbeats and requests for telemetry.
    offboard
        fly by way points that are said one by one (PX4: offboard, ArduPilot: guided) instead of uploaded missions.
    local_frame
        of way points that are said one by one without an origin on Earth: what the drone calls `north` is north, or
        where it looked `forward` when it was switched on, without a compass.
    lowest_m
        height above home below which no way point is flown; lower ones are flown there.
    accept_m
        how near to a way point counts as there.
    low_battery
        share of the battery at which a drone takes no part any more.
    link_lost_s
        seconds without a heartbeat after which the link counts as lost.
    far_m
        how far from its start in the mission a drone may stand.
    """

    arm: bool = False
    offboard: bool = False
    local_frame: Literal["north", "forward"] = "north"
    lowest_m: float = 2.0
    accept_m: float = 1.0
    low_battery: float = 0.25
    link_lost_s: float = 5.0
    far_m: float = 20.0

    def __post_init__(self) -> None:
        if self.local_frame not in ("north", "forward"):
            raise ParameterError(f"local_frame: {self.local_frame}; expected north or forward")
        for field in fields(self)[3:]:
            if not getattr(self, field.name) > 0:
                raise ParameterError(f"{field.name}: {getattr(self, field.name)}; expected a number above 0")
        if self.low_battery >= 1:
            raise ParameterError(f"low_battery: {self.low_battery}; expected a share below 1")
