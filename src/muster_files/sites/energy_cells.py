"""How long and how far robots go, in cells: never a number without a unit."""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from datetime import time, timedelta

from muster_files.sites.cells import CellError, above_0, duration, is_bare_number, number

COLUMNS = "Endurance (min), Range (km), or a unit beside the number: 28 min, 5 km"
"""What says how much energy a robot has."""
_EXPECTED = (
    "how long or how far it carries the robot, with a unit: a column Endurance (min) or Range (km), "
    "or 28 min or 5 km in the cell; not a number alone, mAh, Wh or %"
)


def no_capacity(value: object) -> float:
    """Refuse a capacity that does not say of what."""
    raise CellError("load_capacity for what it carries (kg or pieces), Endurance (min) or Range (km) for its energy")


def endurance(value: object, factor: float = 1.0) -> float:
    """Seconds that a robot can be under way; a number needs a unit."""
    return _read(lambda given: duration(given, factor), value, factor)


def range_of(value: object, factor: float = 1.0) -> float:
    """Metres that a robot can go; a number needs a unit."""
    return _read(lambda given: number(given, "length", factor), value, factor)


def battery(value: object) -> dict[str, float]:
    """How long or how far a battery carries a robot, by the unit beside the number: `28 min`, `5 km`."""
    if isinstance(value, str | time | timedelta):
        for key, read in (("endurance_s", endurance), ("range_m", range_of)):
            with suppress(CellError):
                return {key: read(value, math.nan)}
    raise CellError(_EXPECTED)


def _read(read: Callable[[object], float], value: object, factor: float) -> float:
    """The number of a cell; refused where nothing gives it a unit, or another one."""
    if math.isnan(factor) and is_bare_number(value):
        raise CellError(_EXPECTED)
    try:
        found = read(value)
    except CellError:
        raise CellError(_EXPECTED) from None
    return above_0(found)
