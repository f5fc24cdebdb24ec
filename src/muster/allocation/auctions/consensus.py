"""Agreement of robots on the winner of each task, by messages between neighbours: phase 2 of CBBA.

[choi2009]. Variables carry the paper's names: i receives from k; z: winning agents, y: winning bids, s:
time stamps. All rounds are synchronous.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from muster.allocation.stop import Stop
from muster.mission.auction_book import Award, Bid, Book, TakeBid
from muster.model.problem import Bools, Floats, Indices, Problem

TOPOLOGIES = ("complete", "ring", "line")
NOBODY = -1
NO_BID = -math.inf
"""Below every bid. Bids are logarithms of scores, so this is a score of 0."""
_MOST = 709.0  # exp of more is beyond float64


def neighbours(topology: str, m: int) -> list[list[int]]:
    """For each of m robots those that it exchanges messages with."""
    if topology == "complete":
        return [[k for k in range(m) if k != i] for i in range(m)]
    line = [{i - 1, i + 1} & set(range(m)) for i in range(m)]
    if topology == "ring":
        line[0] |= {m - 1} - {0}
        line[-1] |= {0} - {m - 1}
    return [sorted(others) for others in line]


def diameter(topology: str, m: int) -> int:
    """Messages on the longest of the shortest ways between m robots; 1 for a single robot."""
    return max(1, {"complete": 1, "ring": m // 2, "line": m - 1}[topology])


@dataclass(frozen=True, eq=False)
class Message:
    """What sender k and receivers i hold of some tasks: arrays with an item for each pair of receiver and task.

    Time stamps are those of m, the winner to the sender, and of n, the winner to the receiver; where that is NOBODY
    they do not count.
    """

    k: int
    i: Indices
    z_k: Indices
    z_i: Indices
    y_k: Floats
    y_i: Floats
    s_km: Indices
    s_im: Indices
    s_kn: Indices
    s_in: Indices

    def actions(self) -> tuple[Bools, Bools]:
        """Where the receiver updates (takes over winner and bid) and where it resets (no winner); else it leaves.

        Table I. Of equal bids that of the lower robot counts as higher.
        """
        by_k, by_i, by_nobody = self.z_k == self.k, self.z_k == self.i, self.z_k == NOBODY
        by_m = ~(by_k | by_i | by_nobody)
        to_i, to_k, to_nobody = self.z_i == self.i, self.z_i == self.k, self.z_i == NOBODY
        to_n = ~(to_i | to_k | to_nobody)
        same = by_m & (self.z_i == self.z_k)
        other = to_n & ~same
        higher = (self.y_k > self.y_i) | ((self.y_k == self.y_i) & (self.z_k < self.z_i))
        newer_m, older_m, newer_n = self.s_km > self.s_im, self.s_km < self.s_im, self.s_kn > self.s_in

        update = by_k & (to_k | to_nobody | (to_i & higher) | (to_n & (newer_n | higher)))
        update |= by_m & newer_m & (to_k | to_nobody | same | (to_i & higher) | (other & (newer_n | higher)))
        update |= by_nobody & (to_k | (to_n & newer_n))
        reset = by_i & (to_k | (to_n & newer_n))
        reset |= by_m & ((to_k & ~newer_m) | (other & newer_n & older_m))
        return update, reset


class Beliefs:
    """What each of m robots believes of each of n tasks: a row for each robot.

    Attributes
    ----------
    z, y
        (m, n) the robot that wins a task, and its bid.
    s
        (m, m) the round of the latest news from each robot, whatever way it came.
    """

    def __init__(self, m: int, n: int) -> None:
        self.z: Indices = np.full((m, n), NOBODY, dtype=np.int64)
        self.y: Floats = np.full((m, n), NO_BID)
        self.s: Indices = np.zeros((m, m), dtype=np.int64)

    def exchange(self, network: Sequence[Sequence[int]], now: int, stop: Stop) -> None:
        """A round: every robot sends what it believes to its neighbours, which read their messages by their senders.

        Messages that are not read when it is time to stop are lost.
        """
        sent = self._copy()
        for k, receivers in enumerate(network):
            if receivers and not stop.due():
                self._read(sent, k, np.array(receivers, dtype=np.int64), now)

    def lose(self, i: int, bundle: Sequence[int]) -> list[int]:
        """The tasks of robot i's bundle from the first that it does not win any more; none is its own now."""
        z, y = self.z[i], self.y[i]
        lost = next((k for k, j in enumerate(bundle) if z[j] != i), len(bundle))
        for j in bundle[lost:]:
            if z[j] == i:
                z[j], y[j] = NOBODY, NO_BID
        return list(bundle[lost:])

    def agreed_winners(self) -> Indices:
        """(n,) the winner of each task; NOBODY too where the robots do not agree."""
        return np.where((self.z == self.z[0]).all(axis=0), self.z[0], NOBODY)

    def agree(self) -> bool:
        """Whether all robots believe the same."""
        return bool((self.z == self.z[0]).all() and (self.y == self.y[0]).all())

    def _copy(self) -> Beliefs:
        copy = Beliefs(0, 0)
        copy.z, copy.y, copy.s = self.z.copy(), self.y.copy(), self.s.copy()
        return copy

    def _read(self, sent: Beliefs, k: int, receivers: Indices, now: int) -> None:
        """Let robots read the message of robot k. Where both believe the same, no rule of the table does anything."""
        at, j = np.nonzero((self.z[receivers] != sent.z[k]) | (self.y[receivers] != sent.y[k]))
        if len(j):
            i = receivers[at]
            z_k, z_i, y_k, y_i = sent.z[k, j], self.z[i, j], sent.y[k, j], self.y[i, j]
            s_km, s_im, s_kn, s_in = sent.s[k, z_k], self.s[i, z_k], sent.s[k, z_i], self.s[i, z_i]
            update, reset = Message(k, i, z_k, z_i, y_k, y_i, s_km, s_im, s_kn, s_in).actions()
            self.z[i[update], j[update]] = z_k[update]
            self.y[i[update], j[update]] = y_k[update]
            self.z[i[reset], j[reset]] = NOBODY
            self.y[i[reset], j[reset]] = NO_BID
        self.s[receivers] = np.maximum(self.s[receivers], sent.s[k])  # news of others through k ...
        self.s[receivers, k] = now  # ... and from k itself


