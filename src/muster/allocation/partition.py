"""Large teams: divided in space, each part improved in parallel, then divided differently and improved again.

The first division goes by where robots start and tasks lie; the later ones by where routes run, along other lines, so
that what was a border lies within a part. Robots keep their routes from one division to the next, so the plan never
gets worse; with the objectives `max` and `makespan` a part sees only its own greatest robot.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from muster import core
from muster.allocation import greedy
from muster.allocation.allocator import Routes
from muster.allocation.problem import Floats, Problem
from muster.allocation.stop import Stop
from muster.allocation.workers import Improve, Job, Limits, Offer, Workers

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
        pieces = list(divide(problem, routes, parts, division))
        limits = _limits(stop, _DIVISIONS - division, len(pieces), workers.count)
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


def _limits(stop: Stop, divisions: int, parts: int, workers: int) -> Limits:
    left, iterations = stop.time_left_s, stop.iterations_left
    if left is None and iterations is None:
        return Limits(_SECONDS, None)
    turns = divisions * math.ceil(parts / workers)
    return Limits(
        None if left is None else left / turns,
        None if iterations is None else max(1, iterations // (divisions * parts)),
    )


@dataclass(frozen=True)
class _Atom:
    """What is not to be divided: a robot with its route, tasks that wait for each other, and what these join."""

    robots: list[int]
    tasks: list[int]
    place: Floats


def divide(problem: Problem, routes: Routes, parts: int, division: int) -> Iterator[Part]:
    """Divide by straight lines, each across the longer side of what it divides, turned a bit for every division."""
    turn = math.pi * division / (2 * _DIVISIONS)
    turned = np.array([[math.cos(turn), -math.sin(turn)], [math.sin(turn), math.cos(turn)]])

    def cut(atoms: Sequence[_Atom], count: int) -> Iterator[Part]:
        if count == 1 or len(atoms) < 2:
            robots, tasks = (sorted(x for atom in atoms for x in items(atom)) for items in (_robots, _tasks))
            yield Part(robots, tasks)
            return
        places = np.array([atom.place[:2] for atom in atoms]) @ turned
        along = places[:, int(np.argmax(np.ptp(places, axis=0)))]
        order = [atoms[k] for k in np.argsort(along, kind="stable").tolist()]
        share = (count // 2) / count
        manned, unmanned = ([a for a in order if bool(a.robots) is has] for has in (True, False))
        near, far = (
            a + b for a, b in zip(_parted(manned, share, _robots), _parted(unmanned, share, _tasks), strict=True)
        )
        yield from cut(near, count // 2)
        yield from cut(far, count - count // 2)

    return (part for part in cut(_atoms(problem, routes), parts) if part.robots)


def _robots(atom: _Atom) -> list[int]:
    return atom.robots


def _tasks(atom: _Atom) -> list[int]:
    return atom.tasks


def _parted(atoms: list[_Atom], share: float, items: Callable[[_Atom], list[int]]) -> tuple[list[_Atom], list[_Atom]]:
    """The first atoms, up to a share of all items, and the others."""
    sums = np.cumsum([len(items(atom)) for atom in atoms])
    at = int(np.searchsorted(sums, share * sums[-1], side="right")) if len(sums) else 0
    return atoms[:at], atoms[at:]


def _atoms(problem: Problem, routes: Routes) -> list[_Atom]:
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
    return [
        _Atom(robots, tasks, (entries[tasks] if tasks else starts[robots]).mean(axis=0))
        for robots, tasks in groups.values()
    ]
