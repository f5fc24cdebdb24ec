"""The free space of a mission for bodies that are discs, without the code under test."""

import numpy as np
import shapely

FAR_M = 1e6
"""So far away is a robot that was taken away."""
NEAR_M = 0.15
"""By which a body may be nearer to a broken one than a way needs, and still leave on its side."""


class Space:
    """Distances to walls, and which places are joined; zones without an id are walls, the others are doors."""

    def __init__(self, chart):
        self.inside = shapely.Polygon(chart.boundary)
        self.walls = shapely.union_all([shapely.Polygon(zone.polygon) for zone in chart.zones if zone.id is None])
        self.doors = {zone.id: shapely.Polygon(zone.polygon) for zone in chart.zones if zone.id is not None}
        self._faces = shapely.union_all([self.walls, self.inside.exterior])
        shapely.prepare((self.inside, self._faces))

    def gap_m(self, places):
        """Metres (n,) from places (n, 2) to the nearest wall; 0 in a wall, or nowhere."""
        points = shapely.points(np.nan_to_num(places, nan=FAR_M))
        away = shapely.distance(points, self._faces)
        return np.where(shapely.covers(self.inside, points), away, 0.0)

    def free(self, radius_m, broken=(), margin_m=0.0, closed=()):
        """The parts of the space where the middle of a body may be, among broken ones of the same radius."""
        room = self.inside.buffer(-radius_m).difference(self.walls.buffer(radius_m))
        for door in closed:
            room = room.difference(self.doors[door].buffer(radius_m))
        for place in broken:
            room = room.difference(shapely.Point(place).buffer(2 * radius_m + margin_m))
        return [part for part in shapely.get_parts(room) if not part.is_empty]


def joined(parts, start, goal):
    """Whether a body at a place comes to another by the parts of a free space."""
    begin, end = shapely.Point(start), shapely.Point(goal)
    return any(part.distance(begin) < NEAR_M and part.covers(end) for part in parts)