class Ledger:
    """Every bid in order: round, task, robot, logarithm of the bid."""

    def __init__(self) -> None:
        self.rounds = 0
        self._rows: list[tuple[int, int, int, float]] = []

    def note(self, j: int, i: int, bid: float) -> None:
        self._rows.append((self.rounds + 1, j, i, bid))

    def end_round(self) -> int:
        self.rounds += 1
        return self.rounds

    def book(self, problem: Problem, routes: Sequence[Sequence[int]], network: Sequence[Sequence[int]]) -> Book:
        """The book: of each robot an award names the last bid, and that of the winner may not be the highest of them.

        A higher one was given up when its robot lost a task that it had taken before this one.
        """
        robots, tasks = [robot.id for robot in problem.robots], [task.id for task in problem.tasks]
        winner = {j: i for i, route in enumerate(routes) for j in route}
        last: dict[int, dict[int, int]] = {}
        for row, (_, j, i, _) in enumerate(self._rows):
            last.setdefault(j, {})[i] = row
        won = {last[j][i]: j for j, i in winner.items() if j in last}
        sold = {self._rows[row][:2]: row for row in won}

        def award(row: int, j: int) -> Award:
            ranked = sorted(last[j].items(), key=lambda item: (-self._rows[item[1]][3], item[0]))
            bids = [(robots[i], score(self._rows[k][3])) for i, k in ranked]
            number, _, i, bid = self._rows[row]
            return Award.of(number, tasks[j], robots[i], score(bid), bids)

        def for_each_bid(take: TakeBid) -> None:
            for number, j, i, bid in self._rows:
                row = sold.get((number, j))
                won_by = None if row is None else robots[self._rows[row][2]]
                price = None if row is None else score(self._rows[row][3])
                take(Bid(number, tasks[j], robots[i], score(bid), won_by, price))

        messages = self.rounds * sum(map(len, network))
        awards = tuple(award(row, j) for row, j in sorted(won.items()))
        return Book(rounds=self.rounds, messages=messages, awards=awards, for_each_bid=for_each_bid)


def score(bid: float) -> float:
    """The score that a bid is the logarithm of."""
    return math.exp(min(bid, _MOST))
