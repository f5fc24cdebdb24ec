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

    None where teams may be larger than that and a way through a task can be shorter than the direct one: a robot more
    could make a route cheaper there.
    """
    rules = problem.model
    if not rules.with_teams:
        return Copied(problem, usable)
    tasks = range(len(problem.tasks))
    if len(problem.shortcuts()) and any(rules.sums(j) for j in tasks):
        return None
    copies = np.repeat(np.arange(len(tasks)), [rules.least_members(j) for j in tasks])
    return Copied(of_tasks(problem, copies.tolist()), usable[:, copies])


def of_tasks(problem: Problem, copies: list[int]) -> Problem:
    """The problem of these tasks, some of them named several times; of use for lengths alone."""
    n, m, s = len(problem.tasks), len(problem.robots), len(problem.stations)
    known = None
    if len(problem.travel[0]):
        places = [*copies, *range(n, n + 2 * m + s)]
        known = problem.measured.part(range(m), places, copies)
    return replace(problem, tasks=tuple(problem.tasks[j] for j in copies), known=known, fixed=())
