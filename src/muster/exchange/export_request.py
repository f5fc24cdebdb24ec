"""The formats of exported plans, their options, and the resulting files, as data; exporters are loaded when used."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, TypedDict

from muster.mission.errors import ParameterError
from muster.mission.plugins import Registry

if TYPE_CHECKING:
    from muster.mission.model import Mission
    from muster.verification import Verdict


@dataclass(frozen=True)
class Files:
    """Texts by the names of their files, and messages for the user."""

    texts: Mapping[str, str]
    messages: tuple[str, ...] = ()


@dataclass(frozen=True)
class QgcOptions:
    """The options of QGroundControl's plan files.

    Parameters
    ----------
    altitude
        least height above the start, metres; needed for drones of a mission in the plane.
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


class QgcKeywords(TypedDict, total=False):
    """The options of `QgcOptions`, for type checkers."""

    altitude: float | None
    clearance: float
    tolerance: float
    firmware: str


Exporter = Callable[["Mission", "Verdict"], "str | Files"]
"""Writes an admissible plan as the text of one file, or as several files."""


def _checked(name: str, found: object) -> Exporter:
    if not callable(found):
        raise ParameterError(f"it is a {type(found).__name__}; expected a function of a mission and a verdict")
    return found


FORMATS: Registry[Exporter] = Registry(
    "format",
    "muster.formats",
    {
        "qgc": "muster.exchange.files:plan_files",
        "geojson": "muster.exchange.files:geojson_file",
        "gpx": "muster.exchange.files:gpx_file",
        "kml": "muster.exchange.files:kml_file",
        "csv": "muster.exchange.files:csv_file",
        "sol": "muster.exchange.files:sol_file",
    },
    _checked,
)
"""By name, those of installed packages included."""
