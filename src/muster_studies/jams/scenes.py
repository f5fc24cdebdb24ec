"""Scenes for teams in narrow places: doors, aisles, dead ends, corridors, circles and streams.

Robots have a radius of 0.3 m and drive at 1 m/s. Places lie on grids. With a seed above 0 they are shifted at random by
up to `SHIFT_M`: the regular scene has the most symmetries.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np

from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone

RADIUS_M, SPEED_MPS, ACCELERATION_MPS2, YAW_RATE_RADPS = 0.3, 1.0, 1.0, 2.0
DOOR_M, AISLE_M, SHELF_M, CORRIDOR_M = 0.9, 0.8, 1.2, 2.5
SHIFT_M = 0.1
WORK_S = 5.0
HOLONOMIC, DIFFERENTIAL = "holonomic", "differential-drive"
KINEMATICS = (HOLONOMIC, DIFFERENTIAL)

Place = tuple[float, float]
Scene = Callable[[str, int], Mission]
"""From kinematics and a seed to a mission."""


def one_way_door(kinematics: str, seed: int, count: int = 20) -> Mission:
    """All go through a door of 0.9 m to places 2 m apart."""
    starts = [(-3.0 - k, -2.0 + row) for row in range(5) for k in range(4)][:count]
    goals = [(3.0 + 2 * k, -4.0 + 2 * row) for row in range(5) for k in range(4)][:count]
    return _swap("one-way door", starts, goals, kinematics, seed, _wall_with_door(12.0, 0.15, DOOR_M))


def two_way_door(kinematics: str, seed: int, count: int = 20) -> Mission:
    """Half of them on each side of a door of 0.9 m: they change places."""
    west = [(-3.0 - k, -2.0 + row) for row in range(3) for k in range(4)][: count // 2]
    east = [(-x, y) for x, y in west]
    return _swap("two-way door", west + east, east + west, kinematics, seed, _wall_with_door(10.0, 0.15, DOOR_M))


def corridor(kinematics: str, seed: int, count: int = 20) -> Mission:
    """Half of them at each end of a corridor 10 m long and 2.5 m wide: they change places."""
    west = [(-7.0 - k, -1.5 + row) for k in range(3) for row in range(4)][: count // 2]
    east = [(-x, y) for x, y in west]
    chart = _wall_with_door(10.0, 5.0, CORRIDOR_M, wide_m=16.0)
    return _swap("corridor", west + east, east + west, kinematics, seed, chart)


def circle(kinematics: str, seed: int, count: int = 50) -> Mission:
    """All go to the opposite place of a circle, 0.8 m apart from each other."""
    radius = max(3.0, 0.81 * count / (2 * math.pi))
    angles = [2 * math.pi * k / count for k in range(count)]
    starts = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    return _swap("circle", starts, [(-x, -y) for x, y in starts], kinematics, seed, None)


def streams(kinematics: str, seed: int, count: int = 40) -> Mission:
    """Two streams that cross at a right angle."""
    along = [(-8.0 - k, -2.0 + row) for k in range(4) for row in range(5)][: count // 2]
    across = [(y, x) for x, y in along]
    goals = [(8.0 - (x + 8.0), y) for x, y in along]
    return _swap("streams", along + across, goals + [(y, x) for x, y in goals], kinematics, seed, None)


def pair(kinematics: str, seed: int) -> Mission:
    """Two equal robots that meet exactly face to face."""
    return _swap("face to face", [(-4.0, 0.0), (4.0, 0.0)], [(4.0, 0.0), (-4.0, 0.0)], kinematics, 0, None)


def aisles(kinematics: str, seed: int, count: int = 6) -> Mission:
    """Five tasks a robot in aisles of 0.8 m between shelves, open at both ends."""
    return _shelves("aisles", kinematics, seed, count, closed=False)


def dead_ends(kinematics: str, seed: int, count: int = 6) -> Mission:
    """The same with aisles that are closed at their far ends."""
    return _shelves("dead ends", kinematics, seed, count, closed=True)


SCENES: Mapping[str, Scene] = MappingProxyType(
    {
        "face to face, 2": pair,
        "one-way door, 20": one_way_door,
        "two-way door, 20": two_way_door,
        "corridor, 20": corridor,
        "aisles, 6": aisles,
        "dead ends, 6": dead_ends,
        "circle, 50": circle,
        "streams, 40": streams,
    }
)


def _swap(name: str, starts: list[Place], goals: list[Place], kinematics: str, seed: int, chart: Map | None) -> Mission:
    """Every robot has one task, its own."""
    starts, goals = _shifted(starts, (seed, 0)), _shifted(goals, (seed, 1))
    robots = [
        _robot(k, start, math.atan2(goal[1] - start[1], goal[0] - start[0]), kinematics)
        for k, (start, goal) in enumerate(zip(starts, goals, strict=True))
    ]
    tasks = [Task(id=f"t_{k}", position=goal, only_robots=(f"r_{k}",)) for k, goal in enumerate(goals)]
    rules = Rules(objective="makespan", usage="time")
    return Mission(name=name, robots=tuple(robots), tasks=tuple(tasks), map=chart, rules=rules)


def _shelves(name: str, kinematics: str, seed: int, count: int, *, closed: bool) -> Mission:
    shelves = max(8, count // 2 + 1)
    pitch, low, high = AISLE_M + SHELF_M, 1.4, 13.4
    right, top = shelves * pitch + SHELF_M, high + 1.4
    zones = [_box(k * pitch, low, k * pitch + SHELF_M, high) for k in range(shelves + 1)]
    if closed:
        zones.append(_box(0.0, high, right, top))
    random = np.random.default_rng(seed)
    places = [
        (SHELF_M + AISLE_M / 2 + pitch * int(random.integers(shelves)), float(random.uniform(low + 0.6, high - 0.6)))
        for _ in range(5 * count)
    ]
    robots = [_robot(k, (0.5 + k, -2.5), math.pi / 2, kinematics) for k in range(count)]
    tasks = [Task(id=f"t_{k}", position=place, duration_s=WORK_S) for k, place in enumerate(places)]
    boundary = ((0.0, -3.0), (right, -3.0), (right, top), (0.0, top))
    rules = Rules(objective="makespan", usage="time", return_to_start=True)
    chart = Map(boundary=boundary, zones=tuple(zones))
    return Mission(name=name, robots=tuple(robots), tasks=tuple(tasks), map=chart, rules=rules)


def _wall_with_door(side_m: float, half_m: float, door_m: float, wide_m: float | None = None) -> Map:
    """A hall, and across it a wall of twice `half_m` with an opening in the middle."""
    x, y, gap = wide_m or side_m, side_m, door_m / 2
    boundary = ((-x, -y), (x, -y), (x, y), (-x, y))
    return Map(boundary=boundary, zones=(_box(-half_m, -y, half_m, -gap), _box(-half_m, gap, half_m, y)))


def _box(left: float, low: float, right: float, high: float) -> Zone:
    return Zone(polygon=((left, low), (right, low), (right, high), (left, high)))


def _robot(number: int, place: Place, heading: float, kinematics: str) -> Robot:
    drives = kinematics == DIFFERENTIAL
    return Robot(
        id=f"r_{number}",
        position=place,
        heading_deg=math.degrees(heading),
        radius_m=RADIUS_M,
        speed_mps=SPEED_MPS,
        kinematics=kinematics,
        acceleration_mps2=ACCELERATION_MPS2 if drives else None,
        yaw_rate_radps=YAW_RATE_RADPS if drives else None,
    )


def _shifted(places: list[Place], seed: tuple[int, int]) -> list[Place]:
    """Places shifted at random; not with seed 0."""
    if seed[0] == 0:
        return places
    shifts = np.random.default_rng(seed).uniform(-SHIFT_M, SHIFT_M, (len(places), 2))
    return [(x + float(dx), y + float(dy)) for (x, y), (dx, dy) in zip(places, shifts, strict=True)]
