"""Whether a stated figure agrees with the recomputed one."""

from __future__ import annotations

import math

RELATIVE_TOLERANCE = 1e-6
ABSOLUTE_TOLERANCE = 1e-9


def agrees(
    stated: float | str | None,
    found: float | str | None,
    relative: float = RELATIVE_TOLERANCE,
    absolute: float = ABSOLUTE_TOLERANCE,
) -> bool:
    """Whether a figure, if stated, is right: numbers to the tolerances, counts and words exactly."""
    if stated is None:
        return True
    if isinstance(stated, float | int) and isinstance(found, float):
        return math.isclose(stated, found, rel_tol=relative, abs_tol=absolute)
    return stated == found
