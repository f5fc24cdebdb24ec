"""The roadmap: points and straight lanes that robots share, and which of them are in each other's way.

A robot stands at a point or moves along an edge. Two robots of radii r_i and r_j are in each other's way where their
centres come nearer than r_i + r_j + margin. Which points an edge comes near to is worked out once, for two of the
widest robots, with the distances, as [hoenig2018] annotates roadmaps; for two smaller ones the distances tell.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.lanes import Lanes
from muster.mission.values.ranges import require_finite_positive
from muster.motion.free_space import GridSpace, PolygonSpace, Space
from muster.motion.grid import Grid
from muster.traffic.edge_conflicts import conflicts
from muster.traffic.exact_ways import Network
from muster.traffic.given_lanes import lane_network, speeds_along
from muster.traffic.lane_network import network
from muster.traffic.lane_sections import Section

Bools = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

MARGIN_M = 0.02
"""What two robots keep between them beyond touching."""
_SAME = 1e-9
_MOST_POINTS = 40_000
"""About as many points has a roadmap of open space at most: there the lattice is made coarser."""


@dataclass(frozen=True, eq=False)
class Roadmap:
    """Points, directed straight edges, and the conflicts between them; map frame.

    Parameters
    ----------
    points
        (n, 2) metres.
    narrow
        (n,): whether the room is for one there; everywhere on given lanes.
    edges
        (m, 2): from, to; numbers of points.
    clearance_m
        (m,): a robot of `radius_m` keeps at least so much more from every obstacle.
    radius_m, margin_m
        of the widest robot; what two robots keep between them beyond touching.
    reach_start, reach_point, reach_m
        (m + 1,), (l,), (l,): the points that a robot on edge k comes near to, by number, are
        `reach_point[reach_start[k]:reach_start[k + 1]]`; `reach_m` is how near its centre comes. The end of the edge is
        one of them, at 0. Not among them are its beginning, and the points from which it only moves away.
    places
        (k,): for each place that was to be joined its point; -1 where no way leads there.
    speed_mps
        (m,): the greatest speed on an edge; inf where robots alone decide.
    names
        of the first points, the nodes of given lanes; empty where the roadmap was made from free space.
    sections
        of lanes with a capacity, each for one robot: edges into one are said to come near to all points there.
    """

    points: Floats
    narrow: Bools
    edges: Indices
    clearance_m: Floats
    radius_m: float
    margin_m: float
    reach_start: Indices
    reach_point: Indices
    reach_m: Floats
    places: Indices
    speed_mps: Floats
    names: tuple[str, ...] = ()
    sections: tuple[Section, ...] = ()

    def keeping(self, edges: Bools) -> Roadmap:
        """The roadmap with some of its edges (m,) only."""
        counts = np.diff(self.reach_start)
        reached = np.repeat(edges, counts)
        return replace(
            self,
            edges=self.edges[edges],
            clearance_m=self.clearance_m[edges],
            reach_start=np.concatenate([[0], np.cumsum(counts[edges])]),
            reach_point=self.reach_point[reached],
            reach_m=self.reach_m[reached],
            speed_mps=self.speed_mps[edges],
        )

    @property
    def reach(self) -> float:
        """Metres: two of the widest robots whose centres are nearer are in each other's way."""
        return 2 * self.radius_m + self.margin_m

    @cached_property
    def lengths_m(self) -> Floats:
        """(m,)."""
        return np.asarray(np.linalg.norm(self.points[self.edges[:, 1]] - self.points[self.edges[:, 0]], axis=1))

    def speeds_along(self, pieces: Floats) -> Floats:
        """The greatest speed (k,) on straight pieces (k, 2, 2), metres: that of the edges on which they lie."""
        slow = np.isfinite(self.speed_mps)
        return speeds_along(pieces, self.points[self.edges[slow]], self.speed_mps[slow])

    @cached_property
    def one_way(self) -> Bools:
        """(m,): whether no edge leads back."""
        n = len(self.points)
        start, end = self.edges.T
        return ~np.isin(start * n + end, end * n + start)

    @cached_property
    def passable(self) -> Bools:
        """(n,): whether others get past a robot that rests at a point: no passage for one leads through it."""
        from muster.traffic.holding_places import passable

        return passable(self.points, self.edges, self.reach_start, self.reach_point, self.reach)

    @cached_property
    def holding(self) -> Bools:
        """(n,): whether a robot may rest at a point: others get past it, and it keeps nobody from another place."""
        from scipy.spatial import cKDTree

        places = np.unique(self.places[self.places >= 0])
        if not len(places):
            return self.passable
        near = cKDTree(self.points[places]).query_ball_point(self.points, self.reach * (1 - _SAME), return_length=True)
        own = np.zeros(len(self.points), dtype=np.int64)
        own[places] = 1
        return np.asarray(self.passable & (near <= own))

    @cached_property
    def out_start(self) -> Indices:
        """(n + 1,): the edges that begin at point u are those from `out_start[u]` to `out_start[u + 1]`."""
        return np.searchsorted(self.edges[:, 0], np.arange(len(self.points) + 1))

    def reached(self, edge: int) -> Indices:
        """The points that a robot on an edge comes near to."""
        return self.reach_point[self.reach_start[edge] : self.reach_start[edge + 1]]

    def point_at(self, x: float, y: float) -> int:
        """The nearest point that an edge leads to or from; of a place that was joined its own. Metres, map frame.

        Raises
        ------
        ParameterError
            for a roadmap without edges.
        """
        if self._tree is None:
            raise ParameterError("roadmap: no edges; expected some")
        _, k = self._tree.query((x, y))
        return int(self._joined[k])

    @cached_property
    def _joined(self) -> Indices:
        return np.unique(self.edges)

    @cached_property
    def _tree(self):  # type: ignore[no-untyped-def]
        from scipy.spatial import cKDTree

        return cKDTree(self.points[self._joined]) if len(self._joined) else None

    @classmethod
    def of(
        cls, space: Space | None, radius_m: float, places: npt.ArrayLike = (), *, margin_m: float = MARGIN_M
    ) -> Roadmap:
        """The roadmap of a free space, or of the open area around some places.

        Parameters
        ----------
        space
            free for the centre of the widest robot: `World.free_space(radius_m, "ground", three_d=False)`; None for
            the open plane.
        radius_m
            of the widest robot; greater than 0.
        places
            (k, 2) or (k, 3): starts of robots and places of tasks, metres in the map frame; each gets a point of its
            own.

        Raises
        ------
        ParameterError
            for a space with heights, a radius or margin that is not a finite number above 0, or neither space nor
            places.
        """
        apart_m, points = _checked(radius_m, margin_m, places)
        if space is None and len(points):
            space = _open(points, apart_m)
        if not isinstance(space, GridSpace | PolygonSpace):
            raise ParameterError("space: with heights or empty; expected the plane, or None and some places")
        return cls.joined(network(space, apart_m, points, _MOST_POINTS), radius_m, margin_m)

    @classmethod
    def of_lanes(
        cls,
        lanes: Lanes,
        radius_m: float,
        places: npt.ArrayLike = (),
        *,
        space: Space | None = None,
        margin_m: float = MARGIN_M,
    ) -> Roadmap:
        """The roadmap of given lanes, without those that are too narrow or lead through an obstacle; else as `of`.

        Places are joined to the nearest point that a straight way leads to; the first points are the nodes, in order.
        """
        apart_m, points = _checked(radius_m, margin_m, places)
        if not isinstance(space, GridSpace | PolygonSpace | None):
            raise ParameterError("space: with heights; expected the plane, or None")
        made, speeds, sections = lane_network(lanes, radius_m, apart_m, points, space, most_points=_MOST_POINTS)
        return cls.joined(made, radius_m, margin_m, speed_mps=speeds, names=tuple(lanes.nodes), sections=sections)

    @classmethod
    def joined(
        cls,
        made: Network,
        radius_m: float,
        margin_m: float,
        *,
        speed_mps: Floats | None = None,
        names: tuple[str, ...] = (),
        sections: tuple[Section, ...] = (),
    ) -> Roadmap:
        """The roadmap of a network of points and directed edges, with its conflicts."""
        order = np.lexsort(made.edges.T[::-1])
        edges = made.edges[order]
        start, point, metres = conflicts(made.points, edges, 2 * radius_m + margin_m, sections)
        return cls(
            points=made.points,
            narrow=made.narrow,
            edges=edges,
            clearance_m=made.clearance_m[order],
            radius_m=radius_m,
            margin_m=margin_m,
            reach_start=start,
            reach_point=point,
            reach_m=metres,
            places=made.places,
            speed_mps=np.full(len(edges), np.inf) if speed_mps is None else speed_mps[order],
            names=names,
            sections=sections,
        )


def _checked(radius_m: float, margin_m: float, places: npt.ArrayLike) -> tuple[float, Floats]:
    """How far apart two robots do not touch, and the places (k, 2)."""
    require_finite_positive(radius_m=radius_m, margin_m=margin_m)
    given = np.asarray(places, dtype=np.float64)
    return 2 * radius_m + margin_m, given[:, :2] if given.size else np.zeros((0, 2))


def _open(points: Floats, apart_m: float) -> GridSpace:
    """The open plane around points, with room for some robots to pass on every side."""
    low, high = points.min(axis=0) - 4 * apart_m, points.max(axis=0) + 4 * apart_m
    cell = max(apart_m / 6, float((high - low).max()) / 1000)
    columns, rows = np.ceil((high - low) / cell).astype(int)
    return GridSpace(Grid(np.zeros((rows, columns), dtype=np.bool_), cell, (float(low[0]), float(low[1]), 0.0)))
