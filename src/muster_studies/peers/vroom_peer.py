"""VROOM: its heuristics and local search. It minimises the total; other objectives need a sweep over caps."""

from __future__ import annotations

from datetime import timedelta
from typing import Any

import numpy as np

from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.sweep import OBJECTIVES, Routed, answered

_EXPLORATION, _FAST_EXPLORATION = 5, 0
_LARGE = 200
"""With more tasks the least exploration level has the better plans within a minute."""
_MOST_PRIORITY = 100
_MOST_TASKS = 2000
_MOST_COST = 2**31
"""VROOM refuses costs whose sums may be beyond 32 bits: those of large missions are divided."""


class Vroom:
    """VROOM at its highest exploration level where there is time for it; it often ends long before the limit."""

    name = "VROOM"
    distribution = "pyvroom"
    settings = f"exploration level {_EXPLORATION}, {_FAST_EXPLORATION} above {_LARGE} tasks; 1 thread"
    random = False

    def cannot(self, instance: Instance) -> str | None:
        if instance.has_prerequisites:
            return "no prerequisites"
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
        self._tables = [((table + up) // self._divisor).astype(np.uint32) for table in tables]
        self._all_allowed = bool(instance.allowed.all())

    def _input(self, cap: int | None) -> Any:
        instance, vroom = self.instance, self._vroom
        question = vroom.Input()
        for kind, table in enumerate(self._tables):
            question.set_durations_matrix(str(kind), table)
        question.add_vehicle([self._vehicle(i, cap) for i in range(instance.robot_count)])
        for j, weight in enumerate(instance.weights):
            skills = None if self._all_allowed else {j + 1}
            priority = _MOST_PRIORITY * weight // max(instance.weights) if len({*instance.weights}) > 1 else 0
            question.add_job(vroom.Job(j, location=j, skills=skills, priority=priority))
        return question

    def _vehicle(self, robot: int, cap: int | None) -> Any:
        """A robot; its skills are the tasks that it may do."""
        instance = self.instance
        most = [limit for limit in (cap, instance.capacity[robot]) if limit is not None]
        skills = None if self._all_allowed else {int(j) + 1 for j in np.flatnonzero(instance.allowed[robot])}
        return self._vroom.Vehicle(
            robot,
            start=instance.starts[robot],
            end=None if instance.ends[robot] < 0 else instance.ends[robot],
            profile=str(instance.usage.kinds[robot]),
            skills=skills,
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
            routes[route["vehicle"]] = [step["id"] for step in route["steps"] if step["type"] == "job"]
            lengths[route["vehicle"]] = route["cost"] * self._divisor
        return Routed(routes, lengths)
