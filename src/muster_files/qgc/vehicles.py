"""The vehicles of plan files (MAV_TYPE): where they move, and which speed of the plan is theirs.

Source: MAVLink, `common.xml`; QGroundControl developer guide, "Plan File Format": `hoverSpeed` is of multi-rotors,
`cruiseSpeed` of fixed wings, rovers and boats.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from muster_files.qgc import plan_format as qgc

_HOVER, _CRUISE = ("hoverSpeed",), ("cruiseSpeed",)


@dataclass(frozen=True)
class Vehicle:
    """A type of vehicle: where it moves, its speeds in a plan, of which the slowest is taken, and what is not kept."""

    kind: Literal["ground", "air"]
    speeds: tuple[str, ...]
    note: str = ""


_WINGED = "a fixed wing: here it stops at every stop, and flies straight between them"
_VTOL = "a VTOL: here it stops at every stop, at the slower of hoverSpeed and cruiseSpeed"
VEHICLES = {
    **dict.fromkeys((0, qgc.QUADROTOR, 3, 4, 13, 14, 15, 29, 35, 43), Vehicle("air", _HOVER)),
    1: Vehicle("air", _CRUISE, _WINGED),
    **dict.fromkeys((*range(19, 26), 47), Vehicle("air", (*_HOVER, *_CRUISE), _VTOL)),
    **dict.fromkeys((qgc.GROUND_ROVER, 11, 46), Vehicle("ground", _CRUISE)),
}
_NAMED = {5: "ANTENNA_TRACKER", 6: "GCS", 7: "AIRSHIP", 8: "FREE_BALLOON", 9: "ROCKET", 12: "SUBMARINE"}
EXPECTED = "a copter, a fixed wing, a VTOL, a rover or a boat"


def told_vehicle(number: object) -> str:
    """Return a type as errors name it: `MAV_TYPE_SUBMARINE (12)`."""
    return f"MAV_TYPE_{_NAMED[number]} ({number})" if isinstance(number, int) and number in _NAMED else str(number)
