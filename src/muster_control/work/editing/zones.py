"""Adds zones that are drawn on a map to a mission's text, with the map that they need."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import Any

from muster_control.work.editing.edits import EditError, append, data_of, set_value

KINDS = ("ground", "air")
_MARGIN_M = 5.0  # around everything, of a boundary that is made because a zone needs a map

Corner = Sequence[float]


def add_zone(
    text: str,
    corners: Sequence[Corner],
    floor: float | None = None,
    ceiling: float | None = None,
    forbidden_to: Sequence[str] = KINDS,
) -> str:
    """Put a zone into a mission; heights in metres, None without an end.

    A mission without a map gets a boundary around everything: a map has to be one of a boundary, an image, a ROS map.

    Raises
    ------
    EditError
        if it has too few corners, its floor is not below its ceiling, or nobody is kept out.
    """
    if len(corners) < 3:
        raise EditError(f"a zone of {len(corners)} corners; expected at least 3")
    if floor is not None and ceiling is not None and floor >= ceiling:
        raise EditError(f"floor_m: {floor:g}; expected a number below ceiling_m ({ceiling:g})")
    if not forbidden_to:
        raise EditError("forbidden_to: nobody; expected ground, air, or both")
    zone: dict[str, Any] = {"polygon": [[_neat(x), _neat(y)] for x, y in corners]}
    zone |= {key: value for key, value in (("floor_m", floor), ("ceiling_m", ceiling)) if value is not None}
    if set(forbidden_to) != set(KINDS):
        zone["forbidden_to"] = list(forbidden_to)
    data = data_of(text)
    if data.get("map"):
        return append(text, ("map", "zones"), zone)
    return set_value(text, ("map",), {"boundary": _around(corners, data), "zones": [zone]})


def _around(corners: Iterable[Corner], data: Mapping[str, Any]) -> list[list[float]]:
    items = [*(data.get("robots") or []), *(data.get("tasks") or []), *(data.get("stations") or [])]
    places = [item["position"] for item in items if isinstance(item, dict) and isinstance(item.get("position"), list)]
    points = [*corners, *(place[:2] for place in places)]
    west, south = (_neat(min(float(point[k]) for point in points) // 1 - _MARGIN_M) for k in (0, 1))
    east, north = (_neat(max(float(point[k]) for point in points) // 1 + 1 + _MARGIN_M) for k in (0, 1))
    return [[west, south], [east, south], [east, north], [west, north]]


def _neat(metres: float) -> float:
    """To centimetres, and whole numbers as such."""
    value = round(float(metres), 2)
    return int(value) if value.is_integer() else value
