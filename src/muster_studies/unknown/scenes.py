"""Random worlds for teams without a map: rooms with furniture and tasks, and buildings that are to be explored."""

from __future__ import annotations

import math

import numpy as np

from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.motion.map_world import World

RADIUS_M, SPEED_MPS = 0.2, 0.8
WORLD_M, BUILDING_M, ROOM_M = (24.0, 16.0), (60.0, 40.0), 10.0
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


def _robot(name: str, place: tuple[float, float]) -> Robot:
    return Robot(id=name, position=place, radius_m=RADIUS_M, speed_mps=SPEED_MPS, kinematics="differential-drive")


def _free_places(chart: Map, random: np.random.Generator, count: int) -> list[tuple[float, float]]:
    """Return places at which robots can stand, far enough from each other."""
    world = World.of(Mission(name="free", map=chart, robots=(_robot("r", (0.5, 0.5)),), tasks=()))
    found: list[tuple[float, float]] = []
    while len(found) < count:
        x, y = random.uniform((0.3, 0.3), np.array(WORLD_M) - 0.3).tolist()
        stands = world.clearance(np.array([[x, y]]), "ground", RADIUS_M)[0] > _ROOM_TO_STAND_M
        if stands and all(math.dist((x, y), other) > 3 * RADIUS_M for other in found):
            found.append((x, y))
    return found


def _box(x: float, y: float, width: float, depth: float) -> Zone:
    return Zone(polygon=_corners(x, y, width, depth), forbidden_to=("ground", "air"))


def _corners(x: float, y: float, width: float, depth: float) -> tuple[tuple[float, float], ...]:
    return (x, y), (x + width, y), (x + width, y + depth), (x, y + depth)
