"""Space-time A*: paths of several robots that share a grid, without contact ([silver2005], cooperative A*).

Robots are planned one after another. In a step of time each moves to a neighbour among eight, or waits. What those
before have reserved is taken: no two are in a cell at once, exchange their cells, or cross each other's diagonal. The
heuristic is the length of the shortest path without others, so that the first path found costs least. The search of one
robot is complete. Planning in an order is not: the first takes its shortest path even where only its waiting would let
another pass. On failure other orders are tried.

With a window ([silver2005], WHCA*) a robot looks at the others for so many steps only; all go half a window, and plan
again in another order.
"""

from __future__ import annotations

import heapq
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Bools
from muster.mission.values.ranges import require_counts
from muster.traffic.reservations import Cell, Reservations

Ways = dict[str, list[Cell]]
"""The cells of each robot, one a step."""
_SIDES = ((0, 1), (1, 0), (0, -1), (-1, 0))
_CORNERS = ((1, 1), (1, -1), (-1, 1), (-1, -1))
_WAITING = (0, 0)


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`neighbours`: 4 or 8. `window`: steps for which others are looked at, None for all. `orders`: tried at most.

    `steps`: the longest plan; None for eight times the free cells.
    """

    neighbours: int = 8
    window: int | None = None
    orders: int = 20
    steps: int | None = None

    def __post_init__(self) -> None:
        if self.neighbours not in (4, 8):
            raise ParameterError(f"neighbours: {self.neighbours}; expected 4 or 8")
        require_counts(2, window=self.window)
        require_counts(1, orders=self.orders, steps=self.steps)


@dataclass(frozen=True)
class NotTogether:
    """Why there are no paths for all: the robot without one, and the reason."""

    robot: str
    reason: str


class Lattice:
    """A grid of cells, with the moves from each."""

    def __init__(self, blocked: Bools, neighbours: int) -> None:
        self.blocked = blocked
        self._moves = _SIDES if neighbours == 4 else _SIDES + _CORNERS

    @property
    def free_cells(self) -> int:
        return int((~self.blocked).sum())

    def free(self, cell: Cell) -> bool:
        rows, columns = self.blocked.shape
        return 0 <= cell[0] < rows and 0 <= cell[1] < columns and not self.blocked[cell]

    def around(self, cell: Cell) -> list[tuple[Cell, float]]:
        """The neighbours of a cell with their distances; no corner of a blocked cell is cut."""
        found = []
        for down, right in self._moves:
            there = (cell[0] + down, cell[1] + right)
            if not self.free(there):
                continue
            if down and right and not (self.free((cell[0], there[1])) and self.free((there[0], cell[1]))):
                continue
            found.append((there, math.hypot(down, right)))
        return found

    def lengths(self, goal: Cell) -> dict[Cell, float]:
        """The length of the shortest path to a goal from each cell that has one."""
        found: dict[Cell, float] = {}
        open_: list[tuple[float, Cell]] = [(0.0, goal)]
        while open_:
            length, cell = heapq.heappop(open_)
            if cell in found:
                continue
            found[cell] = length
            for there, step in self.around(cell):
                if there not in found:
                    heapq.heappush(open_, (length + step, there))
        return found


def together(
    blocked: Bools, ends: Mapping[str, tuple[Cell, Cell]], *, seed: int = 0, params: Parameters | None = None
) -> Ways | NotTogether:
    """Paths without contact for robots with a start and a goal each, as cells by step; the same for the same seed.

    Parameters
    ----------
    blocked
        (rows, columns).
    ends
        start and goal of each robot, (row, column). Robots stay at their goals.

    Returns
    -------
    The cells of each robot, one a step, all for as many steps; or who has no path.

    Raises
    ------
    ParameterError
        if two robots have one start or one goal.
    """
    params = params or Parameters()
    lattice = Lattice(np.asarray(blocked, dtype=np.bool_), params.neighbours)
    for k, what in enumerate(("start", "goal")):
        cells = [pair[k] for pair in ends.values()]
        if len(set(cells)) < len(cells):
            raise ParameterError(f"ends: two robots with one {what}; expected a cell of its own for each")
    lengths = {robot: lattice.lengths(goal) for robot, (_, goal) in ends.items()}
    for robot, (start, goal) in ends.items():
        if not (lattice.free(start) and lattice.free(goal)):
            return NotTogether(robot, "its start or goal is blocked")
        if start not in lengths[robot]:
            return NotTogether(robot, "its goal is not connected with its start")
    plan = _in_windows if params.window else _in_orders
    return plan(lattice, ends, lengths, np.random.default_rng(seed), params)


_Lengths = Mapping[str, Mapping[Cell, float]]


def _in_orders(
    lattice: Lattice,
    ends: Mapping[str, tuple[Cell, Cell]],
    lengths: _Lengths,
    random: np.random.Generator,
    params: Parameters,
) -> Ways | NotTogether:
    """One order after another: first those with the longest way first, then who failed first, then by chance."""
    order = sorted(ends, key=lambda robot: (-lengths[robot][ends[robot][0]], robot))
    failed = NotTogether("", "")
    for k in range(params.orders):
        found = _in_order(lattice, ends, lengths, order, params)
        if isinstance(found, dict):
            return _filled(found)
        failed = found
        order = [str(robot) for robot in random.permutation(order)] if k % 2 else order
        order = [failed.robot, *(robot for robot in order if robot != failed.robot)]
    return NotTogether(failed.robot, f"no path past the others in {params.orders} orders; more may find one")


def _in_order(
    lattice: Lattice, ends: Mapping[str, tuple[Cell, Cell]], lengths: _Lengths, order: Sequence[str], params: Parameters
) -> Ways | NotTogether:
    reserved, found = Reservations(), Ways()
    most = params.steps or 8 * lattice.free_cells
    for robot in order:
        start, goal = ends[robot]
        way = _space_time_a_star(lattice, start, goal, lengths[robot], reserved, math.inf, most)
        if way is None:
            return NotTogether(robot, "no path past those before it")
        reserved.add(robot, way)
        found[robot] = way
    return {robot: found[robot] for robot in ends}


def _in_windows(
    lattice: Lattice,
    ends: Mapping[str, tuple[Cell, Cell]],
    lengths: _Lengths,
    random: np.random.Generator,
    params: Parameters,
) -> Ways | NotTogether:
    assert params.window
    half, most = max(1, params.window // 2), params.steps or 8 * lattice.free_cells
    ways = {robot: [start] for robot, (start, _) in ends.items()}
    order = sorted(ends, key=lambda robot: (-lengths[robot][ends[robot][0]], robot))
    while any(way[-1] != ends[robot][1] for robot, way in ways.items()):
        if len(next(iter(ways.values()))) > most:
            robot = next(robot for robot, way in ways.items() if way[-1] != ends[robot][1])
            return NotTogether(robot, f"not at its goal after {most} steps")
        parts = _window(lattice, ends, lengths, ways, order, params.window)
        if parts is None:
            order = [str(robot) for robot in random.permutation(order)]
            parts = {robot: [way[-1]] * (half + 1) for robot, way in ways.items()}  # all wait, and try another order
        for robot, part in parts.items():
            ways[robot] += (part + part[-1:] * half)[1 : half + 1]
        order = [*order[1:], order[0]]
    return _filled(ways)


def _window(
    lattice: Lattice,
    ends: Mapping[str, tuple[Cell, Cell]],
    lengths: _Lengths,
    ways: Ways,
    order: Sequence[str],
    window: int,
) -> Ways | None:
    """The next steps of all, without contact within the window; None where the order leaves somebody no way."""
    reserved, parts = Reservations(), Ways()
    for robot in order:
        part = _space_time_a_star(lattice, ways[robot][-1], ends[robot][1], lengths[robot], reserved, window, window)
        if part is None:
            return None
        part = (part + part[-1:] * (window + 1))[: window + 1]
        reserved.add(robot, part, stays=False)
        parts[robot] = part
    return parts


def _space_time_a_star(
    lattice: Lattice,
    start: Cell,
    goal: Cell,
    lengths: Mapping[Cell, float],
    reserved: Reservations,
    window: float,
    most: int,
) -> list[Cell] | None:
    """The way of one robot, cell by step, past what is reserved: to its goal for good, or to the end of the window.

    Costs are the time, a diagonal as long as it is and waiting as long as a side, except at the goal.
    """
    stays_from = reserved.free_from(goal)
    open_: list[tuple[float, float, Cell, int]] = [(lengths[start], lengths[start], start, 0)]
    before: dict[tuple[Cell, int], Cell | None] = {(start, 0): None}
    costs = {(start, 0): 0.0}
    done = set()
    while open_:
        _, _, cell, step = heapq.heappop(open_)
        if (cell, step) in done:
            continue
        done.add((cell, step))
        if step >= window or (math.isinf(window) and cell == goal and step >= stays_from):
            return _back(before, cell, step)
        if step >= most:
            continue
        waiting = (cell, 0.0 if cell == goal else 1.0)
        for there, length in (*lattice.around(cell), waiting):
            if not reserved.allows((cell, there, step)):
                continue
            cost, state = costs[cell, step] + length, (there, step + 1)
            if cost < costs.get(state, math.inf):
                costs[state], before[state] = cost, cell
                heapq.heappush(open_, (cost + lengths[there], lengths[there], there, step + 1))
    return None


def _back(before: Mapping[tuple[Cell, int], Cell | None], cell: Cell, step: int) -> list[Cell]:
    way = [cell]
    while (last := before[cell, step]) is not None:
        cell, step = last, step - 1
        way.append(cell)
    return way[::-1]


def _filled(ways: Ways) -> Ways:
    """All as long as the longest, and not longer than until the last is at its goal."""
    steps = max((len(way) for way in ways.values()), default=0)
    while steps > 1 and all(len(way) < steps or way[steps - 1] == way[steps - 2] for way in ways.values()):
        steps -= 1
    return {robot: (way + way[-1:] * steps)[:steps] for robot, way in ways.items()}
