"""Strings: how metaheuristics write plans down; their fitness; and the best plan that any of them stood for.

A string has a symbol for each task, 0 to n - 1, and a marker for each robot, n to n + m - 1. It is read as a ring: a
marker begins the robot's subtour, which the next marker ends ([tang2000] has such strings of cities and salesmen).
What rules forbid in a string is repaired where it is decoded (`core.Decoder`), so that every string stands for an
admissible plan. Figures of plans are (k, 4): weight, objective, total and greatest usage.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import numpy.typing as npt

from muster import core
from muster.allocation.allocator import Routes
from muster.allocation.stop import Stop
from muster.mission.values.arrays import Floats, Indices
from muster.model.problem import Problem

Strings = npt.NDArray[np.int32]


def random_strings(problem: Problem, count: int, random: np.random.Generator) -> Strings:
    """(count, n + m) strings."""
    symbols = np.arange(len(problem.tasks) + len(problem.robots), dtype=np.int32)
    return random.permuted(np.tile(symbols, (count, 1)), axis=1)


def string_of(problem: Problem, routes: Routes) -> Strings:
    """(n + m,) the string of routes; tasks left out stand at its end."""
    n = len(problem.tasks)
    symbols = [symbol for i, route in enumerate(routes) for symbol in (n + i, *route)]
    left = np.setdiff1d(np.arange(n), symbols)
    return np.array([*symbols, *left.tolist()], dtype=np.int32)


def read(problem: Problem, strings: Strings) -> tuple[Strings, Strings]:
    """The order of the tasks, (k, n), and for each task its robot, (k, n)."""
    n, (count, length) = len(problem.tasks), strings.shape
    begins = np.argmax(strings >= n, axis=1)  # from its first marker on, a ring is a line
    lines = np.take_along_axis(strings, (begins[:, None] + np.arange(length)) % length, axis=1)
    marked = lines >= n
    marker_at = np.maximum.accumulate(np.where(marked, np.arange(length), 0), axis=1)
    robot_at = np.take_along_axis(lines, marker_at, axis=1) - n
    tasks, robots = lines[~marked].reshape(count, n), np.empty((count, n), dtype=np.int32)
    np.put_along_axis(robots, tasks, robot_at[~marked].reshape(count, n), axis=1)
    return np.ascontiguousarray(tasks), robots


class Decoded:
    """Strings decoded to plans, generation after generation; keeps the best plan of all."""

    def __init__(self, problem: Problem, stop: Stop, start: Routes | None = None) -> None:
        self._problem = problem
        self._decoder = core.Decoder(problem.core)
        self.best = Best(problem, stop, start)

    def figures(self, strings: Strings) -> Floats:
        """(k, 4) of the plans that strings stand for."""
        figures = self._decoder.in_order(*read(self._problem, strings))
        self.best.note(figures, self._decoder.routes)
        return figures

    def routes(self, strings: Strings) -> list[Routes]:
        """The plans that strings stand for."""
        self.figures(strings)
        return [self._decoder.routes(k) for k in range(len(strings))]


class Best:
    """The best plan seen so far, the start plan to begin with."""

    def __init__(self, problem: Problem, stop: Stop, start: Routes | None = None) -> None:
        self.routes: Routes = start or [[] for _ in problem.robots]
        self._stop = stop
        self._value = problem.value(self.routes)
        if start is not None:
            stop.improved(*self._value)
        self._noted = start is not None

    @property
    def objective(self) -> float:
        return self._value[1]

    def note(self, figures: Floats, routes: Callable[[int], Routes]) -> None:
        """Keep the best plan of a generation if it is the best so far."""
        k = int(ranking(figures)[0])
        weight, objective = float(figures[k, 0]), float(figures[k, 1])
        if self._noted and (-weight, objective) >= (-self._value[0], self._value[1]):
            return
        self._noted, self._value, self.routes = True, (weight, objective), routes(k)
        self._stop.improved(weight, objective)


def ranking(figures: Floats) -> Indices:
    """The plans from the best to the worst: more weight first, then the lower objective."""
    return np.asarray(np.lexsort((figures[:, 1], -figures[:, 0])))


def fitness(figures: Floats) -> Floats:
    """(k,) for a roulette wheel: how far the objective is below that of the worst plan, plus a tenth of the range.

    A plan that does less than the best one has a tenth of that of the worst that does as much.
    """
    most = figures[:, 0] == figures[:, 0].max()
    objective, worst = figures[:, 1], figures[most, 1].max()
    least = 0.1 * (worst - figures[most, 1].min()) or 1.0
    return np.where(most, worst - objective + least, 0.1 * least)


def roulette(figures: Floats, count: int, random: np.random.Generator) -> Indices:
    """(count,) plans drawn by their fitness [goldberg1989]."""
    return spun(fitness(figures), count, random)


def spun(weights: Floats, count: int, random: np.random.Generator) -> Indices:
    """(count,) indices drawn with chances in proportion to weights."""
    edges = np.cumsum(weights)
    drawn = np.searchsorted(edges, random.random(count) * edges[-1], side="right")
    return np.asarray(np.minimum(drawn, len(weights) - 1))


def diversity(strings: Strings) -> float:
    """The mean share of places at which two plans of a generation differ, 0 (all alike) to 1.

    Of (k, length) rows; computed for each place from how often a symbol stands there.
    """
    count, length = strings.shape
    if count < 2 or not length:
        return 0.0
    ordered = np.sort(strings, axis=0)
    new = np.ones_like(ordered, dtype=np.bool_)
    new[1:] = ordered[1:] != ordered[:-1]
    groups = np.cumsum(new.T.ravel())
    sizes = np.bincount(groups).astype(np.float64)
    alike = float((sizes * (sizes - 1)).sum())
    return float(1.0 - alike / (length * count * (count - 1)))
