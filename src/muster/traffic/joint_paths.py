"""Multi-agent path finding: paths on a graph for all robots at once, step by step ([stern2019]).

Priority inheritance with backtracking, PIBT ([okumura2022]), makes the steps, with the swap of [okumura-star2023]. The
search over configurations with lazily added constraints, LaCAM ([okumura2023]), makes it complete: where there are
paths it finds them, given time, and where there are none it proves that in the end. At first robots take ways that
avoid those who come the other way, by costs of edges that grow with their number ([chen2024]). With `anytime` it goes
on to better paths, as LaCAM* does ([okumura-star2023]); with `refine` a large neighbourhood search does that
([li2021]), which is better where robots are many, and proves nothing. All are in the core.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.system.clock import Clock, SystemClock
from muster.mission.values.arrays import Bools, Indices
from muster.mission.values.ranges import require_counts

_AT_ONCE = 100
"""Expansions in one call of the core, without a time limit."""
_SHARE = 0.005
"""The part of a time limit that one call of the core may take before calls become smaller."""
_MOST_ENTRIES = 40_000_000
"""Robots times configurations that are kept at most: a few hundred bytes each configuration and some for each robot."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`samples`: next configurations that are tried in each step, of which the best one counts ([okumura2024] has 10).

    `anytime`: go on to a smaller sum of loss until time or expansions are used up, or it is proven to be the least.
    `refine`: plan a few robots anew again and again, for a smaller sum of costs, until time or expansions are used up.
    """

    samples: int = 1
    anytime: bool = False
    refine: bool = False

    def __post_init__(self) -> None:
        require_counts(1, samples=self.samples)
        if self.anytime and self.refine:
            raise ParameterError("refine: with anytime; expected one of them")


@dataclass(frozen=True, eq=False)
class JointPaths:
    """Where the robots are, step by step.

    Parameters
    ----------
    vertices
        (steps + 1, robots): the vertex of each robot.
    optimal
        whether no paths have a smaller sum of loss: proven.
    expansions
        of the search, with the neighbourhoods of `refine`.
    least_sum
        the sum of the shortest paths of all robots, each alone: no sum of costs is smaller.
    """

    vertices: Indices
    optimal: bool
    expansions: int
    least_sum: int


@dataclass(frozen=True)
class NoJointPaths:
    """`proven`: there are none; else none was found in time and expansions."""

    proven: bool
    reason: str


def joint_paths(
    graph: core.DirectedGraph,
    starts: Sequence[int],
    goals: Sequence[int],
    *,
    time_limit: float | None = 10.0,
    expansions: int | None = None,
    seed: int = 0,
    params: Parameters | None = None,
    clock: Clock | None = None,
) -> JointPaths | NoJointPaths:
    """Paths for robots that each take an edge or stay in a step, never two at a vertex, never two changing places.

    Parameters
    ----------
    graph
        of which the costs do not count here: a step is an edge.
    starts, goals
        the vertex of each robot.
    time_limit, expansions
        the search ends after so many seconds or expansions; None: no limit of this kind. With `expansions` alone the
        same seed gives the same paths. With `refine` or `anytime` there must be one of them.

    Raises
    ------
    ParameterError
        if two robots have one start, if starts and goals are not as many, or are no vertices, or nothing ends `refine`.
    """
    params, clock = params or Parameters(), clock or SystemClock()
    _check(graph, starts, goals)
    if params.refine and time_limit is None and expansions is None:
        raise ParameterError("refine: without a limit; expected time_limit or expansions")
    effort = _Effort(clock, time_limit, expansions)
    if len(set(goals)) < len(goals):
        return NoJointPaths(True, "two robots have one goal")
    guidance = core.TrafficGuidance(graph, list(starts), list(goals), seed)
    while not guidance.finished:
        if not (more := effort.preparation()):
            return NoJointPaths(False, "not found with 0 expansions: the time was over before all robots had a way")
        guidance.advance(more)
    if not guidance.connected:
        return NoJointPaths(True, "a goal cannot be reached from its start")
    effort.begin_phase()
    search = core.Lacam(guidance, samples=params.samples, seed=seed, anytime=params.anytime)
    while search.state == "searching" or (params.anytime and search.state == "solved"):
        if search.nodes * len(goals) > _MOST_ENTRIES or not (more := effort.next()):
            break
        search.advance(more)
    if search.state == "unsolvable":
        return NoJointPaths(True, f"all {search.nodes} configurations that can be reached were seen")
    if search.state == "searching":
        return NoJointPaths(False, f"not found with {effort.done} expansions, {search.nodes} configurations seen")
    steps = search.solution()
    if params.refine:
        effort.begin_phase()
        refinement = core.JointRefinement(guidance, steps, seed)
        while refinement.cost > guidance.least_sum and (more := effort.next()):
            refinement.advance(more)
        steps = refinement.solution()
    return JointPaths(steps, search.state == "optimal", effort.done, guidance.least_sum)


class _Effort:
    """What may still be done. Under a time limit calls of the core grow and shrink, so that each takes little of it."""

    def __init__(self, clock: Clock, time_limit: float | None, expansions: int | None) -> None:
        self._clock, self._time_limit, self._expansions = clock, time_limit, expansions
        self._begin = self._last = clock.now()
        self.done = 0
        self.begin_phase()

    def begin_phase(self) -> None:
        """Begin with small calls: nothing is known of how long those of another kind take."""
        self._size = 1 if self._time_limit is not None else _AT_ONCE

    def next(self) -> int:
        """Return how many expansions to do now; 0 at the end."""
        size = self.preparation()
        more = size if self._expansions is None else min(size, self._expansions - self.done)
        self.done += more
        return more

    def preparation(self) -> int:
        """Return how many steps to do now that are no expansions; 0 at the end."""
        if self._time_limit is None:
            return self._size
        now = self._clock.now()
        share, self._last = (now - self._last) / max(self._time_limit, 1e-9), now
        self._size = max(1, int(self._size * _SHARE / share)) if share > _SHARE else min(2 * self._size, _AT_ONCE)
        return 0 if now - self._begin >= self._time_limit else self._size


def _check(graph: core.DirectedGraph, starts: Sequence[int], goals: Sequence[int]) -> None:
    if len(starts) != len(goals):
        raise ParameterError(f"goals: {len(goals)}; expected as many as starts, {len(starts)}")
    if len(set(starts)) < len(starts):
        raise ParameterError("starts: two robots at one vertex; expected a vertex of its own for each")
    for name, vertices in (("starts", starts), ("goals", goals)):
        for vertex in vertices:
            if not 0 <= vertex < graph.size:
                raise ParameterError(f"{name}: {vertex}; expected a vertex, 0 to {graph.size - 1}")


def grid_graph(blocked: Bools) -> tuple[core.DirectedGraph, Indices]:
    """The free cells with an edge to each free neighbour beside, above and below; and the vertex of each cell.

    Returns
    -------
    The graph, and (rows, columns) of its vertices, -1 where a cell is blocked.
    """
    free = ~np.asarray(blocked, dtype=np.bool_)
    numbers = np.full(free.shape, -1, dtype=np.int64)
    numbers[free] = np.arange(free.sum())
    padded = np.pad(numbers, 1, constant_values=-1)
    sides = (padded[1:-1, 2:], padded[2:, 1:-1], padded[1:-1, :-2], padded[:-2, 1:-1])
    around = np.stack([side[free] for side in sides], axis=1)
    first = np.concatenate([[0], np.cumsum((around >= 0).sum(axis=1))])
    heads = around[around >= 0]
    return core.DirectedGraph(first.tolist(), heads.tolist(), [1.0] * len(heads)), numbers


Cost = Literal["sum of costs", "sum of loss", "makespan"]


def costs(vertices: Indices, goals: Sequence[int]) -> dict[Cost, int]:
    """What paths cost, as the benchmarks count it.

    `sum of costs`: the step after which a robot rests at its goal for good, over all robots; `sum of loss`: the steps
    in which it does not rest there; `makespan`: the step after which all rest.
    """
    away = np.asarray(vertices) != np.asarray(goals)
    steps = np.arange(len(vertices))[:, None]
    arrived = np.where(away, steps + 1, 0).max(axis=0)
    loss = (away[:-1] | away[1:]).sum()
    return {"sum of costs": int(arrived.sum()), "sum of loss": int(loss), "makespan": int(arrived.max(initial=0))}
