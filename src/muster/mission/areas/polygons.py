"""What is wrong with a polygon, in words; by Shapely (extra `map`)."""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import shapely

_SIMPLE = "a polygon whose sides meet at its corners alone"


def polygon_fault(corners: Sequence[Sequence[float]], farthest_m: float) -> tuple[str, str] | None:
    """What is wrong with the polygon of these corners, metres, and what was expected; None where nothing is."""
    import shapely

    far = max(abs(c) for corner in corners for c in corner)
    if far > farthest_m:
        return f"a polygon that reaches {far:g} m", f"coordinates up to {farthest_m:g} m"
    wrong = _trouble(shapely.Polygon(corners))
    return None if wrong is None else (wrong, _SIMPLE)


def _trouble(polygon: shapely.Polygon) -> str | None:
    """What is wrong with a polygon, and where; None where nothing is."""
    import shapely

    if polygon.is_valid and polygon.area > 0:
        return None
    reason = str(shapely.is_valid_reason(polygon))
    where = re.fullmatch(r"(?P<what>.*)\[(?P<x>\S+) (?P<y>\S+)\]", reason)
    if polygon.area == 0 and (where is None or polygon.minimum_rotated_rectangle.area == 0):
        return "corners on one line"
    if where is None:
        return reason
    what = "touches itself" if where["what"].startswith("Ring") else "crosses itself"
    return f"{what} at ({float(where['x']):g}, {float(where['y']):g})"
