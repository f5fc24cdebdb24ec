"""Events of ground that robots explore: their map grows."""

from __future__ import annotations

from dataclasses import field
from typing import TYPE_CHECKING

from muster.state import words
from muster.state.event import ExecutionEvent, happens
from muster.state.explored_map import UNSEEN, ExploredMap

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState


@happens("ground_unknown", "robots have no map, and plan by what they see, in cells of {cell_m} m", mark=words.CHANGE)
class GroundUnknown(ExecutionEvent):
    """Robots begin without a map, and build one of such cells: the plan may count on what they do not know."""

    cell_m: float

    def change(self, state: MissionState) -> None:
        state.explored = None


@happens("map_grows", words.map_grows, mark=words.DETAIL)
class MapGrows(ExecutionEvent):
    """Robots have seen ground that they did not know.

    `size` is (rows, columns) of the map, `runs` are the cells that changed: row, first column, how many, and what they
    are now.
    """

    cell_m: float
    origin: tuple[float, float, float]
    size: tuple[int, int]
    runs: tuple[tuple[int, int, int, int], ...] = field(default_factory=tuple)
    explored_m2: float = 0.0

    def change(self, state: MissionState) -> None:
        if state.explored is None:
            rows, columns = self.size
            state.explored = ExploredMap(self.cell_m, self.origin, [[UNSEEN] * columns for _ in range(rows)])
        for row, first, count, value in self.runs:
            state.explored.rows[row][first : first + count] = [value] * count
        state.explored.explored_m2 = self.explored_m2
