"""Winner determination of a combinatorial auction: which bids on bundles win together.

Depth first over robots, with the sum of what the others could gain at most as the bound ([sandholm2002] bounds so).
Exact, unless it would look at more than a number of combinations: then the best found so far counts, which is at least
as good as the greedy choice.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass


@dataclass(frozen=True)
class BundleBid:
    """A robot's bid on tasks, in the order in which they would be awarded; `gain` is their worth less the bid."""

    robot: int
    tasks: tuple[int, ...]
    gain: float


@dataclass(frozen=True)
class Clearing:
    """The winning bids, and whether no other choice gains more."""

    winners: tuple[BundleBid, ...]
    exact: bool


def clear(bids: Sequence[BundleBid], most: int) -> Clearing:
    """The bids that gain most together: at most one of each robot, no task twice; looks at `most` combinations."""
    by_robot: dict[int, list[BundleBid]] = {}
    for bid in sorted(bids, key=lambda bid: (-bid.gain, bid.robot, bid.tasks)):
        if bid.gain > 0.0:
            by_robot.setdefault(bid.robot, []).append(bid)
    found = _search(sorted(by_robot.values(), key=lambda own: -own[0].gain), most)
    return Clearing(max(greedy(bids), found.winners, key=_gain), found.exact)


def greedy(bids: Sequence[BundleBid]) -> tuple[BundleBid, ...]:
    """The bid with the highest gain a task, then the next that is still possible."""
    winners: list[BundleBid] = []
    robots: set[int] = set()
    sold: set[int] = set()
    for bid in sorted(bids, key=lambda bid: (-bid.gain / len(bid.tasks), bid.robot, bid.tasks)):
        if bid.gain > 0.0 and bid.robot not in robots and sold.isdisjoint(bid.tasks):
            winners.append(bid)
            robots.add(bid.robot)
            sold.update(bid.tasks)
    return tuple(winners)


def _gain(winners: Sequence[BundleBid]) -> float:
    return sum(bid.gain for bid in winners)


def _search(own: Sequence[Sequence[BundleBid]], most: int) -> Clearing:
    """Each robot in turn takes one of its bids, the best first, or none; robots with the highest gain come first."""
    bound = [0.0] * (len(own) + 1)  # of what robots from k on can gain
    for k in reversed(range(len(own))):
        bound[k] = bound[k + 1] + own[k][0].gain
    best: tuple[BundleBid, ...] = ()
    best_gain, gain = 0.0, 0.0
    sold: set[int] = set()
    chosen: list[BundleBid | None] = []
    tried = [0] * (len(own) + 1)  # by robot: how many of its choices
    for _ in range(most):
        k = len(chosen)
        choice = _next_choice(own[k], tried, k, sold) if k < len(own) and gain + bound[k] > best_gain else None
        if choice is None:
            if not chosen:
                return Clearing(best, exact=True)
            if (last := chosen.pop()) is not None:
                gain -= last.gain
                sold.difference_update(last.tasks)
            tried[k] = 0
            continue
        bid = choice[0]
        chosen.append(bid)
        if bid is not None:
            gain += bid.gain
            sold.update(bid.tasks)
        if gain > best_gain:
            best_gain, best = gain, tuple(one for one in chosen if one is not None)
    return Clearing(best, exact=False)


def _next_choice(own: Sequence[BundleBid], tried: list[int], k: int, sold: set[int]) -> tuple[BundleBid | None] | None:
    """The robot's next bid on tasks that are not sold, at last no bid; None after that."""
    while tried[k] < len(own):
        bid = own[tried[k]]
        tried[k] += 1
        if sold.isdisjoint(bid.tasks):
            return (bid,)
    if tried[k] == len(own):
        tried[k] += 1
        return (None,)
    return None
