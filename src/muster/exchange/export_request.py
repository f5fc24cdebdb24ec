"""What can be asked for of a plan as files of other tools: as data, for faces that do not load what makes them."""

from __future__ import annotations

from dataclasses import dataclass

FORMATS = ("qgc", "geojson", "gpx", "kml", "csv")


@dataclass(frozen=True)
class Wishes:
    """What can be asked for of QGroundControl's plan files.

    Parameters
    ----------
    altitude
        fly no lower than so many metres above the start; needed for drones of a mission in the plane.
    clearance
        metres; a warning where bodies come nearer to each other.
    tolerance
        metres; around corners of a map way points are joined, no farther than this from the way; 0 keeps all.
    firmware
        `px4` or `ardupilot`.
    """

    altitude: float | None = None
    clearance: float = 0.0
    tolerance: float = 0.1
    firmware: str = "px4"
