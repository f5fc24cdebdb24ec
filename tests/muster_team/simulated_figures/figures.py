"""Time and cost of agreement in a simulated network, and the rate of false suspicions."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from random import Random

import numpy as np
from tests.muster_team.simulated_figures import suspicion
from tests.muster_team.simulated_figures.teams import DELAY_S, all_agree, settled_team, team, time_until

from muster.model.problem import Problem
from muster_team.network.memory_network import LinkConditions, MemoryNetwork

CUT_S = 15.0


@dataclass(frozen=True)
class Auctions:
    """Whole auctions.

    Parameters
    ----------
    award_s
        of each round how long from its first bid until the last robot knew what came of it, seconds.
    end_s
        of each auction how long until all knew that all agree.
    worse
        of each auction by which share its objective is worse than without loss.
    sent, repairs
        messages a robot sent in each round, and of these repairs.
    """

    award_s: list[float]
    end_s: list[float]
    worse: list[float]
    sent: float
    repairs: float


def auctions(robots: int, tasks: int, loss: float, seeds: Sequence[int]) -> Auctions:
    """Auctions of a team, DELAY_S each way."""
    award_s, end_s, worse, sent, repairs, rounds = [], [], [], 0, 0, 0
    for seed in seeds:
        problem, network = team(robots, tasks, seed, LinkConditions(loss=loss, delay_s=DELAY_S))
        times = _Rounds(network)
        network.watch = times.look
        network.start()
        nodes = network.nodes
        time_until(network, lambda nodes=nodes: all(node.settled for node in nodes.values()))  # type: ignore[misc]
        award_s += times.took_s()
        end_s.append(network.now)
        counts = [node.counts for node in network.nodes.values()]
        sent += sum(count.news + count.repairs + count.heartbeats for count in counts)
        repairs += sum(count.repairs for count in counts)
        rounds += robots * (len(times.took_s()) + 1)
        worse.append(_value(problem, network) / _value(problem, settled_team(robots, tasks, 0.0, seed)) - 1)
    return Auctions(award_s, end_s, worse, sent / rounds, repairs / rounds)


def _value(problem: Problem, network: MemoryNetwork) -> float:
    index = problem.task_index
    routes = [[index[claim.task] for claim in network.nodes[robot.id].route] for robot in problem.robots]
    return problem.value(routes)[1]


class _Rounds:
    """When each robot came to each round of the first epoch."""

    def __init__(self, network: MemoryNetwork) -> None:
        self._network = network
        self._first: dict[int, float] = {}
        self._last: dict[int, float] = {}
        self._at: dict[str, int] = {}

    def look(self, robot: str) -> None:
        stage, now = self._network.nodes[robot].stage, self._network.now
        if stage.base:
            for number in range(self._at.get(robot, -1) + 1, stage.round + 1):
                self._first.setdefault(number, now)
                self._last[number] = now
            self._at[robot] = stage.round

    def took_s(self) -> list[float]:
        return [self._last[number] - self._first[number - 1] for number in sorted(self._last) if number > 0]


def healed(robots: int, tasks: int, loss: float, seed: int) -> float:
    """How long after a cut of the team into halves all agree again, seconds."""
    network = settled_team(robots, tasks, loss, seed)
    network.cut(network.robots[::2], network.robots[1::2])
    network.run(network.now + CUT_S)
    network.heal()
    return time_until(network, lambda: all_agree(network))


def noticed(robots: int, loss: float, seed: int) -> float:
    """The time from a crash until no robot has the crashed one as a member, seconds."""
    network = settled_team(robots, robots, loss, seed)
    network.run(network.now + Random(seed).uniform(0, 1))
    gone, nodes = network.robots[seed % robots], network.nodes
    network.crash(gone)
    return time_until(network, lambda: all(gone not in node.epoch.own.members for node in nodes.values()))


def lines(runs: int = 100) -> Iterator[str]:
    """The table of docs/negotiation.md."""
    for loss in (0.0, 0.1, 0.3, 0.5):
        told = auctions(20, 50, loss, range(max(1, runs // 10)))
        p50, p99, p999 = np.quantile(told.award_s, (0.5, 0.99, 0.999))
        yield (
            f"20 robots, 50 tasks, loss {loss:.0%}: {len(told.award_s)} awards, known to all in {p50:.2f} s (median), "
            f"{p99:.2f} s (99 %), {p999:.2f} s (99.9 %), {max(told.award_s):.2f} s (all); "
            f"auction {max(told.end_s):.1f} s; "
            f"{told.sent:.2f} messages a robot a round, {told.repairs:.2f} of them repairs; "
            f"objective {max(told.worse):+.2%} at worst"
        )
    for loss in (0.0, 0.3, 0.5):
        took = [healed(20, 50, loss, seed) for seed in range(max(1, runs // 5))]
        yield f"loss {loss:.0%}: agreed {_spread(took)} after a cut of {CUT_S:g} s"
        took = [noticed(20, loss, seed) for seed in range(max(1, runs // 5))]
        yield f"loss {loss:.0%}: a crash noticed by all in {_spread(took)}"
    loss = 0.3
    for jitter_s in (0.0, 0.3):
        seen = suspicion.rate(loss, 2 * runs, seed=1, jitter_s=jitter_s)
        yield (
            f"loss {loss:.0%}, delays differ by {jitter_s:g} s: {seen.mean:.2g} ({seen.low:.2g} to {seen.high:.2g}) "
            f"false suspicions a pair and hour, {2 * runs} runs; bound {suspicion.bound(loss):.2g}"
        )


def _spread(took_s: Sequence[float]) -> str:
    return f"{np.median(took_s):.2f} s (median), {max(took_s):.2f} s (all of {len(took_s)})"
