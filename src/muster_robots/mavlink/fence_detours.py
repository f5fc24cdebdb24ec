"""Detours round the areas of an autopilot's own fence, for legs that would cross them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TYPE_CHECKING

from muster.motion.free_space import PolygonSpace
from muster.motion.path import Path
from muster.motion.paths.path_finder import PathFinder
from muster.motion.port import Place, Waypoint
from muster_robots.mavlink.drone import Drone
from muster_robots.mavlink.mission_items import Detour
from muster_robots.mavlink.own_fence import FenceArea, OwnFence

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

MapCheck = Callable[[Place, Sequence[Waypoint]], str]
"""Why a drone may not go from a place through way points, by the mission's map; empty if it may."""
_MARGINS_M = (4.0, 1.0, 0.2)
"""Distances that a detour keeps from the areas, the first that leaves a path: drones overshoot where they turn."""


def within_limits(
    drone: Drone, waypoints: Sequence[Waypoint], here: Place, check: MapCheck
) -> Sequence[Waypoint] | str:
    """Return way points that keep to the limits of a drone's autopilot, or why there are none.

    Parameters
    ----------
    waypoints : sequence of Waypoint
        At the heights at which they are flown. Each stays; way points to pass by are added between them.
    here : Place
        Where the first leg begins, in the map frame.
    check : callable
        What the mission's map says; a detour that it refuses is not flown.
    """
    detoured = list(_detoured(drone.limits.fence, waypoints, here))
    if len(detoured) > len(waypoints) and not check(here, detoured):
        waypoints = detoured
    return drone.refusal([waypoint.position for waypoint in waypoints], here) or waypoints


def _detoured(fence: OwnFence, waypoints: Sequence[Waypoint], here: Place) -> Iterator[Waypoint]:
    for waypoint in waypoints:
        if fence.refusal([waypoint.position], here) and not fence.refusal([waypoint.position]):
            yield from (Detour(place, via=True) for place in _between(fence, here, waypoint.position))
        yield waypoint
        here = waypoint.position


def _between(fence: OwnFence, here: Place, there: Place) -> list[Place]:
    """Return where the shortest path round the areas turns, at the height of its end; nothing if there is no path."""
    for margin_m in _MARGINS_M:
        path = PathFinder(_space(fence.areas, here, there, margin_m)).path(here[:2], there[:2])
        if isinstance(path, Path):
            return [(float(x), float(y), there[2]) for x, y in path.points[1:-1]]
    return []


def _space(areas: Sequence[FenceArea], here: Place, there: Place, margin_m: float) -> PolygonSpace:
    """Return where a drone keeps a distance from all areas; no shortest path leaves its bounds."""
    import shapely

    around = shapely.union_all([area.shape for area in areas] + [shapely.Point(place[:2]) for place in (here, there)])
    region: BaseGeometry = shapely.box(*around.buffer(2 * margin_m).bounds)
    for area in areas:
        grown = area.shape.buffer(-margin_m if area.is_inclusion else margin_m, join_style="mitre")
        coarse = grown.simplify(margin_m / 2)
        region = region.intersection(coarse) if area.is_inclusion else region.difference(coarse)
    return PolygonSpace(shapely.MultiPolygon([part for part in shapely.get_parts(region) if part.area > 0]))
