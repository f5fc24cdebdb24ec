"""The cells of the boustrophedon decomposition [choset2000]: lanes that are driven there and back, one after the other.

A sweep over the region goes from lane to lane. Where exactly one lane follows exactly one, the cell goes on; where
lanes part around a hole or meet behind it, new cells begin.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise, product

import numpy as np
import numpy.typing as npt

from muster.mission.values.arrays import Floats

CORNERS = 4
"""From how many corners a cell can be begun."""


@dataclass(frozen=True, eq=False)
class Cell:
    """Lanes (n, 2, 2), west and east end, from south to north; each is next to the one before it."""

    rows: Floats

    def begun_from(self, corner: int) -> Floats:
        """(n, 2, 2) the lanes as they are driven: 0 south-west, 1 south-east, 2 north-west, 3 north-east first."""
        northward, eastward = corner < 2, corner % 2 == 0
        rows = self.rows if northward else self.rows[::-1]
        turned = (np.arange(len(rows)) % 2 == 1) == eastward
        return np.where(turned[:, None, None], rows[:, ::-1], rows)


def cells_of(rows: Floats, strips: npt.NDArray[np.int64]) -> list[Cell]:
    """The cells of lanes (n, 2, 2) along x, by their southern lanes; each lane is in the middle of a strip (n)."""
    followers: list[list[int]] = [[] for _ in rows]
    before: list[list[int]] = [[] for _ in rows]
    by_strip: list[list[int]] = [[] for _ in range(int(strips.max(initial=-1)) + 1)]
    for k, strip in enumerate(strips):
        by_strip[strip].append(k)
    for southern, northern in pairwise(by_strip):
        for a, b in product(southern, northern):
            if _side_by_side(rows[a], rows[b]):
                followers[a].append(b)
                before[b].append(a)
    return [Cell(rows[chain]) for chain in _chains(followers, before)]


def _side_by_side(a: Floats, b: Floats) -> bool:
    return bool(a[0, 0] < b[1, 0] and b[0, 0] < a[1, 0])


def _chains(followers: Sequence[Sequence[int]], before: Sequence[Sequence[int]]) -> list[list[int]]:
    """Lanes as long as each has one follower, which follows no other."""

    def next_of(k: int) -> int | None:
        return followers[k][0] if len(followers[k]) == 1 and len(before[followers[k][0]]) == 1 else None

    continued = {next_of(k) for k in range(len(followers))}
    chains = []
    for first in range(len(followers)):
        if first in continued:
            continue
        chain = [first]
        while (follower := next_of(chain[-1])) is not None:
            chain.append(follower)
        chains.append(chain)
    return chains
