"""A warehouse: racks with aisles between them, robots that fetch from the racks and put down at a dock."""

from __future__ import annotations

from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.mission.model import Map, Mission, Robot, Rules, Station, Task, Zone
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Number, Whole

_RACK_M, _AISLE_M = 1.0, 2.4
"""How deep a rack and how wide an aisle is."""
_FRONT_M = 4.0
"""How wide the lanes at both ends of the aisles are; the dock is at the southern one."""
_APART_M = 1.2
_UNLOADING = 2
_DURATIONS_S = (5, 15)


@record
class Warehouse(Checked):
    """What missions of the family `warehouse` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=4)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many picks", default=24)
    aisles: int = spec(Whole(minimum=1, maximum=200), "how many aisles, with racks on both sides", default=5)
    length_m: float = spec(Number(minimum=2), "length of a rack", default=16.0)
    load_capacity: int = spec(Whole(minimum=1, maximum=1_000_000), "picks that a robot carries at once", default=4)


def warehouse_mission(given: Warehouse, seed: int) -> Mission:
    """The mission of a seed: each pick is from a side of an aisle, and takes 5 to 15 s."""
    draw, width = Random(seed), _width(given)
    return Mission(
        rules=Rules(objective="makespan", return_to_start=True, makespan_includes_return=True),
        map=_map(given),
        stations=(Station(id="dock", position=(0.0, 1.0), services=("unload",), slots=_UNLOADING),),
        robots=tuple(
            Robot(
                id=f"r_{k}",
                position=_parked(k, width),
                kind="ground",
                kinematics="differential-drive",
                radius_m=0.35,
                speed_mps=1.2,
                acceleration_mps2=0.8,
                yaw_rate_radps=1.5,
                load_capacity=given.load_capacity,
            )
            for k in range(given.robots)
        ),
        tasks=tuple(_pick(str(k), given, draw) for k in range(given.tasks)),
    )


def _width(given: Warehouse) -> float:
    return given.aisles * (_AISLE_M + _RACK_M) + _RACK_M


def _parked(number: int, width: float) -> tuple[float, float]:
    """In rows of the place south of the racks, from the west."""
    each = max(1, int(width / _APART_M))
    row, place = divmod(number, each)
    return round(_APART_M * (place + 0.5), 3), round(-_APART_M * (row + 1), 3)


def _pick(name: str, given: Warehouse, draw: Random) -> Task:
    """Something of a rack, at which a robot stands half a metre from the middle of the aisle."""
    aisle, side = draw.randrange(given.aisles), draw.choice((-0.5, 0.5))
    middle = _RACK_M + aisle * (_AISLE_M + _RACK_M) + _AISLE_M / 2
    along = _FRONT_M + draw.uniform(0, given.length_m)
    return Task(
        id=name, position=(round(middle + side, 3), round(along, 3)), duration_s=draw.randint(*_DURATIONS_S), load=1
    )


def _map(given: Warehouse) -> Map:
    width, north = _width(given), 2 * _FRONT_M + given.length_m
    rows = -(-given.robots // max(1, int(width / _APART_M)))
    west, east, south = -_FRONT_M, width + _FRONT_M, -_APART_M * (rows + 1)
    racks = [k * (_AISLE_M + _RACK_M) for k in range(given.aisles + 1)]
    return Map(
        boundary=((west, south), (east, south), (east, north), (west, north)),
        zones=tuple(Zone(polygon=_box(x, _FRONT_M, x + _RACK_M, _FRONT_M + given.length_m)) for x in racks),
    )


def _box(west: float, south: float, east: float, north: float) -> tuple[tuple[float, float], ...]:
    corners = (west, south), (east, south), (east, north), (west, north)
    return tuple((round(x, 3), round(y, 3)) for x, y in corners)


WAREHOUSE = Generator(
    name="warehouse",
    summary="racks and aisles on a map; robots with bodies fetch loads from the racks and put them down at a dock",
    source="made for comparisons, in the manner of the shipped mission `warehouse`, in any size",
    parameters=Warehouse,
    make=warehouse_mission,
)
