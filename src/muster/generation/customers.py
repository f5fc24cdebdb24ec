"""Places of customers in families as Solomon [solomon1987], Gehring and Homberger [gehring1999] have them.

R: places all over a square; C: in clusters; RC: half of both. 1: a short day and small vehicles; 2: a long day and
large ones. Numbers are whole.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from random import Random

from muster.generation.generator import MOST_TASKS, Generator
from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Whole

Place = tuple[float, float]

_SIDE, _SPREAD, _PER_CLUSTER = 140, 5.0, 20
_CLUSTER_EDGE = 10
_SERVICE, _CLUSTER_SERVICE = 10, 90
_DAYS = {"R1": 634, "R2": 2535, "C1": 1351, "C2": 3700, "RC1": 650, "RC2": 2650}
_CAPACITY, _LARGE_CAPACITY = 200, 1000
_WIDTHS = (10, 30, 60, 120)
_WIDER = 4
"""Windows are so much wider on a long day."""
_ALL_DAY = 0.25
"""The share of customers who can be visited on the whole day."""
_PER_VEHICLE = 4


@dataclass(frozen=True)
class Kind:
    """A family: its square, its day, and its vehicles."""

    name: str

    def __post_init__(self) -> None:
        if self.name not in _DAYS:
            raise ParameterError(f"family: {self.name}; expected {' or '.join(_DAYS)}")

    @property
    def long(self) -> bool:
        """Whether the day is long."""
        return self.name.endswith("2")

    @property
    def day(self) -> int:
        return _DAYS[self.name]

    @property
    def capacity(self) -> int:
        return _LARGE_CAPACITY if self.long else _CAPACITY

    @property
    def service(self) -> int:
        return _CLUSTER_SERVICE if self.name.startswith("C") else _SERVICE

    @property
    def depot(self) -> Place:
        return _SIDE // 2, _SIDE // 2

    def places(self, count: int, draw: Random) -> list[Place]:
        """So many places on the square."""
        low, high = _CLUSTER_EDGE, _SIDE - _CLUSTER_EDGE
        centres = [(draw.uniform(low, high), draw.uniform(low, high)) for _ in range(max(4, count // _PER_CLUSTER))]
        return [self._place(k, centres[k % len(centres)], draw) for k in range(count)]

    def _place(self, number: int, centre: Place, draw: Random) -> Place:
        if self.name.startswith("C") or (self.name.startswith("RC") and number % 2):
            x, y = (min(_SIDE, max(0, round(draw.gauss(middle, _SPREAD)))) for middle in centre)
            return x, y
        return draw.randint(0, _SIDE), draw.randint(0, _SIDE)


KIND = Choice(tuple(_DAYS))


@record
class Customers(Checked):
    """What missions of the family `customers` share."""

    kind: str = spec(KIND, "where customers are, and how long the day is", default="R1")
    customers: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many customers: tasks", default=25)


def customers_mission(family: str, customers: int, seed: int, *, per_vehicle: int = _PER_VEHICLE) -> Mission:
    """Customers with loads and windows, a vehicle for each four of them unless told otherwise."""
    kind, draw = Kind(family), Random(f"customers {family} {customers} {seed}")
    places = kind.places(customers, draw)
    work = [_customer(str(k), place, kind, draw) for k, place in enumerate(places, start=1)]
    return family_mission(f"customers-{family}-{customers}-{seed}", kind, work, -(-customers // per_vehicle))


def family_mission(name: str, kind: Kind, customers: Sequence[Task], vehicles: int) -> Mission:
    """The mission of vehicles of a family."""
    robots = tuple(
        Robot(
            id=f"r_{k}",
            position=kind.depot,
            load_capacity=kind.capacity,
            available_from_s=0.0,
            available_until_s=kind.day,
        )
        for k in range(vehicles)
    )
    rules = Rules(objective="total", return_to_start=True)
    return Mission(name=f"{name}-{vehicles}", rules=rules, robots=robots, tasks=tuple(customers))


def _customer(name: str, place: Place, kind: Kind, draw: Random) -> Task:
    """A customer who can be visited alone within its window."""
    away = math.dist(place, kind.depot)
    first, last = math.ceil(away), math.floor(kind.day - away - kind.service)
    if draw.random() < _ALL_DAY:
        window = first, last
    else:
        middle, half = draw.randint(first, last), draw.choice(_WIDTHS) * (_WIDER if kind.long else 1) // 2
        window = max(first, middle - half), min(last, middle + half)
    load = draw.choice((10, 20, 30)) if kind.name.startswith("C") else draw.randint(1, 36)
    return Task(id=name, position=place, duration_s=kind.service, window_s=(window,), load=load)


CUSTOMERS = Generator(
    name="customers",
    summary="customers with time windows and loads, vehicles from one depot: vehicle routing with time windows",
    source="in the manner of [solomon1987] and [gehring1999]; the table `customers` of `muster bench peers-goods`",
    parameters=Customers,
    make=lambda given, seed: customers_mission(given.kind, given.customers, seed),
)
