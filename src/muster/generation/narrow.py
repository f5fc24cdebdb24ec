"""Teams in narrow places: doors, aisles, dead ends, corridors, circles and streams, for 2 to 200 robots.

Robots have a radius of 0.3 m and drive at 1 m/s. Places lie on grids. With a seed above 0 they are shifted at random by
up to `SHIFT_M`: the regular scene has the most symmetries. Halls grow with teams that are larger than `SMALL`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import replace
from types import MappingProxyType

import numpy as np

from muster.generation.generator import Generator
from muster.mission.model import Map, Mission, Robot, Rules, Task, Zone
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Whole

RADIUS_M, SPEED_MPS, ACCELERATION_MPS2, YAW_RATE_RADPS = 0.3, 1.0, 1.0, 2.0
DOOR_M, AISLE_M, SHELF_M, CORRIDOR_M = 0.9, 0.8, 1.2, 2.5
SHIFT_M = 0.1
WORK_S = 5.0
HOLONOMIC, DIFFERENTIAL = "holonomic", "differential-drive"
KINEMATICS = (HOLONOMIC, DIFFERENTIAL)

SMALL = 20
"""Teams of at most so many robots meet in halls of one size."""

Place = tuple[float, float]


def one_way_door(kinematics: str, seed: int, count: int = 20) -> Mission:
    """All go through a door of 0.9 m to places 2 m apart."""
    rows, columns = _grid(count, 5, 4)
    starts = [(-3.0 - k, (1 - rows) / 2 + row) for row in range(rows) for k in range(columns)][:count]
    goals = [(3.0 + 2 * k, 1.0 - rows + 2 * row) for row in range(rows) for k in range(columns)][:count]
    chart = _wall_with_door(max(12.0, 4.0 + 2 * columns, 1.0 + rows), 0.15, DOOR_M)
    return _swap("one-way door", starts, goals, kinematics, seed, chart)


def two_way_door(kinematics: str, seed: int, count: int = 20) -> Mission:
    """Half of them on each side of a door of 0.9 m: they change places."""
    rows, columns = _grid(-(-count // 2), 3, 4)
    west = [(-3.0 - k, row - 2.0 - (rows - 3) // 2) for row in range(rows) for k in range(columns)]
    chart = _wall_with_door(max(10.0, 4.0 + columns, 2.0 + rows), 0.15, DOOR_M)
    return _change_places("two-way door", west, count, kinematics, seed, chart)


def corridor(kinematics: str, seed: int, count: int = 20) -> Mission:
    """Half of them at each end of a corridor 10 m long and 2.5 m wide: they change places."""
    rows, columns = _grid(-(-count // 2), 4, 3)
    west = [(-7.0 - k, (1 - rows) / 2 + row) for k in range(columns) for row in range(rows)]
    chart = _wall_with_door(max(10.0, 1.0 + rows), 5.0, CORRIDOR_M, wide_m=max(16.0, 8.0 + columns))
    return _change_places("corridor", west, count, kinematics, seed, chart)


def circle(kinematics: str, seed: int, count: int = 50, apart_m: float = 0.9) -> Mission:
    """All go to the opposite place of a circle, so far from each other."""
    radius = max(3.0, apart_m * count / (2 * math.pi))
    angles = [2 * math.pi * k / count for k in range(count)]
    starts = [(radius * math.cos(angle), radius * math.sin(angle)) for angle in angles]
    return _swap("circle", starts, [(-x, -y) for x, y in starts], kinematics, seed, None)


def streams(kinematics: str, seed: int, count: int = 40) -> Mission:
    """Two streams that cross at a right angle."""
    longer = -(-count // 2)
    along = [(-8.0 - k, -2.0 + row) for k in range(-(-longer // 5)) for row in range(5)]
    across = [(y, x) for x, y in along]
    starts = along[:longer] + across[: count - longer]
    goals = [(-x, y) for x, y in along[:longer]] + [(x, -y) for x, y in across[: count - longer]]
    return _swap("streams", starts, goals, kinematics, seed, None)


def pair(kinematics: str, seed: int) -> Mission:
    """Two equal robots that meet exactly face to face."""
    return _swap("face to face", [(-4.0, 0.0), (4.0, 0.0)], [(4.0, 0.0), (-4.0, 0.0)], kinematics, 0, None)


def aisles(kinematics: str, seed: int, count: int = 6) -> Mission:
    """Five tasks a robot in aisles of 0.8 m between shelves, open at both ends."""
    return _shelves("aisles", kinematics, seed, count, closed=False)


def dead_ends(kinematics: str, seed: int, count: int = 6) -> Mission:
    """The same with aisles that are closed at their far ends."""
    return _shelves("dead ends", kinematics, seed, count, closed=True)


PLACES: Mapping[str, Callable[[str, int, int], Mission]] = MappingProxyType(
    {
        "one-way-door": one_way_door,
        "two-way-door": two_way_door,
        "corridor": corridor,
        "aisles": aisles,
        "dead-ends": dead_ends,
        "circle": circle,
        "streams": streams,
    }
)
"""From kinematics, a seed and how many robots there are to a mission, by its name."""


@record
class Narrow(Checked):
    """What missions of the family `narrow` share."""

    place: str = spec(Choice(tuple(PLACES)), "where robots are in each other's way", default="one-way-door")
    robots: int = spec(Whole(minimum=2, maximum=200), "how many robots", default=20)
    kinematics: str = spec(Choice(KINEMATICS), "how robots move", default=DIFFERENTIAL)


def narrow_mission(given: Narrow, seed: int) -> Mission:
    """The mission of a seed; that of seed 0 is regular."""
    made = PLACES[given.place](given.kinematics, seed, given.robots)
    robots = (replace(it, position=_rounded(it.position), heading_deg=round(it.heading_deg, 6)) for it in made.robots)
    tasks = (replace(task, position=_rounded(task.position)) for task in made.tasks)
    return replace(made, robots=tuple(robots), tasks=tuple(tasks))


def _rounded(place: tuple[float, ...]) -> tuple[float, ...]:
    return tuple(round(number, 6) for number in place)


NARROW = Generator(
    name="narrow",
    summary="robots with bodies that meet at doors, in corridors, between shelves, on a circle or in two streams",
    source="the scenes of the study `jams`, for 2 to 200 robots",
    parameters=Narrow,
    make=narrow_mission,
)


def _grid(count: int, rows: int, columns: int) -> tuple[int, int]:
    """As many rows and columns as given, if the places suffice; else about equally many."""
    if count <= rows * columns:
        return rows, columns
    rows = math.ceil(math.sqrt(count))
    return rows, -(-count // rows)


def _change_places(name: str, west: list[Place], count: int, kinematics: str, seed: int, chart: Map | None) -> Mission:
    """Robots in the west and, mirrored, in the east: each goes to where one of the others stands."""
    east = [(-x, y) for x, y in west]
    more, fewer = -(-count // 2), count // 2
    starts = west[:more] + east[:fewer]
    return _swap(name, starts, east[:more] + west[:fewer], kinematics, seed, chart)


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
