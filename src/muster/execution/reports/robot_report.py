"""What one robot used, and did at stations, in the report of a mission carried out."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class StationAccount:
    """What one robot did at stations.

    Parameters
    ----------
    least_share
        the least share of its energy that was left; None: usage does not empty it.
    added
        what it got, in the unit of usage.
    visits, waited_s
        how often it was served, and for how long it waited for slots.
    """

    least_share: float | None
    added: float
    visits: int
    waited_s: float


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

    @classmethod
    def of(cls, robot: str, planned: float, flown: float, left: float | None, at: StationAccount | None) -> RobotReport:
        """Return the row of a robot with a share of its energy left, None: not known; None of stations: no account."""
        if at is None:
            return cls(robot, planned, flown, left)
        return cls(robot, planned, flown, left, at.least_share, at.added, at.visits, at.waited_s)
