"""VROOM: its heuristics and local search. It minimises the total; other objectives need a sweep over caps."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import numpy as np
import numpy.typing as npt

from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.sweep import OBJECTIVES, Routed, answered

_EXPLORATION, _FAST_EXPLORATION = 5, 0
_LARGE = 200
"""With more tasks the least exploration level has the better plans within a minute."""
_MOST_PRIORITY = 100
_MOST_TASKS = 2000
Tables = npt.NDArray[np.uint32]
_STEPS = ("job", "pickup", "delivery")
_MOST_COST = 2**31
"""VROOM refuses costs whose sums may be beyond 32 bits: those of large missions are divided."""


class Vroom:
    """VROOM at its highest exploration level where there is time for it; it often ends long before the limit."""

    name = "VROOM"
    distribution = "pyvroom"
    settings = f"exploration level {_EXPLORATION}, {_FAST_EXPLORATION} above {_LARGE} tasks; 1 thread"
    random = False
    by_wall_clock = True

    def cannot(self, instance: Instance) -> str | None:
        if instance.has_prerequisites:
            return "no prerequisites"
        if instance.unusual_rule:
            return f"no {instance.unusual_rule}"
        if instance.timed and (instance.limited or instance.objective != "total"):
            return "no limits of a route's length beside times"
        if len(instance.tasks) > _MOST_TASKS:
            return f"over {_MOST_TASKS} tasks: its first plans alone take far more than the time limit"
        return None if instance.objective in OBJECTIVES else f"no {instance.objective}"

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        return answered(instance, lambda: _Model(instance).run, seconds)


class _Model:
    """The mission for VROOM. Its inputs are used once, so that each run makes a new one from these tables."""

    def __init__(self, instance: Instance) -> None:
        try:
            import vroom
        except ImportError:
            raise missing("VROOM") from None
        self._vroom: Any = vroom
        self.instance = instance
        nodes = instance.node_count
        tables = [instance.usage.arriving(kind)[:nodes, :nodes] for kind in range(len(instance.usage.legs))]
        longest = max(int(table.max(initial=0)) for table in tables)
        self._divisor = -(-longest * (nodes + 2 * instance.robot_count) // _MOST_COST) or 1
        up = self._divisor - 1 if instance.optional else self._divisor // 2  # capacities must hold in truth
        self._costs = [((table + up) // self._divisor).astype(np.uint32) for table in tables]
        self._profiles = dict.fromkeys(map(self._profile, range(instance.robot_count)))
        self._all_allowed = bool(instance.allowed.all())

    def _profile(self, robot: int) -> tuple[int, int]:
        """What a robot's tables depend on."""
        return self.instance.usage.kinds[robot], self.instance.seconds.kinds[robot]

    def _durations(self, kind: int) -> Tables:
        """The work at the place left, and travel."""
        nodes = self.instance.node_count
        return self.instance.seconds.departing(kind)[:nodes, :nodes].astype(np.uint32)

    def _windows(self, task: int) -> list[Any]:
        last = self.instance.horizon
        return [self._vroom.TimeWindow(a, last if b is None else b) for a, b in self.instance.windows[task]]

    def _shift(self, robot: int) -> Any:
        """When a robot leaves at the earliest, and is back at the latest."""
        until = self.instance.available_until[robot]
        return self._vroom.TimeWindow(
            self.instance.available_from[robot], self.instance.horizon if until is None else until
        )

    def _input(self, cap: int | None) -> Any:
        instance, vroom = self.instance, self._vroom
        question = vroom.Input()
        for usage, seconds in self._profiles:
            name = f"{usage} {seconds}"
            question.set_durations_matrix(name, self._durations(seconds) if instance.timed else self._costs[usage])
            question.set_costs_matrix(name, self._costs[usage])
        question.add_vehicle([self._vehicle(i, cap) for i in range(instance.robot_count)])
        question.add_job([self._job(j) for j in instance.goods.alone])
        question.add_job([self._shipment(*transport) for transport in instance.goods.transports])
        return question

    def _job(self, task: int) -> Any:
        pickup = self._amount(self.instance.goods.loads[task])
        return self._vroom.Job(
            task, location=task, pickup=pickup, time_windows=self._windows(task), **self._demands(task)
        )

    def _shipment(self, pickup: int, delivery: int) -> Any:
        steps = [self._vroom.ShipmentStep(j, location=j, time_windows=self._windows(j)) for j in (pickup, delivery)]
        amount = self._amount(self.instance.goods.loads[pickup])
        return self._vroom.Shipment(*steps, amount=amount, **self._demands(pickup, delivery))

    def _demands(self, *tasks: int) -> dict[str, Any]:
        """The skills that tasks need, and their priority."""
        weights = self.instance.weights
        priority = _MOST_PRIORITY * max(weights[j] for j in tasks) // max(weights) if len({*weights}) > 1 else 0
        return {"skills": None if self._all_allowed else {j + 1 for j in tasks}, "priority": priority}

    def _amount(self, load: int) -> Any:
        """An amount; of nothing where no robot has a limit."""
        return self._vroom.Amount([load] if self.instance.goods.limited else [])

    def _vehicle(self, robot: int, cap: int | None) -> Any:
        """A robot; its skills are the tasks that it may do."""
        instance = self.instance
        most = [limit for limit in (cap, instance.capacity[robot]) if limit is not None]
        skills = None if self._all_allowed else {int(j) + 1 for j in np.flatnonzero(instance.allowed[robot])}
        return self._vroom.Vehicle(
            robot,
            start=instance.starts[robot],
            end=None if instance.ends[robot] < 0 else instance.ends[robot],
            profile="{} {}".format(*self._profile(robot)),
            time_window=self._shift(robot) if instance.timed else None,
            skills=skills,
            capacity=[instance.goods.room_or_all(robot)] if instance.goods.limited else [],
            max_travel_time=min(most) // self._divisor if most else None,
        )

    def run(self, cap: int | None, seconds: float) -> Routed | None:
        """One run under a cap."""
        question = self._input(cap)
        limit = timedelta(seconds=max(0.001, seconds))
        level = _EXPLORATION if len(self.instance.tasks) <= _LARGE else _FAST_EXPLORATION
        solution = question.solve(exploration_level=level, nb_threads=1, timeout=limit)
        routes: list[list[int]] = [[] for _ in range(self.instance.robot_count)]
        lengths = [0] * self.instance.robot_count
        for route in solution.to_dict()["routes"]:
            routes[route["vehicle"]] = [step["id"] for step in route["steps"] if step["type"] in _STEPS]
            lengths[route["vehicle"]] = route["cost"] * self._divisor
        return Routed(routes, lengths)
