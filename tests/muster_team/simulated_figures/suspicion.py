"""The rate of false suspicions: measured, and bounded by calculation.

That is rare, so it is measured by importance sampling. From each word of one robot that the other hears on, the network
loses the next ones more often than it should, until one is heard or the other suspects it. Each suspicion counts as
often as it would have come by the true loss: the quotient of the chances of all that was lost.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial
from random import Random
from statistics import NormalDist, fmean, stdev

from tests.muster_team.simulated_figures.teams import DELAY_S, all_agree, team, time_until

from muster_team.membership.members import Timeouts
from muster_team.network.memory_network import TICK_S, LinkConditions, MemoryNetwork

BIASED_LOSS = 0.95
"""The loss while silence is provoked; sixteen words in a row are lost in 4 of 9 trials."""


TRIALS = 25
"""In each run; runs differ in how the heartbeats of their robots meet the ticks of their clocks."""


@dataclass(frozen=True)
class Rate:
    """False suspicions a robot pair and hour, and how far that may be off: the two-sided 95 % interval."""

    mean: float
    low: float
    high: float


def rate(loss: float, runs: int, seed: int, jitter_s: float = 0.0) -> Rate:
    """The rate of two robots alone, without news of each other from others: larger teams suspect less often.

    They are the robots of the auction on the simulated network, idle; one of them is listened to.
    """
    random = Random(seed)
    rates = [_rate_of_a_run(loss, jitter_s, random) for _ in range(runs)]
    mean, spread = fmean(rates), NormalDist().inv_cdf(0.975) * stdev(rates) / math.sqrt(runs)
    return Rate(mean, mean - spread, mean + spread)


def _rate_of_a_run(loss: float, jitter_s: float, random: Random) -> float:
    _, network = team(2, 4, random.randrange(2**32), LinkConditions(delay_s=DELAY_S, jitter_s=jitter_s))
    speaker, listener = network.robots
    provoked = _Provoked(loss, random, speaker)
    network.links = provoked.gets_through
    for robot in network.robots:
        network.at(random.uniform(0, 1), partial(network.start, [robot]))
    network.run(1.0)
    _rest(network)
    heard_an_hour = (1 - loss) * _words_an_hour(network, provoked)
    return heard_an_hour * fmean(_trial(network, provoked, listener) for _ in range(TRIALS))


@dataclass
class _Provoked:
    """Loss of a network, independent for each message; higher for the sender's messages while `provokes`."""

    loss: float
    random: Random
    speaker: str
    provokes: bool = False
    heard: bool = False
    words: int = 0
    weight: float = field(default=1.0)

    def gets_through(self, sender: str, listener: str) -> bool:
        if sender != self.speaker:
            return self.random.random() >= self.loss
        self.words += 1
        chance = BIASED_LOSS if self.provokes else self.loss
        lost = self.random.random() < chance
        self.weight *= self.loss / chance if lost else (1 - self.loss) / (1 - chance)
        self.heard = not lost
        return not lost


def _rest(network: MemoryNetwork) -> None:
    """Until all agree."""
    time_until(network, lambda: all_agree(network))


def _words_an_hour(network: MemoryNetwork, provoked: _Provoked, for_s: float = 60.0) -> float:
    """How often the speaker says something."""
    provoked.words = 0
    network.run(network.now + for_s)
    return 3600 * provoked.words / for_s


def _trial(network: MemoryNetwork, provoked: _Provoked, listener: str) -> float:
    """One trial from a received message to the next, or to a suspicion: its weight, or 0.

    A word that gets through is still on its way when the trial ends; the listener may suspect until then.
    """
    provoked.heard = False
    network.run(math.inf, lambda: provoked.heard)

    def suspects() -> bool:
        return provoked.speaker not in network.nodes[listener].epoch.own.members

    provoked.heard, provoked.provokes, provoked.weight = False, True, 1.0
    network.run(math.inf, lambda: provoked.heard or suspects())
    provoked.provokes = False
    if not suspects():
        network.run(network.now + DELAY_S + network.conditions.jitter_s, suspects)
    suspected, weight = suspects(), provoked.weight
    _rest(network)
    return weight if suspected else 0.0


def bound(loss: float, timeouts: Timeouts | None = None) -> float:
    """False suspicions a robot pair and hour, at most: by heartbeats from one to the other alone, all of them lost.

    A run of k lost heartbeats begins with each heartbeat with probability (1 - loss) * loss**k; k of them arrive in
    `suspect_s`, if all are as long on their way: where one can be late by more than a heartbeat, it is one less.
    """
    timeouts = timeouts or Timeouts()
    longest_s = timeouts.heartbeat_s + TICK_S  # a heartbeat is sent when its robot looks at its clock
    k = math.floor(timeouts.suspect_s / longest_s)
    return 3600 / timeouts.heartbeat_s * (1 - loss) * loss**k
