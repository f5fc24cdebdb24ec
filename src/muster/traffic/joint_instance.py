"""Instances of joint paths: a graph, where its vertices are, and robots with a start and a goal each."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from muster import core
from muster.mission.values.arrays import Floats, Indices


@dataclass(frozen=True, eq=False)
class JointInstance:
    """Robots on a graph, with a start and a goal each.

    Parameters
    ----------
    name : str
        What is shown of it.
    graph : core.DirectedGraph
        The graph whose edges robots take.
    edges : list[tuple[int, int]]
        The vertices that each edge joins.
    places : Floats
        (n, 2), where each vertex is: x and y, as cells of a map or metres of a mission.
    robots : list[str]
        The name of each robot.
    starts, goals : list[int]
        The vertex of each robot.
    """

    name: str
    graph: core.DirectedGraph
    edges: list[tuple[int, int]]
    places: Floats
    robots: list[str]
    starts: list[int]
    goals: list[int]

    @classmethod
    def of_edges(
        cls, name: str, places: Floats, edges: Indices, robots: list[str], starts: list[int], goals: list[int]
    ) -> JointInstance:
        """Return an instance on the graph of directed edges, (m, 2) from and to."""
        tails, heads = edges[np.argsort(edges[:, 0], kind="stable")].T
        first = np.concatenate([[0], np.cumsum(np.bincount(tails, minlength=len(places)))])
        graph = core.DirectedGraph(first.tolist(), heads.tolist(), [1.0] * len(heads))
        joined = [(int(tail), int(head)) for tail, head in edges.tolist()]
        return cls(name, graph, joined, places, robots, starts, goals)
