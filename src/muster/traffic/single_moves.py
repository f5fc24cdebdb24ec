"""Plans for robots that share a roadmap: one sequence of single moves, each valid while all others stand.

Robots have radii. A robot on an edge must keep r_i + r_j + margin from all who stand, where it does not only move away
from them; the roadmap says which points are near which edge. Who carries a sequence out in the order of its conflicting
moves, all else at once, cannot run into a deadlock whatever is delayed ([hoenig2019]).

The sequence is made in rounds by priority inheritance with backtracking ([okumura2022]): a robot takes the best edge
towards its goal, after those who stand near it have made way, and those in their way in turn. Priorities grow until a
robot has been at its goal. Who rests is pushed aside and comes back. Two that meet where nobody can step aside change
places: one is sent off the way of the other, past it, as in push and swap ([luna2011]). Where rounds come to where they
were before, the search of LaCAM ([okumura2023]) goes on with constraints, until it has a plan or has seen everything.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal, Protocol

import numpy as np
import numpy.typing as npt

from muster import core
from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats, Indices
from muster.mission.values.ranges import require_counts

Outcome = Literal["arrived", "horizon", "unfinished", "impossible"]
NO_GOAL = -1


class AnnotatedRoadmap(Protocol):
    """What is asked of a roadmap; `muster.traffic.roadmap.Roadmap` is one.

    `points` (n, 2) metres; `edges` (m, 2) from and to, in the order of from; `speed_mps` (m,) the greatest on each;
    `reach_start` (m + 1,), `reach_point` (l,) and `reach_m` (l,): the points near edge k, and how near it comes, are at
    `reach_start[k]:reach_start[k + 1]`.
    """

    @property
    def points(self) -> Floats: ...
    @property
    def edges(self) -> Indices: ...
    @property
    def speed_mps(self) -> Floats: ...
    @property
    def reach_start(self) -> Indices: ...
    @property
    def reach_point(self) -> Indices: ...
    @property
    def reach_m(self) -> Floats: ...


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """How a plan is searched.

    Parameters
    ----------
    turn_m_per_rad
        metres that a turn by a radian costs, so that paths do not zigzag.
    horizon
        the plan may end after so many moves of all robots together, before all have been at their goals; None: never.
    settle
        whether all robots with a goal must be there at once in the end; else each must have been there.
    expansions
        the search gives up after so many steps in which no robot came nearer to its goal for good.
    tries
        so many plans are made, with random priorities from the second on; the one counts that is carried out soonest.
    """

    turn_m_per_rad: float = 0.3
    horizon: int | None = None
    settle: bool = False
    expansions: int = 2000
    tries: int = 8

    def __post_init__(self) -> None:
        if not self.turn_m_per_rad >= 0:
            raise ParameterError(f"turn_m_per_rad: {self.turn_m_per_rad}; expected at least 0")
        require_counts(1, horizon=self.horizon, expansions=self.expansions, tries=self.tries)


@dataclass(frozen=True)
class Moves:
    """A plan.

    Parameters
    ----------
    outcome
        `arrived`: all have been at their goals (with `settle` all are there); `horizon`: the plan ends before that;
        `unfinished`: nothing better was found, some do not arrive; `impossible`: it is proven that they cannot.
    moves
        (robot, edge) one after another.
    places
        the point where each robot stands in the end.
    arrived
        for each robot whether it has been at its goal, or has none.
    """

    outcome: Outcome
    moves: tuple[tuple[int, int], ...]
    places: tuple[int, ...]
    arrived: tuple[bool, ...]


def annotated(roadmap: AnnotatedRoadmap, costs: npt.ArrayLike | None = None) -> core.AnnotatedRoadmap:
    """A roadmap as the core has it; `costs` as `MovePlanner` takes them.

    Raises
    ------
    ParameterError
        if the arrays do not fit, or a cost is not above 0.
    """
    points, edges = np.asarray(roadmap.points, dtype=np.float64), np.asarray(roadmap.edges, dtype=np.int64)
    if np.any(np.diff(edges[:, 0]) < 0):
        raise ParameterError("edges: not in the order of their first points; expected so")
    lengths = np.linalg.norm(points[edges[:, 1]] - points[edges[:, 0]], axis=1) if costs is None else costs
    try:
        return core.AnnotatedRoadmap(
            np.ascontiguousarray(points),
            np.searchsorted(edges[:, 0], np.arange(len(points) + 1)).tolist(),
            edges[:, 1].tolist(),
            np.asarray(lengths, dtype=np.float64).tolist(),
            np.asarray(roadmap.speed_mps, dtype=np.float64).tolist(),
            np.asarray(roadmap.reach_start).tolist(),
            np.asarray(roadmap.reach_point).tolist(),
            np.asarray(roadmap.reach_m).tolist(),
        )
    except ValueError as error:
        raise ParameterError(f"roadmap: {error}") from None


class MovePlanner:
    """Plans on one roadmap; it keeps the ways to goals, so that the next plan with these goals comes sooner.

    Parameters
    ----------
    roadmap
        with annotated conflicts.
    costs
        (m,): what each edge costs, in metres; its length by default. Greater where waiting is to be expected.

    Attributes
    ----------
    shared
        the roadmap as the core has it, for other planners.

    Raises
    ------
    ParameterError
        if the arrays do not fit, or a cost is not above 0.
    """

    def __init__(self, roadmap: AnnotatedRoadmap, costs: npt.ArrayLike | None = None) -> None:
        self.shared = annotated(roadmap, costs)
        self._core = core.MovePlanner(self.shared)

    def planned(
        self,
        starts: Sequence[int],
        goals: Sequence[int | None],
        radii_m: Sequence[float],
        *,
        margin_m: float = 0.02,
        priorities: Sequence[float] | None = None,
        pinned: Sequence[bool] | None = None,
        seed: int = 0,
        params: Parameters | None = None,
    ) -> Moves:
        """A sequence of moves that brings each robot to its goal; the same for the same seed.

        Parameters
        ----------
        starts
            the point where each robot stands.
        goals
            the point to which each is to go; None: it stays, and makes way.
        radii_m, margin_m
            robots keep the sum of both radii and the margin.
        priorities
            at least 0: so many rounds a robot counts as having waited already.
        pinned
            who cannot move now: works, or is broken.

        Raises
        ------
        ParameterError
            if these do not fit each other or the roadmap, or two robots start at one point.
        """
        params = params or Parameters()
        try:
            outcome, moves, places, arrived = self._core.planned(
                list(starts),
                [NO_GOAL if goal is None else goal for goal in goals],
                list(radii_m),
                [0.0] * len(starts) if priorities is None else list(priorities),
                [False] * len(starts) if pinned is None else list(pinned),
                margin=margin_m,
                turn_cost=params.turn_m_per_rad,
                horizon=2**30 if params.horizon is None else params.horizon,
                settle=params.settle,
                expansions=params.expansions,
                tries=params.tries,
                seed=seed,
            )
        except ValueError as error:
            raise ParameterError(f"team: {error}") from None
        return Moves(outcome, tuple(moves), tuple(places), tuple(arrived))  # type: ignore[arg-type]
