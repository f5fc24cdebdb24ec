"""What one robot used, and did at stations, in the report of a mission carried out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class RobotReport:
    """Usage of one robot in the mission's unit: of the plan that it began with, and measured. 0 planned: it joined.

    `charge` is the share of its battery that was left at last; None where it has none that reports. `least_charge` is
    the least share, `charged` what was added at stations, in the mission's unit, `station_visits` how often it was
    served there, and `slot_wait_s` for how long it waited for that; None and 0 of a robot that does not charge.
    """

    robot: str
    usage_planned: float
    usage_flown: float
    charge: float | None = None
    least_charge: float | None = None
    charged: float = 0.0
    station_visits: int = 0
    slot_wait_s: float = 0.0
