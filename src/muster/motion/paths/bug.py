"""Bug 2 ([lumelsky1987]): straight towards the goal, and around whatever is in the way.

The robot goes along the line from start to goal until an obstacle stops it. It turns to its side and follows the
border until it is on that line again, nearer to the goal, and free to go on. A border that leads back without such a
place proves that there is no path. The path is at most the line plus half of each border that the line crosses, once
for each crossing.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from muster.mission.errors import ParameterError
from muster.mission.values.arrays import Floats
from muster.motion.free_space import Space
from muster.motion.path import NoPath, Path
from muster.motion.paths.free_region import part_around, slack_of
from muster.motion.paths.on_grid import without_repetitions
from muster.motion.paths.planner import Planner, blocked, disconnected, in_plane

if TYPE_CHECKING:
    import shapely

SIDES = ("left", "right")


@dataclass(frozen=True, kw_only=True)
class Parameters:
    """`side`: to which the robot turns at an obstacle, `left` or `right`."""

    side: str = "left"

    def __post_init__(self) -> None:
        if self.side not in SIDES:
            raise ParameterError(f"side: {self.side}; expected {', '.join(SIDES)}")


def find_path(space: Space, start: Floats, goal: Floats, seed: int, params: Parameters) -> Path | NoPath:
    """Free wherever there is a path; `disconnected` if there is none."""
    plane = in_plane(space, "bug")
    reason = blocked(plane, start, goal)
    if reason is not None:
        return reason
    if (start == goal).all():
        return Path(start[np.newaxis])
    way = _way(part_around(plane, start), start, goal, params.side, slack_of(plane))
    return disconnected(start, goal) if way is None else Path(without_repetitions(way))


def _way(polygon: shapely.Polygon, start: Floats, goal: Floats, side: str, slack: float) -> Floats | None:
    import shapely

    line = shapely.LineString([start, goal])
    rings = [ring if side == "left" else ring.reverse() for ring in (polygon.exterior, *polygon.interiors)]
    free = _free_pieces(polygon, line)
    along, pieces = 0.0, [start[np.newaxis]]
    while True:
        hit = max((end for begin, end in free if begin - slack <= along <= end + slack), default=along)
        if hit >= line.length - slack:
            return np.concatenate([*pieces, goal[np.newaxis]])
        at = line.interpolate(hit)
        ring = min(rings, key=at.distance)
        leave = _first_met(ring, at, [begin for begin, _ in free if begin > hit + slack / 1000], line, slack)
        if leave is None:
            return None
        pieces.append(_followed(ring, ring.project(at), ring.project(line.interpolate(leave))))
        along = leave


def _free_pieces(polygon: shapely.Polygon, line: shapely.LineString) -> list[tuple[float, float]]:
    """Where along the line it is free: pairs of distances from its start; a touch is a piece without length."""
    import shapely

    found = polygon.intersection(line)
    ends = [shapely.get_coordinates(part)[[0, -1]] for part in shapely.get_parts(found) if not part.is_empty]
    along = [sorted(float(line.project(shapely.Point(end))) for end in pair) for pair in ends]
    return [(begin, end) for begin, end in along]


def _first_met(
    ring: shapely.LinearRing, at: shapely.Point, places: list[float], line: shapely.LineString, slack: float
) -> float | None:
    """Of places along the line those that lie on the ring: the first that who follows it from `at` comes to."""
    begin = ring.project(at)
    on_ring = [place for place in places if ring.distance(line.interpolate(place)) <= slack]
    ahead = [(ring.project(line.interpolate(place)) - begin) % ring.length for place in on_ring]
    return on_ring[int(np.argmin(ahead))] if ahead else None


def _followed(ring: shapely.LinearRing, begin: float, end: float) -> Floats:
    """The points (k, 2) of a ring from one distance along it to another, in its direction."""
    from shapely.ops import substring

    if begin <= end:
        return np.asarray(substring(ring, begin, end).coords)
    parts = substring(ring, begin, ring.length), substring(ring, 0.0, end)
    return np.concatenate([np.asarray(part.coords) for part in parts])


BUG = Planner(
    name="bug",
    summary="straight to the goal and around what is in the way, by what it touches alone",
    parameters=Parameters,
    algorithm=find_path,
)
