"""The roadmap: points and straight lanes that robots share, and which of them are in each other's way.

A robot stands at a point or moves along an edge. There is a layer of points and edges for each size of robots, made of
their own free space: no edge leads from one layer to another. Two robots of radii r_i and r_j are in each other's way
where their centres come nearer than r_i + r_j + margin, on whichever layers they are. Which points an edge comes near
to is worked out once, with the distances, as [hoenig2018] annotates roadmaps.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import cached_property
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from muster.mission.errors import ParameterError
from muster.mission.lanes import Lanes
from muster.mission.values.ranges import require_finite_positive
from muster.motion.free_space import GridSpace, PolygonSpace, Space
from muster.motion.grid import Grid
from muster.traffic.roadmaps.edge_conflicts import conflicts
from muster.traffic.roadmaps.exact_ways import Network
from muster.traffic.roadmaps.given_lanes import lane_network, speeds_along
from muster.traffic.roadmaps.lane_network import network
from muster.traffic.roadmaps.lane_sections import Section

Bools = npt.NDArray[np.bool_]
Floats = npt.NDArray[np.float64]
Indices = npt.NDArray[np.int64]

MARGIN_M = 0.02
"""What two robots keep between them beyond touching."""
_SAME = 1e-9
_MOST_POINTS = 40_000
"""About as many points has a roadmap of open space at most: there the lattice is made coarser."""


class Layer(NamedTuple):
    """Points and edges for robots up to a radius, with the greatest speeds (m,) and sections of lanes if it has such.

    `names` are those of the nodes of given lanes, its first points.
    """

    radius_m: float
    made: Network
    speed_mps: Floats | None = None
    sections: tuple[Section, ...] = ()
    names: tuple[str, ...] = ()


@dataclass(frozen=True, eq=False)
class Roadmap:
    """Points, directed straight edges, and the conflicts between them; map frame.

    Parameters
    ----------
    points
        (n, 2) metres.
    narrow
        (n,): whether the room is for one of its layer there; everywhere on given lanes.
    layer
        (n,): for the robots of which size a point is, by its number among `radii_m`.
    edges
        (m, 2): from, to; numbers of points.
    clearance_m
        (m,): the widest robot of its layer keeps at least so much more from every obstacle.
    radii_m, margin_m
        (k,) of the widest robot of each layer, in order; what two robots keep between them beyond touching.
    reach_start, reach_point, reach_m
        (m + 1,), (l,), (l,): the points that a robot on edge k comes near to, by number, are
        `reach_point[reach_start[k]:reach_start[k + 1]]`; `reach_m` is how near its centre comes. The end of the edge is
        one of them, at 0. Not among them are its beginning, and the points from which it only moves away.
    places
        for each place that was to be joined its point, layer by layer; -1 where no way leads there.
    speed_mps
        (m,): the greatest speed on an edge; inf where robots alone decide.
    names
        of the first points of each layer, the nodes of given lanes; empty where it was made from free space.
    sections
        of lanes with a capacity, each for one robot: edges into one are said to come near to all points there.
    base
        the roadmap to which points and edges were added, if this one was made so: its points come first, and it has no
        other edges between them.
    """

    points: Floats
    narrow: Bools
    layer: Indices
    edges: Indices
    clearance_m: Floats
    radii_m: Floats
    margin_m: float
    reach_start: Indices
    reach_point: Indices
    reach_m: Floats
    places: Indices
    speed_mps: Floats
    names: tuple[str, ...] = ()
    sections: tuple[Section, ...] = ()
    base: Roadmap | None = None

    def keeping(self, edges: Bools, base: Roadmap | None = None) -> Roadmap:
        """The roadmap with some of its edges (m,) only; `base` is that of which the same edges are left out."""
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
            base=base,
        )

    @cached_property
    def reaches_m(self) -> Floats:
        """(k, k): two of the widest robots of two layers whose centres are nearer are in each other's way."""
        return np.asarray(self.radii_m[:, np.newaxis] + self.radii_m + self.margin_m)

    @property
    def reach(self) -> float:
        """Metres: two of the widest robots whose centres are nearer are in each other's way."""
        return float(self.reaches_m.max())

    def layer_for(self, radius_m: float) -> int:
        """The number of the layer of robots of a radius; -1 where all layers are for smaller ones."""
        k = int(np.searchsorted(self.radii_m, radius_m * (1 - _SAME)))
        return k if k < len(self.radii_m) else -1

    @cached_property
    def edge_layer(self) -> Indices:
        """(m,)."""
        return self.layer[self.edges[:, 0]]

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
    def near_edge(self) -> Indices:
        """(l,): the edge on which a robot comes near to each point of `reach_point`."""
        return np.repeat(np.arange(len(self.edges)), np.diff(self.reach_start))

    @cached_property
    def passed(self) -> Bools:
        """(k, n): whether robots of each layer get past one that rests at a point."""
        from muster.traffic.roadmaps.holding_places import passable

        found, local = np.ones((len(self.radii_m), len(self.points)), dtype=np.bool_), self._number_in_layer
        if self.base is not None:
            found[:, : len(self.base.points)] = self.base.passed
        for (a, b), reach_m in np.ndenumerate(self.reaches_m):
            centres, others = np.flatnonzero(self.layer == a), np.flatnonzero(self.layer == b)
            own = np.flatnonzero(self.edge_layer == b)
            if self.base is not None:
                centres = centres[self._is_new_around(self.base, centres, b, float(reach_m))]
            of_centre = np.full(len(self.points), -1)
            of_centre[centres] = np.arange(len(centres))
            near = (self.edge_layer[self.near_edge] == b) & (of_centre[self.reach_point] >= 0)
            hits = np.searchsorted(own, self.near_edge[near]), of_centre[self.reach_point[near]]
            edges = local[self.edges[own]]
            found[b, centres] = passable(self.points[centres], self.points[others], edges, hits, float(reach_m))
        return found

    def _is_new_around(self, base: Roadmap, centres: Indices, layer: int, reach_m: float) -> Bools:
        """Return which points have points or edges of a layer around them, for `passable`, that the base has not."""
        from scipy.spatial import cKDTree

        from muster.traffic.roadmaps.holding_places import far_m

        there, local = np.flatnonzero(self.layer == layer), self._number_in_layer
        before = there[there < len(base.points)]
        if not len(centres) or not len(before):
            return np.ones(len(centres), dtype=np.bool_)
        at, fresh = self.points[centres], self.points[there[len(before) :]]
        now_m = far_m(at, self.points[there], local[self.edges[self.edge_layer == layer]], reach_m)
        was_m = far_m(at, self.points[before], local[base.edges[base.edge_layer == layer]], reach_m)
        fresh_m = cKDTree(fresh).query(at)[0] if len(fresh) else np.inf
        return np.asarray((centres >= len(base.points)) | (now_m != was_m) | (fresh_m <= now_m))

    @cached_property
    def _number_in_layer(self) -> Indices:
        """(n,): the number of each point among those of its layer."""
        found = np.zeros(len(self.points), dtype=np.int64)
        for k in range(len(self.radii_m)):
            found[self.layer == k] = np.arange(np.count_nonzero(self.layer == k))
        return found

    @property
    def passable(self) -> Bools:
        """(n,): whether others of its layer get past a robot that rests at a point: no passage for one is there."""
        return self.passed[self.layer, np.arange(len(self.points))]

    @cached_property
    def holding(self) -> Bools:
        """(n,): whether a robot may rest at a point: all others get past it, and it keeps nobody from another place."""
        from scipy.spatial import cKDTree

        places, free = np.unique(self.places[self.places >= 0]), np.array(self.passed.all(axis=0))
        is_place = np.isin(np.arange(len(self.points)), places)
        for (a, b), reach_m in np.ndenumerate(self.reaches_m):
            those, own = places[self.layer[places] == b], self.layer == a
            if len(those):
                tree, here = cKDTree(self.points[those]), self.points[own]
                near = tree.query_ball_point(here, reach_m * (1 - _SAME), return_length=True)
                at_it = tree.query_ball_point(here, _SAME, return_length=True)
                free[own] &= near <= np.where(is_place[own], at_it, 0)
        return free

    @cached_property
    def out_start(self) -> Indices:
        """(n + 1,): the edges that begin at point u are those from `out_start[u]` to `out_start[u + 1]`."""
        return np.searchsorted(self.edges[:, 0], np.arange(len(self.points) + 1))

    def reached(self, edge: int) -> Indices:
        """The points that a robot on an edge comes near to."""
        return self.reach_point[self.reach_start[edge] : self.reach_start[edge + 1]]

    def point_at(self, x: float, y: float, layer: int = -1) -> int:
        """The nearest point of a layer that an edge leads to or from; of a place that was joined its own.

        Metres, map frame; the layer is that of the widest robots by default.

        Raises
        ------
        ParameterError
            for a layer without edges.
        """
        joined = np.unique(self.edges[self.edge_layer == layer % len(self.radii_m)])
        if not len(joined):
            raise ParameterError("roadmap: no edges; expected some")
        return int(joined[np.argmin(np.hypot(*(self.points[joined] - (x, y)).T))])

    @classmethod
    def of(
        cls, space: Space | None, radius_m: float, places: npt.ArrayLike = (), *, margin_m: float = MARGIN_M
    ) -> Roadmap:
        """The roadmap of the free space of one size of robots: see `layer_of_space`."""
        return cls.joined([layer_of_space(space, radius_m, places, margin_m=margin_m)], margin_m)

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
        """The roadmap of given lanes for one size of robots: see `layer_of_lanes`."""
        return cls.joined([layer_of_lanes(lanes, radius_m, places, space=space, margin_m=margin_m)], margin_m)

    @classmethod
    def joined(cls, layers: Sequence[Layer], margin_m: float) -> Roadmap:
        """The roadmap of some layers, of the narrowest robots first, with the conflicts of their edges."""
        made = [layer.made for layer in layers]
        counts = [len(one.points) for one in made]
        first = np.cumsum([0, *counts[:-1]])
        points, layer = np.concatenate([one.points for one in made]), np.repeat(np.arange(len(layers)), counts)
        edges = np.concatenate([one.edges + k for one, k in zip(made, first, strict=True)])
        speeds = [np.full(len(one.made.edges), np.inf) if one.speed_mps is None else one.speed_mps for one in layers]
        order = np.lexsort(edges.T[::-1])
        edges = edges[order]
        radii_m = np.array([layer.radius_m for layer in layers])
        sections = tuple(section for one in layers for section in one.sections)
        reaches_m = radii_m[:, np.newaxis] + radii_m + margin_m
        start, point, metres = conflicts(points, edges, reaches_m, sections, layer)
        return cls(
            points=points,
            narrow=np.concatenate([one.narrow for one in made]),
            layer=layer,
            edges=edges,
            clearance_m=np.concatenate([one.clearance_m for one in made])[order],
            radii_m=radii_m,
            margin_m=margin_m,
            reach_start=start,
            reach_point=point,
            reach_m=metres,
            places=np.concatenate(
                [np.where(one.places < 0, -1, one.places + k) for one, k in zip(made, first, strict=True)]
            ),
            speed_mps=np.concatenate(speeds)[order],
            names=layers[0].names,
            sections=sections,
        )


