"""Particle swarm optimization in two steps: particles say who does what, a greedy rule in which order.

[tcf-thesis], section 2.3, (2.20) to (2.22). A particle is a point of the unit cube with one axis for each task: its
place there says which of the robots that may do the task is meant. Each robot then goes on to the nearest of its
tasks. With `leader` `pareto`, (2.22): a particle follows one drawn from the Pareto front of total and greatest usage
by its fitness, instead of the best of all.

Where the text leaves room: the time interval is 1; both pulls are multiplied by random numbers from 0 to 1, which
[kennedy1995] has and (2.20) does not print; the constants are those of [clerc2002]; a particle that leaves the cube
stays at its wall.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster import core
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import BY_OBJECTIVE
from muster.allocation.stop import Stop
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts, require_within
from muster.model.problem import Bools, Problem
from muster_studies.alternatives.strings import Best, Strings, fitness, ranking, spun

LEADERS = ("best", "pareto")
_INSIDE = 1.0 - 1e-9  # the upper wall belongs to the last robot


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the swarm; w, c1 and c2 of (2.20).

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    population_size: int = 30
    inertia: float = 0.7298
    own_weight: float = 1.49618
    leader_weight: float = 1.49618
    leader: str = "best"

    def __post_init__(self) -> None:
        require_counts(1, population_size=self.population_size)
        require_within(0, 10, inertia=self.inertia, own_weight=self.own_weight, leader_weight=self.leader_weight)
        if self.leader not in LEADERS:
            raise ParameterError(f"leader: {self.leader}; expected {' or '.join(LEADERS)}")


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """(2.20) or (2.22), and (2.21); a start plan is where the first particle begins."""
    random = np.random.default_rng(seed)
    teams, decoder, best = Teams(problem), core.Decoder(problem.core), Best(problem, stop, start)
    position = random.random((params.population_size, len(problem.tasks)))
    if start is not None:
        position[0] = teams.position(start)
    velocity = np.zeros_like(position)
    figures = decoder.nearest_next(teams.robots(position))
    best.note(figures, decoder.routes)
    own, own_figures = position.copy(), figures
    front = Front(position, figures)
    for _ in stop.iterations():
        leader = front.leaders(len(position), random) if params.leader == "pareto" else own[ranking(own_figures)[:1]]
        pulls = random.random((2, *position.shape))
        velocity = (
            params.inertia * velocity
            + params.own_weight * pulls[0] * (own - position)
            + params.leader_weight * pulls[1] * (leader - position)
        )
        position = np.clip(position + velocity, 0.0, _INSIDE)
        figures = decoder.nearest_next(teams.robots(position))
        best.note(figures, decoder.routes)
        better = _better(figures, own_figures)
        own = np.where(better[:, None], position, own)
        own_figures = np.where(better[:, None], figures, own_figures)
        if params.leader == "pareto":
            front.add(position, figures)
    return Outcome(best.routes)


class Teams:
    """For each task the robots that may do it, in equal parts of an axis from 0 to 1."""

    def __init__(self, problem: Problem) -> None:
        allowed = problem.allowed.T
        self._order = np.argsort(~allowed, axis=1, kind="stable").astype(np.int32)
        self._count = np.maximum(1, allowed.sum(axis=1))

    def robots(self, position: Floats) -> Strings:
        """(k, n) the robot of each task."""
        return np.asarray(self._order[np.arange(position.shape[1]), (position * self._count).astype(np.int64)])

    def position(self, routes: Routes) -> Floats:
        """(n,) the middle of the part of each task's robot."""
        position = np.full(len(self._count), 0.5)
        for i, route in enumerate(routes):
            for j in route:
                position[j] = (np.flatnonzero(self._order[j] == i)[0] + 0.5) / self._count[j]
        return position


class Front:
    """The Pareto front of total and greatest usage among the plans that do most."""

    def __init__(self, position: Floats, figures: Floats) -> None:
        self._position, self._figures = position[:0], figures[:0]
        self.add(position, figures)

    def add(self, position: Floats, figures: Floats) -> None:
        """Keep of the front and these what nothing else is better than."""
        position, figures = np.concatenate([self._position, position]), np.concatenate([self._figures, figures])
        order = np.lexsort((figures[:, 3], figures[:, 2], -figures[:, 0]))
        order = order[figures[order, 0] == figures[order[0], 0]]
        greatest = figures[order, 3]
        least_before = np.minimum.accumulate(np.concatenate([[np.inf], greatest[:-1]]))
        kept = order[greatest < least_before]
        self._position, self._figures = position[kept], figures[kept]

    def leaders(self, count: int, random: np.random.Generator) -> Floats:
        """(count, n) positions drawn by fitness."""
        return self._position[spun(fitness(self._figures), count, random)]


def _better(figures: Floats, than: Floats) -> Bools:
    more, as_much = figures[:, 0] > than[:, 0], figures[:, 0] == than[:, 0]
    return np.asarray(more | (as_much & (figures[:, 1] < than[:, 1])))


PARTICLE_SWARM = Allocator(
    name="particle-swarm",
    summary="particles choose robots, the nearest task comes next; reviewed in the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=BY_OBJECTIVE,
)
