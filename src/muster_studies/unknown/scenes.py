"""Random worlds for teams without a map: rooms with furniture and tasks, and buildings that are to be explored."""

from __future__ import annotations

import math

import numpy as np

from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.motion.map_world import World

RADIUS_M, SPEED_MPS = 0.2, 0.8
WORLD_M, BUILDING_M, ROOM_M = (24.0, 16.0), (60.0, 40.0), 10.0
HALL_M, CEILING_M = (40.0, 30.0), 3.0
ROBOTS, TASKS, BOXES = 3, 10, 14
_WALL_M, _DOOR_M = 0.2, 2.0
_ROOM_TO_STAND_M = 0.22


def random_world(seed: int) -> Mission:
    """Return three rooms in a row with doors of 1 to 2 m and boxes in them: 3 robots, 10 tasks, and 1 in a box."""
    random = np.random.default_rng(seed)
    width, height = WORLD_M
    zones: list[Zone] = []
    for x in (8.0, 16.0):
        low = random.uniform(1, height - 3)
        top = low + random.uniform(1, 2)
        zones += [_box(x, 0, 0.3, low), _box(x, top, 0.3, height - top)]
    boxes = []
    for _ in range(BOXES):
        wide, deep = random.uniform(0.5, 3, 2)
        boxes.append(
            _box(random.uniform(0.6, width - wide - 0.6), random.uniform(0.6, height - deep - 0.6), wide, deep)
        )
    chart = Map(boundary=_corners(0, 0, width, height), zones=(*zones, *boxes))
    places = _free_places(chart, random, ROBOTS + TASKS)
    (x, y), *_ = boxes[0].polygon
    tasks = [Task(id=f"t_{k}", position=place) for k, place in enumerate(places[ROBOTS:])]
    return Mission(
        name=f"world {seed}",
        map=chart,
        robots=tuple(_robot(f"r_{k}", place) for k, place in enumerate(places[:ROBOTS])),
        tasks=(*tasks, Task(id="in a box", position=(x + 0.2, y + 0.2))),
    )


def random_space(seed: int) -> Mission:
    """Return a yard in space with walls, towers, bridges and a no-fly zone: 2 robots on the ground and 2 in the air.

    Robots on the ground pass below bridges, those in the air above and below. Of the tasks 5 are on the ground, 5 in
    the air, and 1 is inside a tower.
    """
    random = np.random.default_rng(seed)
    width, depth = WORLD_M
    tower = random.uniform((3, 3), (width - 5, depth - 5))
    zones = [_block(float(tower[0]), float(tower[1]), 2, 2, None, random.uniform(6, 9))]
    for _ in range(6):
        wide, deep = random.permutation([random.uniform(0.3, 0.8), random.uniform(2, 7)])
        x, y = random.uniform((1, 1), (width - wide - 1, depth - deep - 1))
        floor = random.uniform(1.5, 3) if random.random() < 0.4 else None
        zones.append(_block(x, y, wide, deep, floor, random.uniform(3.2, 6)))
    x, y = random.uniform((1, 1), (width - 4, depth - 4))
    zones.append(Zone(polygon=_corners(x, y, 3, 3), forbidden_to=("air",)))
    chart = Map(boundary=_corners(0, 0, width, depth), zones=tuple(zones))
    ground = _free_places(chart, random, 7, kind="ground", heights=(0.0, 0.0))
    air = _free_places(chart, random, 7, kind="air", heights=(0.0, 5.0))
    inside = Task(id="in a tower", position=(float(tower[0]) + 1, float(tower[1]) + 1, 1.0))
    return Mission(
        name=f"space {seed}",
        map=chart,
        robots=(
            *(_robot(f"r_{k}", place) for k, place in enumerate(ground[:2])),
            *(_drone(f"d_{k}", (*place[:2], 0.0 if k else place[2])) for k, place in enumerate(air[:2])),
        ),
        tasks=(
            *(Task(id=f"g_{k}", position=place) for k, place in enumerate(ground[2:])),
            *(Task(id=f"a_{k}", position=place, only_robots=("d_0", "d_1")) for k, place in enumerate(air[2:])),
            inside,
        ),
    )


