"""Winner rules: which of the bids of a round wins ([auction-thesis], sections 4.3 and 4.4).

An exact tie goes to the first robot, then to the first task, in the order of their ids.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from types import MappingProxyType
from typing import Protocol

import numpy as np

from muster.mission.values.arrays import Floats, Indices


@dataclass(frozen=True)
class Sale:
    """One task, by index, goes to one robot for its bid."""

    robot: int
    task: int
    price: float


class Bidding(Protocol):
    """Who can say what robots bid."""

    @property
    def shape(self) -> tuple[int, int]:
        """The number of robots, and of tasks."""

    def bids(self, robot: int) -> Floats:
        """(n,) the robot's bid for each task; inf where it makes none."""

    def lowest_bids(self) -> tuple[Indices, Floats]:
        """(m,) the task that each robot bids least for, and that bid; inf for a robot without bids."""


class WinnerRule(Protocol):
    """Resolves one round after the other."""

    def note(self, robots: Sequence[int], sold: int | None = None) -> None:
        """The bids of these robots are not what they were, and nobody bids for what is sold any more."""

    def winner(self) -> Sale | None:
        """The sale of this round; None if nobody bids."""


class Lowest:
    """Each robot submits its lowest bid, and the lowest of these wins."""

    def __init__(self, bidding: Bidding) -> None:
        self._bidding = bidding

    def note(self, robots: Sequence[int], sold: int | None = None) -> None:
        """Nothing is kept: the lowest bids are asked for in every round."""

    def winner(self) -> Sale | None:
        """The lowest of all bids."""
        return _lowest(*self._bidding.lowest_bids())


class KeptLowest:
    """The same where a robot's lowest bid need not be that with its lowest figure: it is kept until it changes."""

    def __init__(self, bidding: Bidding) -> None:
        self._bidding = bidding
        self._tasks: Indices = np.full(bidding.shape[0], -1, dtype=np.int64)
        self._lowest = np.full(bidding.shape[0], np.inf)

    def note(self, robots: Sequence[int], sold: int | None = None) -> None:
        """Find the lowest bids of these robots again, and of those that bid for the task that was sold."""
        if not self._bidding.shape[1]:
            return
        also = () if sold is None else np.flatnonzero(self._tasks == sold).tolist()
        for robot in {*robots, *also}:
            bids = self._bidding.bids(robot)
            self._tasks[robot] = np.argmin(bids)
            self._lowest[robot] = bids[self._tasks[robot]]

    def winner(self) -> Sale | None:
        """The lowest of all bids."""
        return _lowest(self._tasks, self._lowest)


def _lowest(tasks: Indices, bids: Floats) -> Sale | None:
    robot = int(np.argmin(bids))
    return Sale(robot, int(tasks[robot]), float(bids[robot])) if np.isfinite(bids[robot]) else None


class LeastContested:
    """Each robot submits all its bids; the task with the widest gap between its two lowest goes to its lowest bidder.

    A task with a single bidder is contested by nobody, and goes first.
    """

    def __init__(self, bidding: Bidding) -> None:
        self._bidding = bidding
        robots, tasks = bidding.shape
        self._bids = np.full((tasks, robots), np.inf)
        self._lowest = np.full(tasks, np.inf)
        self._second = np.full(tasks, np.inf)
        self._bidder = np.zeros(tasks, dtype=np.int64)

    def note(self, robots: Sequence[int], sold: int | None = None) -> None:
        """Read these robots' bids again."""
        changed = np.zeros(len(self._bids), dtype=np.bool_)
        if sold is not None:
            self._bids[sold] = np.inf
            changed[sold] = True
        for robot in robots:
            bids = self._bidding.bids(robot)
            changed |= bids != self._bids[:, robot]
            self._bids[:, robot] = bids
        self._rank(np.flatnonzero(changed))

    def _rank(self, tasks: Indices) -> None:
        """Find the two lowest bids for tasks."""
        bids = self._bids[tasks]
        self._bidder[tasks] = np.argmin(bids, axis=1)
        if bids.shape[1] == 1:
            self._lowest[tasks] = bids[:, 0]
            return
        self._lowest[tasks], self._second[tasks] = np.partition(bids, 1, axis=1)[:, :2].T

    def winner(self) -> Sale | None:
        """The widest gap; of equal ones that of the first robot."""
        bid_for = np.flatnonzero(np.isfinite(self._lowest))
        if not len(bid_for):
            return None
        gaps = self._second[bid_for] - self._lowest[bid_for]
        widest = bid_for[gaps == gaps.max()]
        task = int(widest[np.argmin(self._bidder[widest])])
        return Sale(int(self._bidder[task]), task, float(self._lowest[task]))


WINNER_RULES: Mapping[str, type[Lowest] | type[LeastContested]] = MappingProxyType(
    {"lowest": Lowest, "least-contested": LeastContested}
)
