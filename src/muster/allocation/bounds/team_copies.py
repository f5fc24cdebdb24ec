"""A problem in which every task of a team stands once for each robot that it needs at least.

What single robots pay for the copies is what the team's members pay for the task, so that bounds of sums over routes
hold for teams too.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from muster.model.problem import Bools, Problem


@dataclass(frozen=True)
class Copied:
    """The problem with the copies, and its usable pairs (m, n)."""

    problem: Problem
    usable: Bools


def with_copies(problem: Problem, usable: Bools) -> Copied | None:
    """The problem with a copy of each task for each robot that it needs at least; itself where one robot does each.

    Alternatives are left out, as nothing is known of which one is done. None where there is nothing else, and where a
    way through a task can be shorter than the direct one: then an alternative, or one more robot of a team that may be
    larger than that, could make a route cheaper.
    """
    rules = problem.model
    if not rules.with_teams and not rules.alternatives:
        return Copied(problem, usable)
    sure = sorted(set(range(len(problem.tasks))).difference(*rules.alternatives))
    more = bool(rules.alternatives) or any(rules.sums(j) for j in sure)
    if not sure or (more and len(problem.shortcuts())):
        return None
    copies = np.repeat(sure, [rules.least_members(j) for j in sure])
    return Copied(of_tasks(problem, copies.tolist()), usable[:, copies])


def of_tasks(problem: Problem, copies: list[int]) -> Problem:
    """The problem of these tasks, some of them named several times; of use for lengths alone."""
    n, m, s = len(problem.tasks), len(problem.robots), len(problem.stations)
    known = None
    if len(problem.travel[0]):
        places = [*copies, *range(n, n + 2 * m + s)]
        known = problem.measured.part(range(m), places, copies)
    return replace(problem, tasks=tuple(problem.tasks[j] for j in copies), known=known, fixed=())
