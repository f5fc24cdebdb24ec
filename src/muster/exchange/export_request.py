"""The formats of exported plans, their options, and the files that come out: data, without what makes the files."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

FORMATS = ("qgc", "geojson", "gpx", "kml", "csv")


@dataclass(frozen=True)
class Files:
    """Texts by the names of their files, and what a person has to know of them."""

    texts: Mapping[str, str]
    messages: tuple[str, ...] = ()


@dataclass(frozen=True)
class QgcOptions:
    """The options of QGroundControl's plan files.

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