def layer_of_space(
    space: Space | None, radius_m: float, places: npt.ArrayLike = (), *, margin_m: float = MARGIN_M
) -> Layer:
    """The layer of a free space, or of the open area around some places.

    Parameters
    ----------
    space
        free for the centre of the widest of these robots: `World.free_space(radius_m, "ground", three_d=False)`; None
        for the open plane.
    radius_m
        of the widest; greater than 0.
    places
        (k, 2) or (k, 3): starts of robots and places of tasks, metres in the map frame; each gets a point of its own.

    Raises
    ------
    ParameterError
        for a space with heights, a radius or margin that is not a finite number above 0, or neither space nor places.
    """
    apart_m, points = _checked(radius_m, margin_m, places)
    if space is None and len(points):
        space = _open(points, apart_m)
    if not isinstance(space, GridSpace | PolygonSpace):
        raise ParameterError("space: with heights or empty; expected the plane, or None and some places")
    return Layer(radius_m, network(space, apart_m, points, _MOST_POINTS))


def layer_of_lanes(
    lanes: Lanes,
    radius_m: float,
    places: npt.ArrayLike = (),
    *,
    space: Space | None = None,
    margin_m: float = MARGIN_M,
) -> Layer:
    """The layer of given lanes, without those that are too narrow or lead through an obstacle; else as of a space.

    Places are joined to the nearest point that a straight way leads to; the first points are the nodes, in order.
    """
    apart_m, points = _checked(radius_m, margin_m, places)
    if not isinstance(space, GridSpace | PolygonSpace | None):
        raise ParameterError("space: with heights; expected the plane, or None")
    made, speeds, sections = lane_network(lanes, radius_m, apart_m, points, space, most_points=_MOST_POINTS)
    return Layer(radius_m, made, speeds, sections, tuple(lanes.nodes))


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
