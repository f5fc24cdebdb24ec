"""Which sets of few tasks one robot can do, as far as times and relations tell."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from muster.allocation.bounds.feasibility import Legs
from muster.allocation.bounds.limits import Limits
from muster.model.plan_model import ROUNDING
from muster.model.problem import Bools, Floats, Problem


def subset_ends(limits: Limits, i: int, tasks: Sequence[int]) -> Floats:
    """(2**k,) the earliest end of a route of robot i with each set of k tasks; inf where one of them is too late.

    By dynamic programming over sets and their last task, as for usage; each task begins no earlier than it can whoever
    does it, and only when it may.
    """
    problem, rules, count = limits.problem, limits.rules, len(tasks)
    work = problem.work_seconds(i)
    ways = ways_of(problem, i, tasks, problem.travel_seconds, work)
    long = np.maximum(work, limits.shortest_work)[list(tasks)]
    after, until = followers(problem, tasks), rules.ends_by[list(tasks)] * (1 + ROUNDING)
    ends = np.full((1 << count, count), math.inf)  # by tasks done and the last of them

    def ended(k: int, arrival: float) -> float:
        j = tasks[k]
        begin = rules.next_begin(j, np.array([max(arrival, limits.ready[j])]))[0]
        end = float(max(begin, limits.begin[j]) + long[k])
        return end if end <= until[k] else math.inf

    for k in range(count):
        ends[1 << k, k] = ended(k, problem.robots[i].available_from_s + float(ways[0, k + 1]))
    for done in range(1, 1 << count):
        arrivals = (ends[done][:, None] + ways[1:-1, 1:-1]).min(axis=0)
        for k in range(count):
            if not done >> k & 1 and not done & after[k] and math.isfinite(arrivals[k]):
                ends[done | 1 << k, k] = ended(k, float(arrivals[k]))
    least = np.asarray((ends + ways[1:-1, -1]).min(axis=1, initial=math.inf))
    least[least > rules.over_by[i] * (1 + ROUNDING)] = math.inf
    least[0] = 0.0
    return least


def keep_relations(problem: Problem, tasks: Sequence[int]) -> Bools:
    """(2**k,) which sets of tasks one robot may do if all are done: all of one crew, and none of tasks of others."""
    rules, sets = problem.model, np.arange(1 << len(tasks))
    able = np.ones(len(sets), dtype=np.bool_)
    for k, j in enumerate(tasks):
        for at, other in enumerate(tasks[:k]):
            both = sets >> k & 1, sets >> at & 1
            if other in rules.same_crew[j]:
                able &= both[0] == both[1]
            if other in rules.apart[j] or other in rules.beginning_with(j):
                able &= (both[0] & both[1]) == 0
    return able


def ways_of(problem: Problem, i: int, tasks: Sequence[int], legs: Legs, work: Floats) -> Floats:
    """(k + 2, k + 2) least travel of robot i between its start, k tasks and its end."""
    places = [problem.start(i), *tasks, problem.end(i)]
    ways = least_ways(problem, i, places, legs, work)
    ways[:, [k for k, j in enumerate(tasks, 1) if not problem.allowed[i, j]]] = math.inf
    if problem.robots[i].place_at_end(problem.mission.rules) is None:
        ways[:, -1] = 0.0
    return ways


def least_ways(problem: Problem, i: int, places: Sequence[int], legs: Legs, work: Floats) -> Floats:
    """(p, p) least travel of robot i between places, ways through other tasks included with the work there."""
    through = [int(j) for j in problem.shortcuts() if problem.allowed[i, j]]
    nodes = [*places, *through]
    ways = legs(i, nodes, nodes)
    for at, j in enumerate(through, len(places)):
        ways = np.minimum(ways, ways[:, at, None] + work[j] + ways[None, at])
    return ways[: len(places), : len(places)].copy()


def followers(problem: Problem, tasks: Sequence[int]) -> list[int]:
    """For each of few tasks those that must come after it, as bits."""
    before = [_done_before(problem, j) for j in tasks]
    return [sum(1 << k for k in range(len(tasks)) if tasks[k] != j and j in before[k]) for j in tasks]


def _done_before(problem: Problem, j: int) -> set[int]:
    """The tasks that must be done before a task, or begin with one that must, and itself."""
    found, waiting = {j}, [j]
    while waiting:
        k = waiting.pop()
        new = {*problem.model.awaited[k], *problem.model.beginning_with(k)} - found
        found |= new
        waiting += new
    return found


def tied_pairs(problem: Problem, tasks: Sequence[int]) -> list[tuple[int, int]]:
    """Pairs of tasks of which it matters whether the same robots do them."""
    rules, chosen = problem.model, set(tasks)
    tied = ({*rules.same_crew[j], *rules.apart[j], *rules.beginning_with(j)} for j in tasks)
    return [(j, k) for j, others in zip(tasks, tied, strict=True) for k in sorted(others & chosen) if j < k]


def sizes_that_differ(problem: Problem, tasks: Sequence[int]) -> tuple[int, int] | None:
    """Two of the tasks that the same robots must do, though one needs more of them; None: there are none."""
    rules = problem.model
    pairs = ((j, k) for j, k in tied_pairs(problem, tasks) if k in rules.same_crew[j] and rules.sizes_differ(j, k))
    return next(pairs, None)
