"""Crossover of two plans: selective route exchange ([nagata2010])."""

from __future__ import annotations

from random import Random

from muster import core
from muster.allocation.algorithms import greedy
from muster.allocation.allocator import Routes
from muster.model.problem import Problem


def crossed(problem: Problem, routes: Routes, other: Routes, random: Random) -> Routes:
    """A child of two plans: some robots have their routes of the other plan, the rest those of the first.

    The robots chosen do nearly the same tasks in both plans. Of a task that would be done twice, one of the two plans,
    drawn by lot, has its way; tasks that neither part holds are put in greedily. The child is the first plan where the
    two are the same, and where their mixture is not admissible, as prerequisites may have it.
    """
    differing = [i for i, route in enumerate(routes) if list(route) != list(other[i])]
    if not differing:
        return routes
    chosen = _chosen(routes, other, differing, random)
    parts = [other[i] if i in chosen else routes[i] for i in range(len(routes))]
    first_to_stay = random.random() < 0.5
    held = {j for i, part in enumerate(parts) if (i in chosen) is first_to_stay for j in part}
    child = [
        list(part) if (i in chosen) is first_to_stay else [j for j in part if j not in held]
        for i, part in enumerate(parts)
    ]
    return greedy.completed(problem, child) if core.Inspection(problem.core, child).admissible else routes


def _chosen(routes: Routes, other: Routes, differing: list[int], random: Random) -> set[int]:
    """Up to half of the robots: one by lot, then always the one by which the tasks that they do differ least."""
    tasks = {i: (set(routes[i]), set(other[i])) for i in differing}
    chosen = {first := random.choice(differing)}
    here, there = map(set, tasks[first])
    for _ in range(random.randrange(max(1, len(differing) // 2))):
        left = [i for i in differing if i not in chosen]
        nearest = min(left, key=lambda i: len((here | tasks[i][0]) ^ (there | tasks[i][1])))
        chosen.add(nearest)
        here |= tasks[nearest][0]
        there |= tasks[nearest][1]
    return chosen
