"""The map that robots of a run have built, as it is known of the run: in cells wide enough to be shown."""

from __future__ import annotations

from dataclasses import dataclass

UNSEEN, FREE, OBSTACLE = 0, 1, 2
"""What a cell of an explored map is."""


@dataclass
class ExploredMap:
    """The map that robots have built by now, in cells that are wide enough to be shown.

    Parameters
    ----------
    cell_m, origin
        Side of a cell; x, y in metres and yaw in radians of the outer corner of cell (0, 0).
    rows
        For each row, the lowest first, what its cells are: `UNSEEN`, `FREE` or `OBSTACLE`.
    explored_m2
        How large the ground is that was seen to be free.
    """

    cell_m: float
    origin: tuple[float, float, float]
    rows: list[list[int]]
    explored_m2: float = 0.0
