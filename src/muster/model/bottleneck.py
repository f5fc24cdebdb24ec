"""The least time at which different robots can fill all places: a bottleneck assignment."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.mission.values.arrays import Bools, Floats


def bottleneck(times: Floats) -> float:
    """The least of the largest times over all ways to give each row (a place) its own column (a robot).

    `times` is (places, robots), inf where a robot does not fit; inf where not all places can be filled.
    """
    if len(times) == 1:
        return float(times[0].min(initial=np.inf))
    values = np.unique(times[np.isfinite(times)])
    low, high = 0, len(values)
    while low < high:
        middle = (low + high) // 2
        if fills(times <= values[middle]):
            high = middle
        else:
            low = middle + 1
    return float(values[low]) if low < len(values) else float("inf")


def fills(fits: Bools) -> bool:
    """Whether each row can have a column of its own where it is true."""
    return len(matched(fits)) == len(fits)


def matched(fits: Bools) -> dict[int, int]:
    """A largest matching of rows and columns, by augmenting paths: column -> row."""
    columns = [np.flatnonzero(row).tolist() for row in fits]
    owner: dict[int, int] = {}
    for row in range(len(fits)):
        _augment(columns, owner, row, set())
    return owner


def _augment(columns: Sequence[Sequence[int]], owner: dict[int, int], row: int, seen: set[int]) -> bool:
    for column in columns[row]:
        if column not in seen:
            seen.add(column)
            if column not in owner or _augment(columns, owner, owner[column], seen):
                owner[column] = row
                return True
    return False


def on_some_matching(fits: Bools) -> Bools:
    """(rows, columns) the pairs that are in some matching that fills all rows."""
    if (fits.sum(axis=1) >= len(fits)).all():
        return fits  # whatever one row takes, the others have enough left
    usable = np.zeros_like(fits)
    if not fills(fits):
        return usable
    for row, column in zip(*np.nonzero(fits), strict=True):
        if not usable[row, column]:
            rest = np.delete(np.delete(fits, row, axis=0), column, axis=1)
            usable[row, column] = fills(rest)
    return usable


def kth_least(values: Floats, counts: Sequence[int]) -> Floats:
    """(n,) of each column of (m, n) the least value that so many are not above; inf where there are not so many."""
    ordered = np.sort(np.vstack([values, np.full(values.shape[1], math.inf)]), axis=0)
    return np.asarray(ordered[[min(k, len(values) + 1) - 1 for k in counts], np.arange(values.shape[1])])
