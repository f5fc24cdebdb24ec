"""Reservations: which robot has which cell of a grid in which step of time."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

Cell = tuple[int, int]
"""Row and column."""
Move = tuple[Cell, Cell, int]
"""From a cell to another, beginning at a step; one that waits stays in its cell."""


@dataclass
class Reservations:
    """Cells by step, moves by the step in which they begin, and cells that robots keep from a step on."""

    _cells: dict[tuple[Cell, int], str] = field(default_factory=dict)
    _moves: dict[Move, str] = field(default_factory=dict)
    _kept: dict[Cell, int] = field(default_factory=dict)
    _last: dict[Cell, int] = field(default_factory=dict)

    def add(self, robot: str, way: list[Cell], first: int = 0, *, stays: bool = True) -> None:
        """Reserve a way, one cell a step from step `first` on; with `stays` its last cell from then on."""
        for k, cell in enumerate(way):
            self._cells[cell, first + k] = robot
            self._last[cell] = max(first + k, self._last.get(cell, 0))
            if k + 1 < len(way):
                self._moves[cell, way[k + 1], first + k] = robot
        if stays:
            self._kept[way[-1]] = first + len(way) - 1

    def allows(self, move: Move) -> bool:
        """Whether a move leads into a cell that is free then, without an exchange and without crossing a diagonal."""
        here, there, step = move
        if (there, step + 1) in self._cells or self._kept.get(there, math.inf) <= step + 1:
            return False
        if (there, here, step) in self._moves:
            return False
        if here[0] == there[0] or here[1] == there[1]:
            return True
        one, other = (here[0], there[1]), (there[0], here[1])
        return (one, other, step) not in self._moves and (other, one, step) not in self._moves

    def free_from(self, cell: Cell) -> float:
        """The first step from which nobody else is in a cell any more; inf where one stays."""
        return math.inf if cell in self._kept else self._last.get(cell, -1) + 1
