"""Large teams: divided in space, each part improved in parallel, then divided differently and improved again.

The first division goes by where robots start and tasks lie; the later ones by where routes run, along other lines, so
that what was a border lies within a part. Robots keep their routes from one division to the next, so the plan never
gets worse; with the objectives `max` and `makespan` a part sees only its own greatest robot.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from muster import core
from muster.allocation.algorithms import greedy
from muster.allocation.allocator import Routes
from muster.allocation.search.workers import Improve, Job, Limits, Offer, Workers
from muster.allocation.stop import Stop
from muster.model.problem import Floats, Indices, Problem

_MOST_WHOLE = 15_000  # tasks up to which a team is searched as a whole
_IN_A_PART = 1_500  # tasks
_DIVISIONS = 4
_SECONDS = 10.0  # for each part where nothing is limited


def number_of_parts(tasks: int) -> int:
    """Into how many parts a team with so many tasks is divided."""
    return 1 if tasks <= _MOST_WHOLE else math.ceil(tasks / _IN_A_PART)


@dataclass(frozen=True)
class Part:
    """Robots and tasks that are planned together, ascending."""

    robots: list[int]
    tasks: list[int]


def improve_in_parts(
    problem: Problem, stop: Stop, seed: int, parts: int, workers: Workers, start: Routes | None, improve: Improve
) -> Routes:
    """Divide, improve every part, and divide otherwise, until it is time to stop."""
    routes = [list(route) for route in start or [[]] * len(problem.robots)]
    for division in range(_DIVISIONS):
        began_s = stop.elapsed_s
        pieces = list(divide(problem, routes, parts, division))
        further = _DIVISIONS - division - 1
        kept_s = further * (stop.elapsed_s - began_s)  # for dividing again
        limits = _limits(stop, further + 1, len(pieces), workers.count, kept_s)
        team = _Team(problem, routes)
        jobs = [_job(problem, piece, routes, seed + k, limits, improve) for k, piece in enumerate(pieces)]
        for piece, job, made in zip(pieces, jobs, workers.map(jobs, stop), strict=True):
            offer = made or job.offer(greedy.completed(job.part, job.routes))
            if team.takes(piece, offer):
                for i, route in zip(piece.robots, offer.routes, strict=True):
                    routes[i] = [piece.tasks[k] for k in route]
        stop.iterations_done += (limits.iterations or 0) * len(pieces)
        stop.improved(*problem.value(routes))
        if stop.due():
            break
    return greedy.allocate(problem, stop, seed, greedy.Parameters(), routes).routes


def _job(problem: Problem, piece: Part, routes: Routes, seed: int, limits: Limits, improve: Improve) -> Job:
    number_in = {j: k for k, j in enumerate(piece.tasks)}
    own = [[number_in[j] for j in routes[i]] for i in piece.robots]
    return Job(problem.part(piece.robots, piece.tasks), seed, own, limits, improve)


class _Team:
    """Tells what is good for a part from what is good for all."""

    def __init__(self, problem: Problem, routes: Routes) -> None:
        self._sees_both = problem.objective == "total+max"  # the others do not get worse where no part does
        self._usages = np.array(core.Inspection(problem.core, routes).usages)

    def takes(self, piece: Part, offer: Offer) -> bool:
        """Whether the plan is no worse for it; if so it counts from now on."""
        before = self._usages[piece.robots]
        self._usages[piece.robots] = 0.0
        others = float(self._usages.max())
        worse = self._sees_both and not offer.does_more and _cost(offer.usages, others) > _cost(before, others)
        self._usages[piece.robots] = before if worse else offer.usages
        return not worse


def _cost(usages: Floats, others: float) -> float:
    return float(usages.sum()) + max(others, float(usages.max()))


def _limits(stop: Stop, divisions: int, parts: int, workers: int, kept_s: float) -> Limits:
    left, iterations = stop.time_left_s, stop.iterations_left
    if left is None and iterations is None:
        return Limits(_SECONDS, None)
    turns = divisions * math.ceil(parts / workers)
    return Limits(
        None if left is None else max(0.0, left - kept_s) / turns,
        None if iterations is None else max(1, iterations // (divisions * parts)),
    )


@dataclass(frozen=True)
class _Atoms:
    """What is not to be divided: a robot with its route, tasks that wait for each other, and what these join.

    Of each its robots, its tasks and where in the plane it is, (k, 2).
    """

    robots: list[list[int]]
    tasks: list[list[int]]
    places: Floats

    @cached_property
    def robot_counts(self) -> Indices:
        return np.array(list(map(len, self.robots)), dtype=np.int64)

    @cached_property
    def task_counts(self) -> Indices:
        return np.array(list(map(len, self.tasks)), dtype=np.int64)

    def part(self, own: Indices) -> Part:
        """Some of the atoms as a part."""
        robots, tasks = (sorted(x for k in own.tolist() for x in items[k]) for items in (self.robots, self.tasks))
        return Part(robots, tasks)


def divide(problem: Problem, routes: Routes, parts: int, division: int) -> Iterator[Part]:
    """Divide by straight lines, each across the longer side of what it divides, turned a bit for every division."""
    turn = math.pi * division / (2 * _DIVISIONS)
    turned = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])
    atoms = _atoms(problem, routes)
    places = atoms.places @ turned

    def cut(own: Indices, count: int) -> Iterator[Part]:
        if count == 1 or len(own) < 2:
            yield atoms.part(own)
            return
        along = places[own][:, int(np.argmax(np.ptp(places[own], axis=0)))]
        order = own[np.argsort(along, kind="stable")]
        manned = atoms.robot_counts[order] > 0
        share = (count // 2) / count
        robots = _parted(order[manned], share, atoms.robot_counts)
        tasks = _parted(order[~manned], share, atoms.task_counts)
        near, far = (np.concatenate(pair) for pair in zip(robots, tasks, strict=True))
        yield from cut(near, count // 2)
        yield from cut(far, count - count // 2)

    return (part for part in cut(np.arange(len(atoms.places)), parts) if part.robots)


def _parted(own: Indices, share: float, counts: Indices) -> tuple[Indices, Indices]:
    """The first atoms, up to a share of all that is counted, and the others."""
    sums = np.cumsum(counts[own])
    at = int(np.searchsorted(sums, share * sums[-1], side="right")) if len(sums) else 0
    return own[:at], own[at:]


def _atoms(problem: Problem, routes: Routes) -> _Atoms:
    """Robots with their routes and tasks in no route, joined where tasks wait for each other."""
    m = len(problem.robots)
    joined = list(range(m + len(problem.tasks)))

    def root(x: int) -> int:
        while joined[x] != x:
            joined[x] = x = joined[joined[x]]
        return x

    for i, route in enumerate(routes):
        for j in route:
            joined[root(m + j)] = root(i)
    for j, before in enumerate(problem.prerequisites):
        for k in before:
            joined[root(m + j)] = root(m + k)
    groups: dict[int, tuple[list[int], list[int]]] = {}
    for x in range(m + len(problem.tasks)):
        robots, tasks = groups.setdefault(root(x), ([], []))
        (robots if x < m else tasks).append(x if x < m else x - m)
    entries, starts = problem.places
    places = [_middle(entries, tasks) if tasks else _middle(starts, robots) for robots, tasks in groups.values()]
    robots_of, tasks_of = map(list, zip(*groups.values(), strict=True))
    return _Atoms(robots_of, tasks_of, np.array(places)[:, :2])


def _middle(places: Floats, of: list[int]) -> Floats:
    middle: Floats = places[of[0]] if len(of) == 1 else places[of].mean(axis=0)
    return middle
