"""The judge's own shortest paths on a map (docs/design.md, Meaning: travel `map`).

In the plane they are exact: a shortest way turns only at corners of what is blocked, so it is a shortest path in the
graph of corners that see each other [lozano1979].
In the air they are approximations, see `air`.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Protocol

import numpy as np

from muster.mission.model import Mission, Point, Robot
from muster.motion.free_space import GridSpace, PolygonSpace, PrismSpace, Space
from muster.motion.grid import Bools, Floats, Indices
from muster.motion.map_world import World
from muster.verification.air_paths import AirPaths
from muster.verification.cells import Cells
from muster.verification.regions import Regions
from muster.verification.visibility_graph import VisibilityGraph

PLANE_TOLERANCE = 1e-6
"""Relative. In the plane both planner and judge are exact, and add in different orders."""

AIR_TOLERANCE = 1e-2
"""Relative. Among prisms both are within half of it."""


class MapPaths:
    """Shortest ways over a mission's map for its robots, made once for each radius and kind.

    Parameters
    ----------
    mission
        with a map.
    points
        every point that will be asked for, metres in the map frame.

    Raises
    ------
    MissionError, MissingExtraError
        as `World.of`.
    """

    def __init__(self, mission: Mission, points: Iterable[Point]) -> None:
        self._world = World.of(mission)
        self._points = tuple(points)
        self._made: dict[tuple[float, str], PlanePaths | AirPaths] = {}
        self._sights: dict[tuple[float, str, bool], _Sight] = {}
        in_air = any(isinstance(self._space(robot), PrismSpace) for robot in mission.robots)
        self.tolerance = AIR_TOLERANCE if in_air else PLANE_TOLERANCE

    def metres(self, robot: Robot, start: Point, end: Point) -> float | None:
        """The length of the robot's shortest way between two of the points; None where there is none."""
        body = (robot.radius_m, robot.kind)
        if body not in self._made:
            space = self._space(robot)
            self._made[body] = AirPaths(space) if isinstance(space, PrismSpace) else PlanePaths(space, self._points)
        return self._made[body].metres(start, end)

    def sees(self, robot: Robot, start: Point, end: Point, *, doors_open: bool) -> bool:
        """Whether the straight way of a robot on the ground between two points of the plane is free."""
        key = (robot.radius_m, robot.kind, doors_open)
        if key not in self._sights:
            world = self._world.with_closed(()) if doors_open else self._world
            space = world.free_space(robot.radius_m, robot.kind)
            assert not isinstance(space, PrismSpace), "a robot on the ground"
            self._sights[key] = _sight_in(space)
        sight = self._sights[key]
        places, free = sight.settled(np.array([start[:2], end[:2]], dtype=np.float64))
        return bool(free.all()) and sight.clear(places[0], places[1])

    @property
    def has_closed_doors(self) -> bool:
        """Whether a door is closed before any event."""
        return bool(self._world.closed)

    def _space(self, robot: Robot) -> Space:
        return self._world.free_space(robot.radius_m, robot.kind)


class _Sight(Protocol):
    """Lines of sight between positions of a space, in its own frame (see `settled`), whose unit is `unit_m` metres."""

    unit_m: float
    corners: Floats

    def settled(self, points: Floats) -> tuple[Floats, Bools]: ...

    def between_corners(self) -> Indices: ...

    def from_places(self, places: Floats) -> Indices: ...

    def clear(self, start: Floats, end: Floats) -> bool: ...


def _sight_in(space: GridSpace | PolygonSpace) -> _Sight:
    return Cells(space) if isinstance(space, GridSpace) else Regions(space)


class PlanePaths:
    """Shortest ways in the plane between some places, which must be known beforehand.

    With heights, as of a ground robot in a 3-D mission, z rises evenly along the way in the plane: the length is
    hypot(length in the plane, difference of z).

    Parameters
    ----------
    space
        where the centre of the robot may be.
    places
        (2) or (3) metres each: every point that will be asked for.
    """

    def __init__(self, space: GridSpace | PolygonSpace, places: Iterable[Point]) -> None:
        sight = _sight_in(space)
        feet = list(dict.fromkeys(place[:2] for place in places))
        self._number = {foot: k for k, foot in enumerate(feet)}
        self._sight = sight
        self._places, self._free = sight.settled(np.array(feet, dtype=np.float64).reshape(-1, 2))
        self._graph: VisibilityGraph | None = None
        self._known: dict[tuple[int, int], float | None] = {}

    def metres(self, start: Point, end: Point) -> float | None:
        """The length of the shortest way between two of the places; None where there is no way.

        Raises
        ------
        KeyError
            if one is none of the places.
        """
        a, b = self._number[start[:2]], self._number[end[:2]]
        if not self._free[a] or not self._free[b]:
            return None
        if self._sight.clear(self._places[a], self._places[b]):
            return math.dist(start, end)
        pair = (min(a, b), max(a, b))
        if pair not in self._known:
            self._known[pair] = self._around(*pair)
        plane = self._known[pair]
        return None if plane is None else math.hypot(plane, *(p - q for p, q in zip(start[2:], end[2:], strict=True)))

    def _around(self, a: int, b: int) -> float | None:
        """The length of the shortest way that turns somewhere."""
        if self._graph is None:
            self._graph = self._drawn()
        way = self._graph.way(a, b)
        return None if way is None else self._graph.length(way) * self._sight.unit_m

    def _drawn(self) -> VisibilityGraph:
        """Places first, then corners. Blocked places see nothing."""
        sight, count = self._sight, len(self._places)
        standing = np.flatnonzero(self._free)
        seen = sight.from_places(self._places[standing])
        to_corners = np.stack([standing[seen[:, 0]], count + seen[:, 1]], axis=1)
        nodes = np.concatenate([self._places, sight.corners])
        return VisibilityGraph(nodes, np.concatenate([to_corners, count + sight.between_corners()]), ends=count)
