"""Lengths of paths that are kept: of a table of places those alone are searched for that are not known yet.

While a mission is under way few of its places change from one table to the next: robots move, and a task comes or goes.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from muster.mission.values.arrays import Bools, Floats
from muster.motion.grid import Indices

MOST_PLACES = 512
"""Tables of more places are searched for as a whole, and of what is known as much is kept: 2 MB."""
_WHOLE = 0.5  # share of the rows from which on the half of a whole table costs less than these

Search = Callable[[Floats, Floats, int], Floats]
"""The lengths (n, m) from exits (n, d) to entries (m, d), by so many threads; of equal places half a table costs."""


class KeptLengths:
    """Lengths between places of a space in which a path has the same length in both directions.

    Parameters
    ----------
    search
        finds lengths that are not known.
    """

    def __init__(self, search: Search) -> None:
        self._search = search
        self._number: dict[tuple[float, ...], int] = {}  # of each known place its row; those used last come last
        self._table: Floats = np.empty((0, 0))  # NaN: not known

    def lengths(self, exits: Floats, entries: Floats, threads: int) -> Floats:
        """Return the lengths (n, m) from exits (n, d) to entries (m, d); inf where there is no path."""
        places, number = np.unique(np.concatenate([exits, entries]), axis=0, return_inverse=True)
        if len(places) > MOST_PLACES:
            return self._search(exits, entries, threads)
        leave, enter = np.split(number.reshape(-1), [len(exits)])
        rows = self._rows(places)
        table = self._table[np.ix_(rows, rows)]
        needed = np.zeros(table.shape, dtype=np.bool_)
        needed[np.ix_(leave, enter)] = True
        self._find(places, table, (needed | needed.T) & np.isnan(table), threads)
        self._table[np.ix_(rows, rows)] = table
        return table[np.ix_(leave, enter)]

    def _find(self, places: Floats, table: Floats, missing: Bools, threads: int) -> None:
        """Search for the missing lengths of a table, which is the same in both directions."""
        searched = _rows_that_cover(missing)
        if len(searched) > _WHOLE * len(places):
            table[:] = self._search(places, places, threads)
        elif len(searched):
            columns = np.flatnonzero(missing[searched].any(axis=0))
            found = self._search(places[searched], places[columns], threads)
            for row, metres in zip(searched.tolist(), found, strict=True):
                table[row, columns] = table[columns, row] = metres

    def _rows(self, places: Floats) -> Indices:
        """Return the rows of places, new ones included; those used longest ago make room for them."""
        names = list(map(tuple, places.tolist()))
        known = {name: self._number.pop(name) for name in names if name in self._number}
        others = list(self._number.items())
        if len(others) + len(names) > MOST_PLACES:
            others = others[max(0, len(others) - (MOST_PLACES - len(names)) // 2) :]
        rows = [row for _, row in others] + list(known.values())
        new = [name for name in names if name not in known]
        self._number = {name: row for row, name in enumerate([*(name for name, _ in others), *known, *new])}
        self._table = np.pad(self._table[np.ix_(rows, rows)], (0, len(new)), constant_values=np.nan)
        return np.array([self._number[name] for name in names], dtype=np.intp)


def _rows_that_cover(missing: Bools) -> Indices:
    """Return rows (k,) such that each missing length of a symmetric table is in one of them or of their columns."""
    left, rows = missing.copy(), []
    while (counts := left.sum(axis=1)).any():
        row = int(np.argmax(counts))
        rows.append(row)
        left[row] = left[:, row] = False
    return np.array(rows, dtype=np.intp)
