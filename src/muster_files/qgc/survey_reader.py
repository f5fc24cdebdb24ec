"""Survey items of plan files as areas to cover: polygon, height, direction of the lanes, and camera or width.

How lanes are flown (turns beyond the area, entry, pictures in turns) is left out, since Muster plans them anew.
Source: QGroundControl developer guide, "Plan File Format", survey: lengths in metres, `angle` clockwise from north.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

from muster.mission.import_ledger import passed_over
from muster.mission.place_types import Corners
from muster.mission.robots import MOST_PIXELS
from muster_files.qgc import plan_format as qgc
from muster_files.qgc.fields import PlanFields, is_number
from muster_files.tracked_json import Tracked

_LENS_KEYS = ("SensorWidth", "SensorHeight", "FocalLength", "ImageWidth", "ImageHeight")
_LEAST_CORNERS = Corners().minimum
_LEFT_OUT = {"Refly90Degrees": "a second survey for the lanes across", "FollowTerrain": "heights above home"}

_OF_LANES = (
    *("Items", "CameraShots", "TurnAroundDistance", "CameraTriggerInTurnAround", "HoverAndCapture"),
    *("entryLocation", "flyAlternateTransects", "splitConcavePolygons", "AdjustedFootprintFrontal", "CameraName"),
    *("FixedOrientation", "ImageDensity", "MinTriggerInterval", "ValueSetIsDistance"),
)
_PLANNED = passed_over("is how QGroundControl flies the lanes: Muster plans them anew", minor=True)


@dataclass(frozen=True)
class Lens:
    """What a survey says of its camera, which looks straight down."""

    fov_deg: float
    """Across the lanes."""
    pixels: tuple[int, int]
    """Across and along the lanes."""
    overlap: float
    front_overlap: float

    def camera(self) -> dict[str, Any]:
        """The camera, as a mission file has it: with fewer pixels where cameras of missions may not have as many."""
        shrunk = max(1.0, *(own / most for own, most in zip(self.pixels, MOST_PIXELS, strict=True)))
        across, along = (round(own / shrunk) for own in self.pixels)
        return {"fov_deg": self.fov_deg, "tilt_deg": 90, "width_px": across, "height_px": along}


@dataclass(frozen=True)
class Survey:
    """One survey item."""

    number: int
    corners: tuple[tuple[float, float], ...]
    """In degrees."""
    height_m: float
    """Above home."""
    heading_deg: float
    """Of the lanes, anticlockwise from east."""
    width_m: float
    """From lane to lane."""
    ends_at: tuple[float, float] | None
    """The last way point over the area, in degrees; None where the file does not say."""
    lens: Lens | None

    def action(self, area: list[list[float]]) -> dict[str, Any]:
        """The action `coverage` of a mission file, over the polygon in metres."""
        seen: dict[str, Any] = {"width_m": self.width_m}
        if self.lens is not None:
            lens = self.lens
            seen = {"fov_deg": lens.fov_deg, "overlap": lens.overlap, "front_overlap": lens.front_overlap}
        return {"name": "coverage", "area": area, "height_m": self.height_m, "heading_deg": self.heading_deg} | seen


def read_survey(fields: PlanFields, item: Tracked, at: str, number: int) -> Survey:
    """The survey of a complex item.

    Raises
    ------
    MissionError
        if a field is wrong, or says what an area to cover cannot: lanes both ways, heights above the terrain.
    """
    at_inner = f"{at}.TransectStyleComplexItem"
    inner = fields.of(item, "TransectStyleComplexItem", Tracked, "a mapping", at_inner)
    fields.require_version(item, at, 3, 4, 5)
    fields.require_version(inner, at_inner, 1, 2)
    for key, instead in _LEFT_OUT.items():
        if inner.get(key):
            raise fields.refused(f"{at_inner}.{key}", inner[key], f"false, and {instead}")
    at_calc = f"{at_inner}.CameraCalc"
    calc = fields.of(inner, "CameraCalc", Tracked, "a mapping", at_calc)
    fields.require_version(calc, at_calc, 1, 2)
    flown = fields.corners(inner, "VisualTransectPoints", f"{at_inner}.VisualTransectPoints")
    if calc.get("DistanceMode", qgc.RELATIVE_TO_HOME) != qgc.RELATIVE_TO_HOME:
        raise fields.refused(f"{at_calc}.DistanceMode", calc["DistanceMode"], "1: heights above home")
    angle = item.get("angle")
    if not is_number(angle):
        raise fields.refused(f"{at}.angle", angle, "degrees clockwise from north")
    corners = fields.corners(item, "polygon", f"{at}.polygon")
    if len(corners) < _LEAST_CORNERS:
        raise fields.refused(f"{at}.polygon", item["polygon"], f"at least {_LEAST_CORNERS} corners")
    for part in (item, inner, calc):
        part.say(_PLANNED, *_OF_LANES)
    return Survey(
        number=number,
        corners=corners,
        height_m=fields.positive(calc, "DistanceToSurface", "metres above 0", f"{at_calc}.DistanceToSurface"),
        heading_deg=(90.0 - angle) % 180.0,
        width_m=fields.positive(calc, "AdjustedFootprintSide", "metres above 0", f"{at_calc}.AdjustedFootprintSide"),
        ends_at=flown[-1] if flown else None,
        lens=_lens(fields, calc, at_calc),
    )


def _lens(fields: PlanFields, calc: dict[str, Any], at: str) -> Lens | None:
    """The camera; None where a survey has only a distance between lanes."""
    if not any(key in calc for key in _LENS_KEYS):
        return None
    wide, high, focal, columns, rows = (
        fields.positive(calc, key, "a number above 0", f"{at}.{key}") for key in _LENS_KEYS
    )
    across, pixels = (wide, (columns, rows)) if calc.get("Landscape", True) else (high, (rows, columns))
    overlaps = [_share(fields, calc, key, f"{at}.{key}") for key in ("SideOverlap", "FrontalOverlap")]
    return Lens(math.degrees(2 * math.atan(across / (2 * focal))), (round(pixels[0]), round(pixels[1])), *overlaps)


def _share(fields: PlanFields, calc: dict[str, Any], key: str, at: str) -> float:
    percent = calc.get(key)
    if not is_number(percent) or not 0 <= percent < 100:
        raise fields.refused(at, percent, "percent, from 0 to below 100")
    return percent / 100
