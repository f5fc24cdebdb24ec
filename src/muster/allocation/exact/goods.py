"""Goods on board, transports and energy as constraints of a program, and what stations add to routes as cuts.

Stations are no part of the program, which is a relaxation without them. Where a route of its plan must call at some, or
cannot be done, the cut says so of all routes that begin alike: a logic-based Benders decomposition ([hooker2003]), of
which `RouteBounds` is the subproblem.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from muster.allocation.bounds.route_bounds import RouteBounds
from muster.allocation.exact.circuits import Circuits
from muster.allocation.exact.costs import real_costs, real_usage
from muster.mission.values.arrays import Floats
from muster.model.problem import Problem

_LOAD_UNITS = 2.0**24  # of the greatest amount
_ROUNDING = 1e-9


def needs_stations(problem: Problem) -> bool:
    """Whether routes may have to call at stations."""
    model = problem.model
    return (bool(model.parts.energy) and model.refills) or _unloads(problem)


def most_detours(problem: Problem) -> float:
    """What stations add to the usage of a route at most, as far as the program can tell it."""
    if not needs_stations(problem):
        return 0.0
    n, m, stations = len(problem.tasks), len(problem.robots), len(problem.mission.stations)
    places = [*range(n + 2 * m + stations)]
    longest = max(
        float(problem.legs(i, places, places)[np.isfinite(problem.legs(i, places, places))].max()) for i in range(m)
    )
    return 2.0 * (n + 1) * (stations + 1) * longest


def most_seconds(problem: Problem) -> float:
    """How much later calls at stations make the tasks of a route at most."""
    if not needs_stations(problem):
        return 0.0
    n, stations = len(problem.tasks), problem.model.stations
    room = max(problem.model.energy[np.isfinite(problem.model.energy)], default=0.0)
    served = sum(station.refill.seconds(room) for station in stations if station.refill is not None)
    slowest = min(robot.speed_mps for robot in problem.robots)
    ways = most_detours(problem) / (1.0 if problem.in_time else min(1.0, slowest))
    return ways + 2.0 * (n + 1) * served


def add_goods(circuits: Circuits) -> None:
    """Let transports be whole, all fit on board, and energy last where no station gives any."""
    problem, model = circuits.problem, circuits.model
    for j, k in enumerate(problem.model.pickups):
        if k >= 0:
            model.add(circuits.done[j] == circuits.done[k])
            for i in circuits.robots:
                model.add(circuits.does.get((i, j), 0) == circuits.does.get((i, k), 0))
    _meters(circuits)
    if not problem.model.refills:
        for i, most in enumerate(problem.model.energy_at_start):
            if np.isfinite(most):
                model.add(circuits.usage[i] <= circuits.costs.scale.at_most(float(most)))


def _unloads(problem: Problem) -> bool:
    return bool(problem.model.meters) and any(station.unloads for station in problem.model.stations)


def _meters(circuits: Circuits) -> None:
    """What is on board after each task; where stations unload, only what is going to be delivered."""
    problem = circuits.problem
    for meter in problem.model.meters:
        unloads = _unloads(problem)
        change, first = (meter.pending, meter.pending_at_start) if unloads else (meter.change, meter.at_start)
        if (change >= 0).all():
            _sum(circuits, change, first, meter.most)
        elif not circuits.rules.with_teams:  # each member takes it on board: left to the cuts
            _meter(circuits, change, first, meter.most)


def _sum(circuits: Circuits, change: Floats, first: Floats, room: Floats) -> None:
    """What only grows is greatest at the end of a route. Amounts are rounded down to units."""
    unit = _LOAD_UNITS / max(1e-12, float(change.max()), float(np.abs(first).max()))
    for i in circuits.robots:
        if room[i] - first[i] < change.sum():
            grows = sum(int(change[j] * unit) * does for (k, j), does in circuits.does.items() if k == i)
            circuits.model.add(grows <= int((room[i] - first[i]) * unit) + 1)


def _meter(circuits: Circuits, change: Floats, first: Floats, room: Floats) -> None:
    """Amounts are rounded to units, and limits give way to as many roundings as there are."""
    model, slack = circuits.model, len(change) + 1
    unit = _LOAD_UNITS / max(1e-12, float(np.abs(change).max()), float(np.abs(first).max()))
    most = int(float(np.abs(first).max() + np.abs(change).sum()) * unit) + 2 * slack
    on_board = [model.new_int_var(-slack, most, "") for _ in change]
    for (i, a, b), leg in circuits.onward():
        before = round(first[i] * unit) if a == circuits.start else on_board[a]
        model.add(on_board[b] == before + round(change[b] * unit)).only_enforce_if(leg)
    for (i, j), does in circuits.does.items():
        if np.isfinite(room[i]) and room[i] * unit < most:
            model.add(on_board[j] <= int(room[i] * unit) + slack).only_enforce_if(does)


@dataclass(frozen=True)
class Cut:
    """What holds of all routes of a robot that begin with these tasks.

    Parameters
    ----------
    adds
        what calls at stations add to the usage; inf: there are no such routes.
    value
        the least of the objective that the tasks come to, of `average` their sum; 0: nothing is known.
    whole
        whether it holds of the route that ends with them alone.
    """

    robot: int
    tasks: tuple[int, ...]
    adds: float
    value: float
    whole: bool


class StationCuts:
    """The cuts that routes of the program give, as far as `RouteBounds` proves them."""

    def __init__(self, problem: Problem) -> None:
        self._bounds = RouteBounds(problem)
        self._known: set[tuple[int, tuple[int, ...]]] = set()

    def of(self, routes: Sequence[Sequence[int]]) -> list[Cut]:
        """The cuts of routes that were not given before."""
        return [cut for i, route in enumerate(routes) if route for cut in self._of_route(i, tuple(route))]

    def _of_route(self, i: int, route: tuple[int, ...]) -> Iterator[Cut]:
        if (i, route) in self._known:
            return
        self._known.add((i, route))
        added = 0.0
        for count in range(1, len(route) + 1):
            adds, _ = self._least(i, route[:count], whole=False)
            if adds > added + _ROUNDING * (1 + added):
                yield Cut(i, route[:count], adds, 0.0, False)
                added = adds
            if adds == np.inf:
                return
        adds, value = self._least(i, route, whole=True)
        if value or adds > added + _ROUNDING * (1 + added):
            yield Cut(i, route, adds, value, True)

    def _least(self, i: int, route: tuple[int, ...], *, whole: bool) -> tuple[float, float]:
        """What calls add to the usage of a route, and the least of the objective; 0 where nothing is proven."""
        bound = self._bounds.of(i, route, whole=whole)
        if bound is None:
            return 0.0, 0.0
        adds = bound.usage - real_usage(self._costs, i, route, ends=whole)
        return max(0.0, adds), bound.value if bound.usage < np.inf else 0.0

    @cached_property
    def _costs(self) -> tuple[Any, Any, Any, Any]:
        return real_costs(self._bounds.problem)
