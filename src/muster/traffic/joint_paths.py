"""Multi-agent path finding: paths on a graph for all robots at once, step by step ([stern2019]).

Priority inheritance with backtracking, PIBT ([okumura2022]), makes the steps, with the swap of [okumura-star2023]. The
search over configurations with lazily added constraints, LaCAM ([okumura2023]), makes it complete: where there are
paths it finds them, given time, and where there are none it proves that in the end. With `anytime` it goes on to better
ones, as LaCAM* does ([okumura-star2023]). Both are in the core.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.clock import Clock, SystemClock
from muster.mission.errors import ParameterError

Bools = npt.NDArray[np.bool_]
Indices = npt.NDArray[np.int64]
_AT_ONCE = 200
"""Expansions between two looks at the clock."""
_MOST_ENTRIES = 40_000_000
"""Robots times configurations that are kept at most: a few hundred bytes each configuration and some for each robot."""


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`samples`: next configurations that are tried in each step, of which the best one counts ([okumura2024] has 10).

    `anytime`: go on to better paths until time or expansions are used up.
    """

    samples: int = 1
    anytime: bool = False

    def __post_init__(self) -> None:
        if self.samples < 1:
            raise ParameterError(f"samples: {self.samples}; expected at least 1")


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
        of the search.
    """

    vertices: Indices
    optimal: bool
    expansions: int


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
        same seed gives the same paths; `time_limit` alone does so where it is not reached and `params.anytime` is off.

    Raises
    ------
    ParameterError
        if two robots have one start, if starts and goals are not as many, or are no vertices.
    """
    params, clock = params or Parameters(), clock or SystemClock()
    _check(graph, starts, goals)
    begin = clock.now()
    if len(set(goals)) < len(goals):
        return NoJointPaths(True, "two robots have one goal")
    search = core.Lacam(graph, list(starts), list(goals), samples=params.samples, seed=seed, anytime=params.anytime)
    if not search.connected:
        return NoJointPaths(True, "a goal cannot be reached from its start")
    done = 0
    while search.state == "searching" or (params.anytime and search.state == "solved"):
        left = _AT_ONCE if expansions is None else min(_AT_ONCE, expansions - done)
        late = time_limit is not None and clock.now() - begin >= time_limit
        if left <= 0 or late or search.nodes * len(goals) > _MOST_ENTRIES:
            break
        search.advance(left)
        done += left
    if search.state == "unsolvable":
        return NoJointPaths(True, f"all {search.nodes} configurations that can be reached were seen")
    if search.state == "searching":
        return NoJointPaths(False, f"not found with {done} expansions, {search.nodes} configurations seen")
    return JointPaths(np.array(search.solution(), dtype=np.int64), search.state == "optimal", done)


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
