"""The order in which lanes are driven, so that the ways between them are short.

The cells are put in order first, each begun from one of its four corners: from the nearest corner to the nearest, from
every cell in turn, then improved by moving and by turning stretches of cells, where for each order the best corners are
found by dynamic programming. Short lanes come in where they cost least.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from itertools import pairwise

import numpy as np

from muster.mission.values.arrays import Floats
from muster.motion.areas.cells import CORNERS, Cell
from muster.motion.areas.transit import Transit

_MOST_STEPS = 30_000
"""From cell to cell, in all orders that are looked at."""
_MOST_STARTS = 12
_NEAR = 6
"""Places in the order whose true cost is looked at, for each short lane."""


def tour(cells: Sequence[Cell], short: Floats, transit: Transit) -> Floats:
    """(n, 2, 2) all lanes as they are driven, one after the other: those of cells, and short ones (m, 2, 2)."""
    driven = [cells[k].begun_from(corner) for k, corner in _ordered(cells, transit)] if cells else []
    whole = np.concatenate(driven) if driven else np.empty((0, 2, 2))
    return _with_short_lanes(whole, short, transit)


def _ordered(cells: Sequence[Cell], transit: Transit) -> list[tuple[int, int]]:
    """The cells in order, each with the corner from which it is begun."""
    ends = np.array([[cell.begun_from(corner)[[0, -1], [0, 1]] for corner in range(CORNERS)] for cell in cells])
    entries, exits = ends[:, :, 0].reshape(-1, 2), ends[:, :, 1].reshape(-1, 2)
    between = transit.lengths(exits, entries).reshape(len(cells), CORNERS, len(cells), CORNERS)
    starts = np.unique(np.linspace(0, len(cells) - 1, _MOST_STARTS).round().astype(int))
    orders = [_nearest(between, int(first)) for first in starts]
    order = _improved(min(orders, key=lambda order: _best_corners(between, order)[0]), between)
    return list(zip(order, _best_corners(between, order)[1], strict=True))


def _nearest(between: Floats, first: int) -> list[int]:
    """From a cell always on to the one whose nearest corner is nearest to where the last one may end."""
    left = set(range(len(between))) - {first}
    order = [first]
    near = between.min(axis=(1, 3))
    while left:
        order.append(min(left, key=lambda k: (near[order[-1], k], k)))
        left.remove(order[-1])
    return order


def _best_corners(between: Floats, order: Sequence[int]) -> tuple[float, list[int]]:
    """The length of the ways between cells in an order, and the corners from which that is least."""
    costs, chosen = np.zeros(CORNERS), []
    for here, there in pairwise(order):
        whole = costs[:, None] + between[here, :, there, :]
        chosen.append(whole.argmin(axis=0))
        costs = whole.min(axis=0)
    corners = [int(costs.argmin())]
    for choice in reversed(chosen):
        corners.append(int(choice[corners[-1]]))
    return float(costs.min()), corners[::-1]


def _improved(order: list[int], between: Floats) -> list[int]:
    """The order with stretches moved and turned around as long as that makes it shorter."""
    best, orders = _best_corners(between, order)[0], _MOST_STEPS // len(order)
    improving = True
    while improving:
        improving = False
        for other in _neighbours(order):
            orders -= 1
            length = _best_corners(between, other)[0]
            if length < best * (1 - 1e-9):
                order, best, improving = other, length, True
                break
            if orders <= 0:
                return order
    return order


def _neighbours(order: list[int]) -> Iterator[list[int]]:
    n = len(order)
    for length in (1, 2, 3):
        for i in range(n - length + 1):
            stretch, rest = order[i : i + length], order[:i] + order[i + length :]
            for j in range(len(rest) + 1):
                if j != i:
                    yield rest[:j] + stretch + rest[j:]
    for i in range(n):
        for j in range(i + 2, n + 1):
            yield order[:i] + order[i:j][::-1] + order[j:]


def _with_short_lanes(driven: Floats, short: Floats, transit: Transit) -> Floats:
    """The lanes with each short lane where, and in the direction in which, it makes the way least longer."""
    order = list(driven)
    for lane in short:
        if not order:
            order.append(lane)
            continue
        at, turned = _cheapest_place(np.array(order), lane, transit)
        order.insert(at, turned)
    return np.array(order).reshape(-1, 2, 2)


def _cheapest_place(driven: Floats, lane: Floats, transit: Transit) -> tuple[int, Floats]:
    """Before which of the lanes, and in which direction."""
    directions = np.array([lane, lane[::-1]])
    to = np.linalg.norm(driven[None, :, 1] - directions[:, None, 0], axis=2)
    on = np.linalg.norm(driven[None, :, 0] - directions[:, None, 1], axis=2)
    gaps = np.linalg.norm(driven[1:, 0] - driven[:-1, 1], axis=1)
    straight = np.hstack([on[:, :1], to[:, :-1] + on[:, 1:] - gaps, to[:, -1:]])
    least, found = math.inf, (len(driven), lane)
    for place in np.argsort(straight, axis=None, kind="stable")[:_NEAR]:
        turn, at = divmod(int(place), len(driven) + 1)
        if straight[turn, at] >= least:
            break
        cost = _added(driven, directions[turn], at, transit)
        if cost < least:
            least, found = cost, (at, directions[turn])
    return found


def _added(driven: Floats, lane: Floats, at: int, transit: Transit) -> float:
    """By how much the way between lanes becomes longer with one more before the lane of that number."""
    if at == 0:
        return transit.length(lane[1], driven[0, 0])
    before = driven[at - 1, 1]
    if at == len(driven):
        return transit.length(before, lane[0])
    after = driven[at, 0]
    return transit.length(before, lane[0]) + transit.length(lane[1], after) - transit.length(before, after)
