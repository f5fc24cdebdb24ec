"""Moves of disc-shaped robots of one size over a roadmap, all planned at once, without stops or doors on the way."""

from __future__ import annotations

import math
from collections.abc import Sequence

from muster import core
from muster.traffic.roadmaps.edge_conflicts import WithConflicts, annotated


class MovesAtOnce:
    """Plans moves on one roadmap.

    Parameters
    ----------
    roadmap : WithConflicts
        Points and edges, metres in the map frame.
    margin_m : float
        Distance that bodies keep beside their radii, metres.
    """

    def __init__(self, roadmap: WithConflicts, *, margin_m: float) -> None:
        self._intervals = core.SafeIntervals(annotated(roadmap), [True] * len(roadmap.points), margin_m)

    def planned(
        self, starts: Sequence[int], goals: Sequence[int], *, radius_m: float, seed: int
    ) -> tuple[list[tuple[int, int]], Sequence[float]]:
        """Return robots and edges in an order in which these are free, and when each robot arrives at 1 m/s, seconds.

        `starts` and `goals` are points of the roadmap, one of each for a robot; inf: no way was found.
        """
        travellers = [_disc(start, goal, radius_m) for start, goal in zip(starts, goals, strict=True)]
        order = list(range(len(travellers)))
        moves, arrives_s = core.SharedWays(
            self._intervals, travellers, order=order, ways=0, seed=seed, at_once=True
        ).paths()
        return [(robot, edge) for _, robot, edge, _ in moves], arrives_s


def _disc(start: int, goal: int, radius_m: float) -> core.Traveller:
    return core.Traveller(
        start=start,
        stops=[(goal, 0.0)],
        radius=radius_m,
        speed=1.0,
        heading=0.0,
        yaw_rate=math.inf,
        acceleration=math.inf,
        ready=0.0,
        fixed=False,
        stays=False,
    )
