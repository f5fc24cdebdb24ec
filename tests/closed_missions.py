"""Random missions whose straight legs meet zones and boundaries, and places on legs tested one by one."""

import math
import random

from muster import Mission, Robot, Task
from muster.mission.rules import Rules
from muster.mission.site import Map, Zone


def closed_mission(seed: int, **rules) -> Mission:
    """A mission in the plane or in space among zones of all kinds, many of whose places lie on a coarse grid."""
    draw = random.Random(seed)
    dimensions = draw.choice((2, 3))

    def place():
        at = (draw.uniform(0, 40), draw.uniform(0, 30))
        if draw.random() < 0.3:
            at = tuple(5.0 * round(c / 5) for c in at)
        return (*at, draw.choice((0.0, 0.0, 3.0, draw.uniform(0, 12)))) if dimensions == 3 else at

    boundary = ((-2, -2), (42, -2), (42, 32), (-2, 32))
    if draw.random() < 0.4:
        boundary = (*boundary[:3], (20, 15), boundary[3])
    robots = tuple(
        Robot(
            id=f"r{k}",
            position=place(),
            kind=draw.choice(("ground", "air")),
            radius_m=draw.choice((0.0, 0.0, 0.3, 0.5)),
            return_to_start=draw.random() < 0.4,
        )
        for k in range(draw.randint(1, 3))
    )
    tasks = [Task(id=f"t{k}", position=place(), **_portals(draw, place)) for k in range(draw.randint(1, 6))]
    zones = tuple(_zone(draw) for _ in range(draw.randint(1, 4)))
    usage = draw.choice(("distance", "time"))
    return Mission(
        name="closed",
        robots=robots,
        tasks=tuple(tasks),
        map=Map(boundary=boundary, zones=zones),
        rules=Rules(travel="euclidean", usage=usage, **rules),
    )


def _portals(draw, place):
    return {"entry": place(), "exit": place()} if draw.random() < 0.2 else {}


def _zone(draw) -> Zone:
    x, y = draw.uniform(0, 35), draw.uniform(0, 25)
    if draw.random() < 0.5:
        x, y = 5.0 * round(x / 5), 5.0 * round(y / 5)
    wide, deep = draw.choice((5.0, draw.uniform(1, 8))), draw.choice((5.0, draw.uniform(1, 8)))
    corners = ((x, y), (x + wide, y), (x + wide, y + deep), (x, y + deep))
    floor = draw.choice((None, None, 0.0, draw.uniform(0.1, 8)))
    return Zone(
        polygon=corners if draw.random() < 0.6 else corners[:3],
        floor_m=floor,
        ceiling_m=draw.choice((None, None, (floor or 0) + draw.uniform(0.5, 6))),
        forbidden_to=draw.choice((("ground", "air"), ("air",), ("ground",))),
    )


def depth_m(mission: Mission, robot: Robot, point) -> float:
    """By how many metres a robot at a point is in what is closed to it; below 0: how far from it, at most."""
    boundary = mission.map.boundary
    outside = _distance(point, boundary) * (-1 if _inside(point, boundary) else 1)
    depths = [outside + robot.radius_m]
    for zone in mission.map.zones:
        if robot.kind not in zone.forbidden_to:
            continue
        away = _distance(point, zone.polygon) * (-1 if _inside(point, zone.polygon) else 1)
        depth = robot.radius_m - away
        floor = -math.inf if not zone.floor_m else zone.floor_m
        if mission.dimensions == 3 and robot.kind == "air":
            ceiling = math.inf if zone.ceiling_m is None else zone.ceiling_m
            depth = min(depth, point[2] - floor + robot.radius_m, ceiling + robot.radius_m - point[2])
        if mission.dimensions == 3 and robot.kind == "ground" and floor > 2 * robot.radius_m:
            continue
        depths.append(depth)
    return max(depths)


def greatest_depth_m(mission: Mission, robot: Robot, start, end, pieces: int = 400) -> float:
    """The greatest depth along a leg, and along the upright take-off or landing of a drone."""
    legs = [(start, end)]
    if mission.dimensions == 3 and robot.kind == "air":
        low, high = sorted((start, end), key=lambda point: point[2])
        ground = min(
            [0.0, *(p[2] for p in (*(r.position for r in mission.robots), *(t.position for t in mission.tasks)))]
        )
        if low[2] <= ground:
            top = (*low[:2], high[2])
            legs += [(low, top), (top, high)]
    return max(
        depth_m(mission, robot, [a + k / pieces * (b - a) for a, b in zip(*leg, strict=True)])
        for leg in legs
        for k in range(pieces + 1)
    )


def _inside(point, corners) -> bool:
    inside = False
    for (ax, ay), (bx, by) in zip(corners, (*corners[1:], corners[0]), strict=True):
        if (ay > point[1]) != (by > point[1]) and point[0] < ax + (point[1] - ay) / (by - ay) * (bx - ax):
            inside = not inside
    return inside


def _distance(point, corners) -> float:
    """Metres in the plane from a point to the nearest side."""
    found = math.inf
    for a, b in zip(corners, (*corners[1:], corners[0]), strict=True):
        along = [b[0] - a[0], b[1] - a[1]]
        share = ((point[0] - a[0]) * along[0] + (point[1] - a[1]) * along[1]) / (along[0] ** 2 + along[1] ** 2)
        share = min(1.0, max(0.0, share))
        found = min(found, math.dist(point[:2], (a[0] + share * along[0], a[1] + share * along[1])))
    return found
