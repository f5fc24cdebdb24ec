"""The rule that costs nothing, beside the benches of standing fleets: the nearest free robot takes an order."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterable
from dataclasses import dataclass

from muster.mission.model import Event, Mission, Robot, Task

Point = tuple[float, ...]


@dataclass
class _Member:
    """A robot of the fleet: where and when it is free, and how many metres its battery still has."""

    robot: Robot
    at: Point
    level_m: float
    free_s: float = 0.0


def seconds_until_done(mission: Mission, came: Iterable[Event]) -> list[float]:
    """Return how long each order took from when it came, in seconds, in the order in which orders came.

    An order goes at once to the nearest robot that is free. Where none is, the robot that becomes free takes the
    nearest open order. A robot keeps its order to the end. A robot whose battery does not last for the way to the order
    and from there to the nearest dock, above its reserve, charges first, up to full, at the dock that is done with it
    first. Robots go straight at their speed, through each other.
    """
    team = [_Member(robot, robot.position, _capacity_m(robot, at_start=True)) for robot in mission.robots]
    docks = {station.id: 0.0 for station in mission.stations}  # when each is free
    open_orders: list[tuple[float, int, Task]] = []
    took_s: dict[int, float] = {}
    agenda = [(event.at_s, 0, k, event.new_task) for k, event in enumerate(came)]
    heapq.heapify(agenda)

    def take(member: _Member, order: tuple[float, int, Task], now: float) -> None:
        came_s, number, task = order
        begin_s = now if _lasts(mission, member, task) else _charge(mission, docks, member, now)
        way_m = math.dist(member.at, task.position)
        member.free_s = begin_s + way_m / member.robot.speed_mps + (task.duration_s or 0.0)
        member.at, member.level_m = task.position, member.level_m - way_m
        took_s[number] = member.free_s - came_s
        heapq.heappush(agenda, (member.free_s, 1, number, None))

    while agenda:
        now, _, number, task = heapq.heappop(agenda)
        if task is not None:
            open_orders.append((now, number, task))
        free = [member for member in team if member.free_s <= now]
        while free and open_orders:
            _, k, j = min(
                (math.dist(member.at, order[2].position), k, j)
                for k, member in enumerate(free)
                for j, order in enumerate(open_orders)
            )
            take(free.pop(k), open_orders.pop(j), now)
    return [took_s[number] for number in range(len(took_s))]


def _capacity_m(robot: Robot, *, at_start: bool = False) -> float:
    if robot.battery is None:
        return math.inf
    return robot.battery.level_at_start if at_start else robot.battery.capacity


def _lasts(mission: Mission, member: _Member, task: Task) -> bool:
    if member.robot.battery is None:
        return True
    home_m = min(math.dist(task.position, station.position) for station in mission.stations)
    return member.level_m - math.dist(member.at, task.position) - home_m >= member.robot.battery.least


def _charge(mission: Mission, docks: dict[str, float], member: _Member, now: float) -> float:
    """Charge a robot at the dock that is done with it first; returns when it is full."""
    full_m = _capacity_m(member.robot)

    def done_s(k: int) -> float:
        station, way_m = mission.stations[k], math.dist(member.at, mission.stations[k].position)
        begin_s = max(now + way_m / member.robot.speed_mps, docks[station.id])
        return begin_s + (full_m - member.level_m + way_m) / (station.charge_per_s or math.inf)

    station = mission.stations[min(range(len(mission.stations)), key=done_s)]
    docks[station.id] = end_s = done_s(mission.stations.index(station))
    member.at, member.level_m = station.position, full_m
    return end_s