def hall(seed: int, robots: int) -> Mission:
    """Return a building of 4 by 3 rooms under a ceiling, and robots in the air in one of them without tasks yet."""
    random = np.random.default_rng(seed)
    (width, depth), half = HALL_M, _WALL_M / 2
    zones = [_block(0, 0, width, depth, CEILING_M, CEILING_M + 0.3)]
    for x in np.arange(ROOM_M, width, ROOM_M).tolist():
        for y in np.arange(0, depth, ROOM_M).tolist():
            door = random.uniform(1, ROOM_M - _DOOR_M - 1)
            zones += [_block(x - half, y, _WALL_M, door, None, CEILING_M)]
            zones += [_block(x - half, y + door + _DOOR_M, _WALL_M, ROOM_M - door - _DOOR_M, None, CEILING_M)]
    for y in np.arange(ROOM_M, depth, ROOM_M).tolist():
        for x in np.arange(0, width, ROOM_M).tolist():
            door = random.uniform(1, ROOM_M - _DOOR_M - 1)
            zones += [_block(x, y - half, door, _WALL_M, None, CEILING_M)]
            zones += [_block(x + door + _DOOR_M, y - half, ROOM_M - door - _DOOR_M, _WALL_M, None, CEILING_M)]
    return Mission(
        name=f"hall {seed}, {robots}",
        map=Map(boundary=_corners(0, 0, width, depth), zones=tuple(zones)),
        robots=tuple(_drone(f"d_{k}", (12.0 + 1.2 * k, 13.0, 1.0)) for k in range(robots)),
        tasks=(),
        rules=Rules(objective="makespan"),
    )


def building(seed: int, robots: int) -> Mission:
    """Return a building of 6 by 4 rooms with doors of 2 m, and robots in one of them that have no tasks yet."""
    random = np.random.default_rng(seed)
    (width, height), half = BUILDING_M, _WALL_M / 2
    zones = []
    for x in np.arange(ROOM_M, width, ROOM_M).tolist():
        for y in np.arange(0, height, ROOM_M).tolist():
            door = random.uniform(1, ROOM_M - _DOOR_M - 1)
            zones += [_box(x - half, y, _WALL_M, door)]
            zones += [_box(x - half, y + door + _DOOR_M, _WALL_M, ROOM_M - door - _DOOR_M)]
    for y in np.arange(ROOM_M, height, ROOM_M).tolist():
        for x in np.arange(0, width, ROOM_M).tolist():
            door = random.uniform(1, ROOM_M - _DOOR_M - 1) if random.random() < 0.6 else ROOM_M
            zones += [_box(x, y - half, door, _WALL_M)]
            if door < ROOM_M:
                zones += [_box(x + door + _DOOR_M, y - half, ROOM_M - door - _DOOR_M, _WALL_M)]
    return Mission(
        name=f"building {seed}, {robots}",
        map=Map(boundary=_corners(0, 0, width, height), zones=tuple(zones)),
        robots=tuple(_robot(f"r_{k}", (32.0 + 1.2 * k, 23.0)) for k in range(robots)),
        tasks=(),
        rules=Rules(objective="makespan"),
    )


def _robot(name: str, place: tuple[float, ...]) -> Robot:
    return Robot(id=name, position=place, radius_m=RADIUS_M, speed_mps=SPEED_MPS, kinematics="differential-drive")


def _drone(name: str, place: tuple[float, ...]) -> Robot:
    return Robot(id=name, position=place, radius_m=RADIUS_M, speed_mps=2.0, kind="air", kinematics="quadcopter")


def _free_places(
    chart: Map,
    random: np.random.Generator,
    count: int,
    *,
    kind: str = "ground",
    heights: tuple[float, float] | None = None,
) -> list[tuple[float, ...]]:
    """Return places at which robots can stand, far enough from each other; in space between two heights."""
    start = (0.5, 0.5) if heights is None else (0.5, 0.5, 0.0)
    world = World.of(Mission(name="free", map=chart, robots=(_robot("r", start),), tasks=()))
    found: list[tuple[float, ...]] = []
    low, high = np.full(2, 0.3), np.array(WORLD_M) - 0.3
    if heights is not None:
        low, high = np.append(low, heights[0]), np.append(high, heights[1])
    while len(found) < count:
        place = tuple(random.uniform(low, high).tolist())
        stands = world.clearance(np.array([place]), kind, RADIUS_M)[0] > _ROOM_TO_STAND_M
        if stands and all(math.dist(place, other) > 3 * RADIUS_M for other in found):
            found.append(place)
    return found


def _block(x: float, y: float, width: float, depth: float, floor: float | None, ceiling: float) -> Zone:
    corners = _corners(float(x), float(y), float(width), float(depth))
    return Zone(polygon=corners, floor_m=floor, ceiling_m=float(ceiling), forbidden_to=("ground", "air"))


def _box(x: float, y: float, width: float, depth: float) -> Zone:
    return Zone(polygon=_corners(x, y, width, depth), forbidden_to=("ground", "air"))


def _corners(x: float, y: float, width: float, depth: float) -> tuple[tuple[float, float], ...]:
    return (x, y), (x + width, y), (x + width, y + depth), (x, y + depth)
