"""The energy of robots under way, as problems of what is left of a mission have it."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from muster.mission.plan import RouteStop
from muster.model.energy import Energy
from muster.model.problem import Problem

_MOST_RESERVE = 0.9  # share of the capacity that is kept for the way to a station at most


@dataclass(frozen=True)
class Held:
    """What a robot holds, in the unit of usage.

    Parameters
    ----------
    level : float
        What it holds when what is under way is done.
    drain : float
        How much it loses for a unit of planned usage.
    used : float
        The usage of its past, which is the beginning of its route.
    """

    level: float
    drain: float
    used: float


def with_held(problem: Problem, held: Sequence[Held | None], kept: Sequence[float]) -> Problem:
    """Return the problem with what robots hold before their past, measured by how fast that drains; None: unbounded.

    Parameters
    ----------
    kept : sequence of float
        What each keeps beside its reserve.
    """
    if not problem.holds("battery"):
        return problem
    robots, levels = [], []
    for robot, now, more in zip(problem.robots, held, kept, strict=True):
        if robot.battery is None or now is None:
            robots.append(robot)
            levels.append(math.inf)
            continue
        capacity, least = robot.battery.capacity / now.drain, robot.battery.least / now.drain + more
        battery = replace(robot.battery, capacity=capacity, reserve=min(least / capacity, _MOST_RESERVE))
        robots.append(replace(robot, battery=battery))
        levels.append(max(now.level / now.drain, battery.least) + now.used)
    return replace(problem, robots=tuple(robots), levels=tuple(levels))


def refilled_to(problem: Problem, i: int, stops: Sequence[RouteStop], usages: Sequence[float]) -> list[float | None]:
    """Return for each stop the share up to which robot i is filled there; None: wholly, or nothing is added.

    Parameters
    ----------
    usages : sequence of float
        What the robot uses from one stop to the end of the next.
    """
    energy = Energy.of(problem.robots[i])
    if energy is None:
        return [None] * len(stops)
    filling = {station.id for station in problem.stations if station.gives_energy}
    level = problem.levels[i] if problem.levels else energy.at_start
    shares: list[float | None] = []
    for stop, usage in zip(stops, usages, strict=True):
        level -= usage
        if stop.charged is not None or stop.name in filling:
            level = min(energy.capacity, level + (math.inf if stop.charged is None else stop.charged))
        shares.append(None if stop.charged is None else level / energy.capacity)
    return shares
