"""Ant colony optimization: Ant System.

[tcf-thesis], section 2.3, (2.24) to (2.26); constants of [dorigo1996]. Every robot is an ant: it chooses its next task
by pheromone and distance among those that it may do, has capacity for, and whose prerequisites are in routes (2.24).
All ants together build one plan; `population_size` plans are built between two updates of the pheromones.

Where the text leaves room: the robot with least usage moves next, for the objective `total` one drawn by how strongly
it is attracted (`core.Colony`); a plan's ants leave an increment that is the best objective so far over the plan's
own, divided by the number of plans, so that the unit of usage does not matter; plans that do less than the best of
their generation leave none; `elite` plans' worth is left on the best plan so far (elitist Ant System, [dorigo1996]).
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster import core
from muster.allocation.allocator import Allocator, Outcome, Routes
from muster.allocation.capabilities import BY_OBJECTIVE
from muster.allocation.stop import Stop
from muster.mission.values.arrays import Floats
from muster.mission.values.ranges import require_counts, require_within
from muster.model.problem import Problem
from muster_studies.alternatives.strings import Best

_LEAST_PHEROMONE = 1e-9  # beside 1 at the beginning: no path is lost to rounding


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """Parameters of the colony; alpha and beta of (2.24), rho (`evaporation`) of (2.25).

    Raises
    ------
    ParameterError
        if one is out of range.
    """

    population_size: int = 20
    alpha: float = 1.0
    beta: float = 5.0
    evaporation: float = 0.5
    elite: float = 5.0

    def __post_init__(self) -> None:
        require_counts(1, population_size=self.population_size)
        require_within(0, 20, alpha=self.alpha, beta=self.beta)
        require_within(0, 1, evaporation=self.evaporation)
        require_within(0, 1e6, elite=self.elite)


def allocate(problem: Problem, stop: Stop, seed: int, params: Parameters, start: Routes | None) -> Outcome:
    """Build plans (2.24), update the pheromones (2.25), (2.26); a start plan is the first best one."""
    colony = core.Colony(problem.core, params.beta, seed)
    best = Best(problem, stop, start)
    n, m = len(problem.tasks), len(problem.robots)
    pheromone = np.ones((n + m, n))
    figures, plans = built(colony, pheromone, params.population_size, stop)
    best.note(figures, plans.__getitem__)
    for _ in stop.iterations():
        increment = np.zeros_like(pheromone)
        for k in np.flatnonzero(figures[:, 0] == figures[:, 0].max()).tolist():
            leave(increment, plans[k], best.objective / (figures[k, 1] or 1.0) / params.population_size)
        leave(increment, best.routes, params.elite / params.population_size)
        pheromone = np.maximum((1.0 - params.evaporation) * pheromone + increment, _LEAST_PHEROMONE)
        figures, plans = built(colony, pheromone**params.alpha, params.population_size, stop)
        best.note(figures, plans.__getitem__)
    return Outcome(best.routes)


def built(colony: core.Colony, trail: Floats, count: int, stop: Stop) -> tuple[Floats, list[Routes]]:
    """The figures of so many plans, or of those that there is time for, one at least; and their routes."""
    figures: list[Floats] = []
    plans: list[Routes] = []
    while len(plans) < count and not (plans and stop.due()):
        figures.append(colony.build(trail, 1))
        plans.append(colony.routes(0))
    return np.concatenate(figures), plans


def leave(increment: Floats, routes: Routes, amount: float) -> None:
    """Add an amount on every path of routes, from the robots' starts on."""
    n = increment.shape[1]
    for i, route in enumerate(routes):
        if route:
            increment[[n + i, *route[:-1]], route] += amount


ANT_COLONY = Allocator(
    name="ant-colony",
    summary="robots as ants that follow pheromones and distances; reviewed in the TCF thesis",
    anytime=True,
    parameters=Parameters,
    algorithm=allocate,
    can=BY_OBJECTIVE,
)
