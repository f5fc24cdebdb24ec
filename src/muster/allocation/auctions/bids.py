"""Bid rules: what a robot bids for tasks. Pure functions, for the auctions in one process and over a network alike.

A rule takes one figure of each task (see FIGURES) and how the robot stands before it, and works on arrays of any shape
that go together. For one robot at one time each rule is increasing in its figure, so that the task with the lowest
figure has the lowest bid.

Sources: [auction-thesis], chapter 4; [lagoudakis2005]; `total+max` and
`makespan` are our own, for the objectives of these names.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from muster import core
from muster.allocation.auctions.auction_terms import BidTerms
from muster.mission.values.arrays import Floats, Indices
from muster.model.problem import Problem
from muster.model.skill_quality import skill_quality

FIGURES = ("growth", "arrivals", "end")
"""`growth` of the route's usage; `arrivals`, what is added to the sum of usages on arrival at tasks; `end`, when the
robot would be done with all its tasks, in seconds, waiting included. inf where the robot cannot do the task."""


@dataclass(frozen=True)
class Standing:
    """How robots stand before a bid: usage of the route and number of its tasks; the greatest usage in the team."""

    usage: Floats | float
    tasks: Floats | float
    greatest_usage: float


def total(growth: Floats, robot: Standing) -> Floats:
    """MiniSum: L(P + t) - L(P), by how much the task lengthens the route."""
    return growth


def maximum(growth: Floats, robot: Standing) -> Floats:
    """MiniMax: L(P + t), the length of the route with the task."""
    return robot.usage + growth


def average(arrivals: Floats, robot: Standing) -> Floats:
    """MiniAve: increase of the sum over tasks of the path length at which each is reached."""
    return arrivals


def average_as_printed(growth: Floats, robot: Standing) -> Floats:
    """Number of tasks in the route with the task, times its length.

    Fitted: [auction-thesis] describes another rule, but its Table 5.20 comes out with this one alone.
    """
    return (robot.tasks + 1) * (robot.usage + growth)


def total_and_maximum(growth: Floats, robot: Standing) -> Floats:
    """Increase of the objective `total+max`: that of the sum of usages, and that of the greatest usage."""
    return growth + np.maximum(0.0, robot.usage + growth - robot.greatest_usage)


def makespan(end: Floats, robot: Standing) -> Floats:
    """When the robot would be done with all its tasks: MiniMax in time, waiting included."""
    return end


@dataclass(frozen=True)
class BidRule:
    """A rule, the figure that it takes, and whether it looks at the rest of the team, too."""

    bid: Callable[[Floats, Standing], Floats]
    figure: str
    of_team: bool = False


BID_RULES: Mapping[str, BidRule] = MappingProxyType(
    {
        "total": BidRule(total, "growth"),
        "max": BidRule(maximum, "growth"),
        "average": BidRule(average, "arrivals"),
        "average-as-printed": BidRule(average_as_printed, "growth"),
        "total+max": BidRule(total_and_maximum, "growth", of_team=True),
        "makespan": BidRule(makespan, "end"),
    }
)


def weighted(bid: Floats, penalty: Floats | float) -> Floats:
    """A bid made worse by a factor of 1 + penalty."""
    return np.where(bid < 0.0, bid / (1.0 + penalty), bid * (1.0 + penalty))


def in_quanta(bid: Floats) -> Floats:
    """A bid as it is compared: in whole quanta, so that robots whose processors round otherwise compare the same.

    Bids that differ by less, in the unit of the objective, are equal, and the tie order decides.
    """
    rounded: Floats = np.round(bid / core.QUANTUM) * core.QUANTUM
    return rounded


def lack_penalty(score: Floats) -> Floats:
    """What a score, of suitability or of quality, lacks to 1: 0 to 1."""
    return 1.0 - score


class Penalties:
    """By how much bids are made worse: by what robots have used up, and by what they lack to do a task well."""

    def __init__(self, problem: Problem, terms: BidTerms) -> None:
        self._problem = problem
        self._used, self._unsuitable, self._unskilled = terms.weights
        self._quality = skill_quality(problem) if self._unskilled else np.empty((0, 0))

    def of(self, usages: Floats, robots: int | slice, tasks: int | slice | Indices) -> Floats:
        """The penalty of robots, which have used so much, at tasks."""
        penalty = np.zeros(())
        if self._used:
            penalty = penalty + self._used * self._problem.drains.shares(usages, robots)
        if self._unsuitable:
            penalty = penalty + self._unsuitable * lack_penalty(self._problem.suitability[robots, tasks])
        if self._unskilled:
            penalty = penalty + self._unskilled * lack_penalty(self._quality[robots, tasks])
        return penalty
