"""The costs of robots' legs and work, as whole numbers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from muster.allocation.exact.scale import Scale, Whole
from muster.model.problem import Bools, Floats, Problem

Routes = Sequence[Sequence[int]]
RealCosts = tuple[Floats, Floats, Floats, Floats]


@dataclass(frozen=True)
class Costs:
    """What legs and work cost each robot, in whole units of the scale; -1 where there is no leg.

    Parameters
    ----------
    longest
        what no route of all tasks is above, waiting included.
    first
        (m, n) the leg from the start.
    between
        (m, n, n) the leg from one task to another.
    work
        (m, n)
    last
        (m, n) the leg to where the robot must end; 0 where it may end anywhere.
    """

    scale: Scale
    longest: int
    first: Whole
    between: Whole
    work: Whole
    last: Whole

    @classmethod
    def of(cls, problem: Problem, *, sums: int = 1, begin: float = 0.0) -> Costs:
        """The costs in the problem's usage; `sums`: of how many routes; `begin`: what a route begins with at most."""
        first, between, work, last = real_costs(problem)
        real = [np.where(np.isfinite(some), some, 0.0) for some in (first, between, work, last)]
        route = float(real[0].max() + (real[1].max(axis=(0, 1)) + real[2].max(axis=0)).sum() + real[3].max())
        scale = Scale.of(problem, (begin + route) * sums)
        return cls(scale, scale.at_most(begin + route), *(scale.down(some) for some in (first, between, work, last)))

    def usage(self, i: int, route: Sequence[int]) -> int:
        """What a route of robot i costs."""
        if not route:
            return 0
        steps = sum(int(self.between[i, a, b]) for a, b in pairwise(route))
        work = sum(int(self.work[i, j]) for j in route)
        return int(self.first[i, route[0]]) + steps + work + int(self.last[i, route[-1]])


def real_costs(problem: Problem) -> RealCosts:
    """`first`, `between`, `work` and `last` of all robots; inf where there is no leg."""
    tasks = np.arange(len(problem.tasks))
    robots = range(len(problem.robots))
    ways = [_ways(problem, i) for i in robots]
    return (
        np.array([ways[i][problem.start(i), tasks] for i in robots]),
        np.array([ways[i][np.ix_(tasks, tasks)] for i in robots]),
        np.array([problem.work_usage(i) for i in robots]),
        np.array([_last(problem, i, ways[i]) for i in robots]),
    )


def _ways(problem: Problem, i: int) -> Floats:
    """(places, places) usage between places; where a table may make ways through stations shorter, the least."""
    places = np.arange(len(problem.tasks) + 2 * len(problem.robots) + len(problem.stations))
    ways = problem.legs(i, places, places)
    for k in places[len(places) - len(problem.stations) :] if len(problem.travel[0]) else ():
        ways = np.minimum(ways, ways[:, k, None] + ways[None, k, :])
    return np.asarray(ways)


def real_usage(costs: RealCosts, i: int, route: Sequence[int], *, ends: bool = True) -> float:
    """What a route of robot i uses by itself, without calls at stations; `ends`: with the way to its end."""
    first, between, work, last = costs
    usage = first[i, route[0]] + sum(between[i, a, b] for a, b in pairwise(route)) + work[i, list(route)].sum()
    return float(usage + (last[i, route[-1]] if ends else 0.0))


def _last(problem: Problem, i: int, ways: Floats) -> Floats:
    tasks = np.arange(len(problem.tasks))
    if problem.robots[i].place_at_end(problem.mission.rules) is None:
        return np.zeros(len(tasks))
    return np.asarray(ways[tasks, problem.end(i)])


def like_robots(problem: Problem, usable: Bools) -> list[list[int]]:
    """Robots in groups whose members could change places in any plan."""
    groups: dict[tuple[bytes, object], list[int]] = {}
    first, between, work, last = real_costs(problem)
    for i, robot in enumerate(problem.robots):
        pace = robot.speed_mps, robot.efficiency, robot.available_from_s, problem.capacity[i]
        own = i if problem.beginning(i) else -1
        parts = [usable[i], first[i], between[i], work[i], last[i], np.array(pace), np.array(own)]
        key = b"".join(part.tobytes() for part in parts), problem.model.of_robot(i)
        groups.setdefault(key, []).append(i)
    return list(groups.values())


def ancestors(problem: Problem) -> list[set[int]]:
    """For each task all tasks that must come before it."""
    before: list[set[int]] = [set() for _ in problem.tasks]

    def fill(j: int) -> set[int]:
        for k in problem.model.awaited[j] if not before[j] else ():
            before[j] |= {k} | fill(k)
        return before[j]

    for j in range(len(problem.tasks)):
        fill(j)
    return before
