"""Hysteresis: which changes of better routes are worth it, as every change of robots costs people and robots something.

Robots that exchange tasks are looked at together, apart from all others.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass

from muster.allocation.allocator import Routes
from muster.allocation.fixed import value_of
from muster.mission.task_relations import joined
from muster.model.problem import Problem

SWITCH_GAIN, SWITCH_GAIN_UNDER_WAY = 0.05, 0.2
"""What a task that changes robots must make the objective better by, as a share of what a task ahead costs it on
average: one that waits in a route, and one that its robot is on the way to."""
NEARLY_THERE_S = 5.0
"""A robot is nearly there that is so many seconds from the task it is on the way to, or waits at it: it keeps it."""
_BETTER = 1e-6
"""By which share of the objective routes must be better that move no task to another robot."""


@dataclass(frozen=True)
class Heading:
    """The task that a robot is on the way to or waits at, and whether it is nearly there."""

    task: str
    is_near: bool


def worthwhile(
    problem: Problem, now: Routes, then: Routes, headings: Mapping[str, Heading], *, most: int | None = None
) -> Routes:
    """The routes as they are now, with those changes that are worth it.

    Parameters
    ----------
    now, then
        admissible routes, and better ones.
    headings
        of those robots that are on the way, by id.
    most
        how many tasks may change robots; None: any number.
    """
    best, value = now, value_of(problem, now)
    mean, on_way = _mean_ahead(problem, now, value.objective), {one.task for one in headings.values()}
    near = {
        problem.robot_index[robot]: problem.task_index[one.task]
        for robot, one in headings.items()
        if one.is_near and robot in problem.robot_index and one.task in problem.task_index
    }

    def least_gain(moved: Collection[int]) -> float:
        return mean * sum(SWITCH_GAIN_UNDER_WAY if problem.tasks[j].id in on_way else SWITCH_GAIN for j in moved)

    for robots in (*_exchanges(problem, now, then), range(len(now))):
        changed = [list(then[i] if i in robots else route) for i, route in enumerate(best)]
        tried = _with_near_first(problem, changed, near)
        moved = _moved(now, tried)
        if tried == best or (most is not None and len(moved) > most) or not _keeps(problem, tried, near):
            continue
        found = value_of(problem, tried)
        least = max(_BETTER * abs(value.objective), least_gain(moved - _moved(now, best)))
        better = found.weight == value.weight and found.objective < value.objective - least
        if found.admissible and (found.weight > value.weight or better):
            best, value = tried, found
    return best


def _mean_ahead(problem: Problem, routes: Routes, objective: float) -> float:
    """What a task that lies ahead costs the objective on average."""
    begun = [list(problem.beginning(i)) for i in range(len(routes))]
    ahead = sum(map(len, routes)) - sum(map(len, begun))
    return max(0.0, objective - value_of(problem, begun).objective) / max(1, ahead)


def _exchanges(problem: Problem, now: Routes, then: Routes) -> Iterator[set[int]]:
    """The robots whose routes change, in sets that exchange tasks, or share some."""
    robots = range(len(now))
    changed = [i for i in robots if now[i] != then[i]]
    own: dict[int, list[int]] = {}
    for i in changed:
        for j in {*now[i], *then[i]}:
            own.setdefault(j, []).append(i)
    first = joined(((who[0], i) for who in own.values() for i in who[1:]), len(now))
    for k in dict.fromkeys(first[i] for i in changed):
        yield {i for i in changed if first[i] == k}


def _moved(now: Routes, then: Routes) -> set[int]:
    """The tasks that have a robot now, and another one then."""
    before, after = robots_of(now), robots_of(then)
    return {j for j, robots in after.items() if before.get(j, robots) != robots}


def robots_of(routes: Sequence[Sequence[int]]) -> dict[int, frozenset[int]]:
    """For each task of some routes, by index, the robots that do it."""
    robots: dict[int, set[int]] = {}
    for i, route in enumerate(routes):
        for j in route:
            robots.setdefault(j, set()).add(i)
    return {j: frozenset(team) for j, team in robots.items()}


def _with_near_first(problem: Problem, routes: Routes, near: Mapping[int, int]) -> Routes:
    """The routes in which robots that are nearly at a task go on to it, and nobody else does a task for one robot."""
    kept = [list(route) for route in routes]
    for i, j in near.items():
        begun = len(problem.beginning(i))
        if kept[i][begun : begun + 1] == [j]:
            continue
        for route in kept if j not in kept[i] else [kept[i]]:
            if j in route:
                route.remove(j)
        kept[i].insert(begun, j)
    return kept


def _keeps(problem: Problem, routes: Routes, near: Mapping[int, int]) -> bool:
    """Whether robots that are nearly at a task go on to it."""
    return all(routes[i][len(problem.beginning(i)) :][:1] == [j] for i, j in near.items())
