"""How soon robots agree in a simulated network, what that costs, and how often they suspect each other wrongly."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from random import Random

import numpy as np

from muster.allocation.auction import Parameters
from muster.allocation.problem import Problem
from muster.negotiation.members import Patience
from muster.negotiation.memory_network import TICK_S, MemoryNetwork, Weather
from muster.negotiation.negotiator import Negotiator
from muster.negotiation.taking_part import negotiator_of
from muster.studies.uniform import uniform_mission

DELAY_S = 0.05
END_S = 600.0


def team(robots: int, tasks: int, seed: int, weather: Weather) -> tuple[Problem, MemoryNetwork]:
    """Robots and tasks without limits in a square, and a network of them."""
    problem = Problem.compile(uniform_mission(Random(seed), robots=robots, tasks=tasks)).ready()
    terms = Parameters()

    def make(robot: str, incarnation: int) -> Negotiator:
        return negotiator_of(problem, terms, robot, incarnation=incarnation)

    return problem, MemoryNetwork(make, [robot.id for robot in problem.robots], seed, weather)


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
        problem, network = team(robots, tasks, seed, Weather(loss=loss, delay_s=DELAY_S))
        times = _Rounds(network)
        network.watch = times.look
        network.start()
        nodes = network.nodes
        _time_until(network, lambda nodes=nodes: all(node.settled for node in nodes.values()))  # type: ignore[misc]
        award_s += times.took_s()
        end_s.append(network.now)
        counts = [node.counts for node in network.nodes.values()]
        sent += sum(count.news + count.repairs + count.beats for count in counts)
        repairs += sum(count.repairs for count in counts)
        rounds += robots * (len(times.took_s()) + 1)
        worse.append(_value(problem, network) / _value(problem, _settled(robots, tasks, 0.0, seed)) - 1)
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


def healed(robots: int, tasks: int, loss: float, seed: int, cut_s: float = 15.0) -> float:
    """How long after a cut of the team into halves all agree again, seconds."""
    network = _settled(robots, tasks, loss, seed)
    network.cut(network.robots[::2], network.robots[1::2])
    network.run(network.now + cut_s)
    network.heal()
    return _time_until(network, lambda: _all_agree(network))


def noticed(robots: int, loss: float, seed: int) -> float:
    """How long after a crash nobody has the robot for a member any more, seconds."""
    network = _settled(robots, robots, loss, seed)
    network.run(network.now + Random(seed).uniform(0, 1))
    gone, nodes = network.robots[seed % robots], network.nodes
    network.crash(gone)
    return _time_until(network, lambda: all(gone not in node.epoch.own.members for node in nodes.values()))


def _settled(robots: int, tasks: int, loss: float, seed: int) -> MemoryNetwork:
    """A team that has ended its first auction."""
    _, network = team(robots, tasks, seed, Weather(loss=loss, delay_s=DELAY_S))
    network.start()
    _time_until(network, lambda: all(node.settled for node in network.nodes.values()))
    return network


def _time_until(network: MemoryNetwork, what: Callable[[], bool]) -> float:
    begin = network.now
    if not network.run(begin + END_S, what):
        raise RuntimeError(f"not within {END_S:g} s of virtual time")
    return network.now - begin


def _all_agree(network: MemoryNetwork) -> bool:
    nodes = list(network.nodes.values())
    whole = len(nodes[0].epoch.own.members) == len(nodes)
    return whole and all(node.settled and node.stage == nodes[0].stage for node in nodes)


def suspicion_bound(loss: float, patience: Patience | None = None) -> float:
    """False suspicions a robot pair and hour, at most: by beats from one to the other alone, all of them lost.

    A run of k lost beats begins with each beat with probability (1 - loss) * loss**k; k of them pass in `suspect_s`.
    """
    patience = patience or Patience()
    longest_s = patience.beat_s + TICK_S  # a beat is sent when its robot looks at its clock
    k = math.floor(patience.suspect_s / longest_s)
    return 3600 / patience.beat_s * (1 - loss) * loss**k


def suspicions(
    robots: int, loss: float, hours: float, seed: int, patience: Patience | None = None
) -> tuple[int, float]:
    """False suspicions in so long of idle beats with second-hand news, and pair-hours; beats come at random times.

    The failure detector alone, in arrays: what a robot knows of another is the newest beat that reached it in any way,
    itself, or told by others: by those that miss somebody all, else to those that miss it.
    """
    patience = patience or Patience()
    generator = np.random.default_rng(seed)
    gap_s = patience.beat_s + TICK_S
    phase = generator.uniform(0, gap_s, robots)
    order = np.argsort(phase)
    heard = np.zeros((robots, robots))  # [who, of whom]: when what is known of it was sent
    spoke = np.zeros((robots, robots))  # when it was heard itself
    missed = np.zeros((robots, robots, robots), dtype=bool)  # [who, by whom, which], as was told
    suspected = np.zeros((robots, robots), dtype=bool)
    count = 0
    for beat in range(int(hours * 3600 / gap_s)):
        reached = generator.random((robots, robots)) >= loss
        for sender in order:
            now = beat * gap_s + phase[sender]
            heard[sender, sender] = now
            listeners = np.flatnonzero(reached[sender])
            spoke[sender, sender] = now
            misses = now - spoke[sender] >= patience.suspect_s / 2
            asked = misses.any() | missed[sender].any(axis=0)
            told = np.flatnonzero(asked & (now - heard[sender] < patience.suspect_s / 8))
            news = np.ix_(listeners, told)
            heard[news] = np.maximum(heard[news], heard[sender, told])
            heard[listeners, sender] = spoke[listeners, sender] = now
            missed[listeners, sender] = misses
        silent = (beat + 1) * gap_s - heard > patience.suspect_s
        count += int((silent & ~suspected).sum())
        suspected = silent
    return count, hours * robots * (robots - 1)


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
    for loss in (0.0, 0.3):
        took = [healed(20, 50, loss, seed) for seed in range(max(1, runs // 5))]
        yield f"loss {loss:.0%}: agreed {_spread(took)} after a cut"
        took = [noticed(20, loss, seed) for seed in range(max(1, runs // 5))]
        yield f"loss {loss:.0%}: a crash noticed by all in {_spread(took)}"
    for robots in (2, 20):
        count, pair_hours = suspicions(robots, 0.3, runs / 5, seed=1)
        yield f"{robots} robots, loss 30%: {count} false suspicions in {pair_hours:.0f} pair-hours of beats"
    yield f"bound, without second-hand news: {suspicion_bound(0.3):.1e} a pair and hour at loss 30%"


def _spread(took_s: Sequence[float]) -> str:
    return f"{np.median(took_s):.2f} s (median), {max(took_s):.2f} s (all of {len(took_s)})"
