"""Missions of vehicles that serve customers from one depot, as the instance files of vehicle routing describe them.

A customer is a task whose id is its number in the file; service time, time window and demand are the task's
`duration_s`, `window_s` and `load`. Demand is taken on board: a route that collects what its customers ask for, and one
that brings it, keep the same limit. Robots move at 1 m/s, as in these files distance and time are the same number.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path as FilePath
from typing import Any

from muster.mission.errors import Finding, MissionError
from muster.mission.model import SCHEMA, Mission
from muster.mission.reading.from_data import mission_from
from muster.mission.site import Point, TravelTable
from muster.mission.source import Place, Source
from muster.mission.value_types import Path

DEMAND, READY, DUE, SERVICE = "demand", "ready time", "due date", "service time"
MOST_VEHICLES = 100_000
NONE = "0"
"""The number in place of a pickup or delivery where a customer has none."""


@dataclass(frozen=True)
class Customer:
    """A customer, or the depot; `line` is where it is in the file, `lines` where its demand and times are."""

    line: int | None
    id: str
    position: Point
    demand: float = 0.0
    window: tuple[float, float] | None = None
    service: float = 0.0
    pickup: str = NONE
    delivery: str = NONE
    lines: Mapping[str, int] = field(default_factory=dict)
    only: tuple[str, ...] | None = None
    """The robots that may serve it; None where all may."""

    def wrong(self, file: str, name: str, value: float | str, expected: str) -> Finding:
        """What to say of a value that is wrong."""
        text = value if isinstance(value, str) else f"{value:g}"
        return Finding(file, self.lines.get(name, self.line), name, text, expected)


@dataclass(frozen=True, kw_only=True)
class Instance:
    """A depot, customers, and vehicles; `robot` and `mission` hold further keys.

    Vehicles are equal, unless `own` has the keys of each in which it differs. `depots` are those beside the first.
    """

    path: FilePath
    name: str
    depot: Customer
    customers: Sequence[Customer]
    vehicles: int
    capacity: float | None
    robot: Mapping[str, Any] = field(default_factory=dict)
    mission: Mapping[str, Any] = field(default_factory=dict)
    tables: Mapping[str, TravelTable] = field(default_factory=dict)
    own: Sequence[Mapping[str, Any]] = ()
    depots: Sequence[Customer] = ()


def instance_mission(instance: Instance) -> Mission:
    """The mission of an instance.

    Raises
    ------
    MissionError
        with everything that is wrong with the customers.
    """
    found = sorted(_wrong_customers(instance), key=lambda finding: finding.line or 0)
    if found:
        raise MissionError(found)
    depot, customers, file = instance.depot, instance.customers, str(instance.path)
    start = {"position": depot.position, **instance.robot}
    if instance.capacity is not None:
        start["load_capacity"] = instance.capacity
    if depot.window is not None:
        start["available_from_s"], start["available_until_s"] = depot.window
    data: dict[str, Any] = {"schema": SCHEMA, "name": f"{instance.name}-{instance.vehicles}", **instance.mission}
    data["rules"] = {"objective": "total", "return_to_start": True, **instance.mission.get("rules", {})}
    own = instance.own or [{}] * instance.vehicles
    data["robots"] = [{"id": name, **start, **of} for name, of in zip(robot_ids(instance.vehicles), own, strict=True)]
    data["tasks"] = [_task(customer) for customer in customers]
    places: dict[Path, Place] = {("tasks", k): (file, customer.line) for k, customer in enumerate(customers)}
    places[("robots",)] = (file, depot.line)
    return mission_from(data, Source(file, places), [], instance.tables)


def robot_ids(vehicles: int) -> list[str]:
    """The ids of so many robots: `r_0`, `r_1`, ..."""
    return [f"r_{k}" for k in range(vehicles)]


def fleet(path: FilePath, line: int | None, field: str, in_file: float, salesmen: int | None) -> int:
    """The number of vehicles: of the file, at `line`, if it is not given.

    Raises
    ------
    MissionError
        if it is no whole number of at least 1, or very large.
    """
    count = in_file if salesmen is None else salesmen
    if not 1 <= count <= MOST_VEHICLES or count % 1:
        place, name = (line, field) if salesmen is None else (None, "salesmen")
        expected = f"a whole number from 1 to {MOST_VEHICLES}"
        raise MissionError([Finding(str(path), place, name, f"{count:g}", expected)])
    return int(count)


def enough_vehicles(customers: Sequence[Customer], capacity: float | None) -> int:
    """So many vehicles as plans of a file without a fleet may need at most.

    Where only capacity binds it is a third more than the demand fills, and three [vidal2022]; else one a customer.
    """
    if capacity is None or any(customer.window for customer in customers):
        return max(1, len(customers))
    total = sum(customer.demand for customer in customers)
    return max(1, min(len(customers), math.ceil(1.3 * total / capacity) + 3))


def _task(customer: Customer) -> dict[str, Any]:
    task: dict[str, Any] = {"id": customer.id, "position": customer.position}
    if customer.service:
        task["duration_s"] = customer.service
    if customer.window is not None:
        task["window_s"] = list(customer.window)
    if customer.only is not None:
        task["only_robots"] = list(customer.only)
    if customer.pickup != NONE:
        task["delivers"] = customer.pickup
    elif customer.demand:
        task["load"] = customer.demand
    return task


def _wrong_customers(instance: Instance) -> Iterator[Finding]:
    file, first = str(instance.path), dict[str, Customer]()
    depots = (instance.depot, *instance.depots)
    for one in (*depots, *instance.customers):
        if one.id in first:
            yield one.wrong(file, "number", one.id, "a number of its own")
        first.setdefault(one.id, one)
    for one in (*depots, *instance.customers):
        yield from _wrong_times(file, one)
        if one.only == ():
            yield one.wrong(file, "allowed clients", f"no vehicle for customer {one.id}", "at least one")
        if any(one is depot for depot in depots):
            if one.demand:
                yield one.wrong(file, DEMAND, one.demand, "0: this is the depot")
        elif one.pickup == NONE:
            yield from _wrong_pickup(file, one, first)
        else:
            yield from _wrong_delivery(file, one, first)


def _wrong_times(file: str, one: Customer) -> Iterator[Finding]:
    if one.window is not None:
        ready, due = one.window
        if ready < 0:
            yield one.wrong(file, READY, ready, "a number of at least 0")
        if due < ready:
            yield one.wrong(file, DUE, due, f"a number of at least the ready time ({ready:g})")
    if one.service < 0:
        yield one.wrong(file, SERVICE, one.service, "a number of at least 0")


def _wrong_pickup(file: str, one: Customer, everyone: Mapping[str, Customer]) -> Iterator[Finding]:
    """What is wrong with a customer whose load is taken: its delivery names it, where there is one."""
    if one.delivery != NONE:
        known = everyone.get(one.delivery)
        if known is None or known.pickup != one.id:
            yield one.wrong(file, "delivery", one.delivery, f"the number of a customer whose pickup is {one.id}")
        if one.demand <= 0:
            yield one.wrong(file, DEMAND, one.demand, "a number above 0")
    elif one.demand < 0:
        yield one.wrong(file, DEMAND, one.demand, "a number of at least 0")


def _wrong_delivery(file: str, one: Customer, everyone: Mapping[str, Customer]) -> Iterator[Finding]:
    """What is wrong with a customer who gets a load: it is what the pickup takes, which names this customer."""
    known = everyone.get(one.pickup)
    if one.delivery != NONE:
        yield one.wrong(file, "delivery", one.delivery, f"0 beside the pickup {one.pickup}: it is one of both")
    elif known is None or known.delivery != one.id:
        yield one.wrong(file, "pickup", one.pickup, f"the number of a customer whose delivery is {one.id}")
    elif one.demand != -known.demand:
        yield one.wrong(file, DEMAND, one.demand, f"{-known.demand:g}, what the pickup {one.pickup} takes")
