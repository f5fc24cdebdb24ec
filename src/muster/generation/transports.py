"""Transports with windows in the manner of Li and Lim [li2001]: pairs made from the routes of a plan at random.

Each route goes on to one of the nearest places left until the day ends; any two of its stops that stand in order are a
transport, and windows lie round the arrivals. So that plan does all tasks with as many vehicles as there are.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from itertools import count
from random import Random

from muster.generation.customers import KIND, Kind, Place, family_mission
from muster.generation.generator import MOST_ROBOTS, Generator
from muster.mission.model import Mission, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole

_NEAREST = 4
_MARGIN = 2.0
"""A route is back so long before the day ends: windows are whole numbers."""
_EARLIER_LATER = (10.0, 60.0)
_WIDER = 3
_LOADS = (5, 40)


@record
class Transports(Checked):
    """What missions of the family `transports` share."""

    kind: str = spec(KIND, "where pickups and deliveries are, and how long the day is", default="R1")
    transports: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many transports: two tasks each", default=12)


@dataclass(frozen=True)
class _Stop:
    place: Place
    arrival: float


def transports_mission(family: str, transports: int, seed: int) -> Mission:
    """So many pairs of pickup and delivery, two tasks each, and as many vehicles as the plan at random has routes."""
    kind, draw = Kind(family), Random(f"transports {family} {transports} {seed}")
    left = kind.places(2 * transports, draw)
    numbers, customers, vehicles = count(1), list[Task](), 0
    while left:
        route = _route(kind, left, draw)
        customers += _paired(kind, route, numbers, draw)
        vehicles += 1
    return family_mission(f"transports-{family}-{transports}-{seed}", kind, customers, vehicles)


def _route(kind: Kind, left: list[Place], draw: Random) -> Sequence[_Stop]:
    """An even number of stops, taken away from what is left."""
    route, at, now = list[_Stop](), kind.depot, 0.0
    while left:
        near = sorted(left, key=lambda place: math.dist(at, place))[:_NEAREST] if route else left
        place = draw.choice(near)
        arrival = now + math.dist(at, place)
        if arrival + kind.service + math.dist(place, kind.depot) > kind.day - _MARGIN:
            break
        left.remove(place)
        route.append(_Stop(place, arrival))
        at, now = place, arrival + kind.service
    if len(route) % 2:
        left.append(route.pop().place)
    return route


def _paired(kind: Kind, route: Sequence[_Stop], numbers: count[int], draw: Random) -> list[Task]:
    """The stops as customers; what is on board fits in a vehicle at any time."""
    order = draw.sample(range(len(route)), len(route))
    pairs = [sorted(pair) for pair in zip(order[::2], order[1::2], strict=True)]
    aboard, found = [0] * len(route), []
    for first, then in pairs:
        room = kind.capacity - max(aboard[first:then])
        load = max(1, min(draw.randint(*_LOADS), room))
        aboard[first:then] = [amount + load for amount in aboard[first:then]]
        pickup, delivery = str(next(numbers)), str(next(numbers))
        found.append(_customer(kind, route[first], draw, pickup, load=load))
        found.append(_customer(kind, route[then], draw, delivery, delivers=pickup))
    return found


def _customer(
    kind: Kind, stop: _Stop, draw: Random, name: str, *, load: int | None = None, delivers: str | None = None
) -> Task:
    wider = _WIDER if kind.long else 1
    before, after = (wider * draw.uniform(*_EARLIER_LATER) for _ in range(2))
    last = math.floor(kind.day - kind.service - math.dist(stop.place, kind.depot))
    window = math.floor(max(0.0, stop.arrival - before)), min(last, math.ceil(stop.arrival + after))
    return Task(id=name, position=stop.place, duration_s=kind.service, window_s=(window,), load=load, delivers=delivers)


TRANSPORTS = Generator(
    name="transports",
    summary="pickups and deliveries with time windows and loads, vehicles from one depot",
    source="in the manner of [li2001]; the table `transports` of `muster bench peers-goods`",
    parameters=Transports,
    make=lambda given, seed: transports_mission(given.kind, given.transports, seed),
)
