"""OR-Tools CP-SAT: each robot's route is a circuit of arcs that are or are not in it; the objective is exact."""

from __future__ import annotations

import time
from typing import Any

import numpy as np

from muster.studies.peers.instance import Instance
from muster.studies.peers.peer import Answer, missing

_MOST_TASKS = 80
"""Arcs grow with the square of the tasks, times robots."""


class CpSat:
    """OR-Tools CP-SAT with one worker."""

    name = "CP-SAT"
    distribution = "ortools"
    settings = f"OR-Tools' CP-SAT, one circuit a robot, 1 worker, missions of up to {_MOST_TASKS} tasks"
    random = False

    def cannot(self, instance: Instance) -> str | None:
        return f"more than {_MOST_TASKS} tasks" if len(instance.tasks) > _MOST_TASKS else None

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        begin = time.perf_counter()
        model = _Model(instance)
        build_s = time.perf_counter() - begin
        return model.solved(seconds, seed, build_s)


class _Model:
    """The mission as a CP-SAT model. A circuit runs over a robot's tasks and one node more, its start and end."""

    def __init__(self, instance: Instance) -> None:
        try:
            from ortools.sat.python import cp_model
        except ImportError:
            raise missing("CP-SAT") from None
        self._cp: Any = cp_model
        self._model: Any = cp_model.CpModel()
        self.instance = instance
        self._tasks = range(len(instance.tasks))
        self._robots = range(instance.robot_count)
        self._does: dict[tuple[int, int], Any] = {}
        self._arcs: list[dict[tuple[int, int], Any]] = [self._circuit(i) for i in self._robots]
        self._done = [sum(self._does[i, j] for i in instance.allowed_robots(j)) for j in self._tasks]
        for done in self._done:
            self._model.add(done <= 1 if instance.optional else done == 1)
        self._usages = [self._usage(i) for i in self._robots]
        self._arrivals = self._cumulated(in_time=False) if instance.objective == "average" else []
        in_time = instance.has_prerequisites or instance.objective == "makespan"
        self._begins = self._cumulated(in_time=True) if in_time else []
        self._set_prerequisites()
        self._objective = self._make_objective()
        left_out = sum((1 - done) * weight for done, weight in zip(self._done, instance.weights, strict=True))
        most = max(instance.usage.bound, instance.seconds.bound) * (len(self._tasks) + 1)
        self._model.minimize(self._objective + (most * left_out if instance.optional else 0))

    def _circuit(self, robot: int) -> dict[tuple[int, int], Any]:
        """The arcs of a robot's circuit; its start and end is the node after its tasks."""
        model, tasks = self._model, [int(j) for j in np.flatnonzero(self.instance.allowed[robot])]
        home = len(tasks)
        nodes = range(home + 1)
        literals = {(a, b): model.new_bool_var("") for a in nodes for b in nodes}
        model.add_circuit([(a, b, literal) for (a, b), literal in literals.items()])
        for k, j in enumerate(tasks):
            self._does[robot, j] = literals[k, k].negated()
            model.add_implication(literals[home, home], literals[k, k])
        names = [*tasks, -1]
        return {(names[a], names[b]): literal for (a, b), literal in literals.items() if a != b}

    def _leg(self, robot: int, begin: int, end: int, in_time: bool) -> int:
        """The way between two tasks; -1 is where the robot starts, or ends."""
        instance = self.instance
        costs = instance.seconds if in_time else instance.usage
        begin = instance.starts[robot] if begin < 0 else begin
        end = instance.ends_or_anywhere[robot] if end < 0 else end
        return int(costs.legs[costs.kinds[robot], begin, end])

    def _work(self, robot: int, task: int, in_time: bool) -> int:
        costs = self.instance.seconds if in_time else self.instance.usage
        return 0 if task < 0 else int(costs.work[costs.kinds[robot], task])

    def _usage(self, robot: int) -> Any:
        terms = [
            literal * (self._leg(robot, a, b, False) + self._work(robot, b, False))
            for (a, b), literal in self._arcs[robot].items()
        ]
        most = self.instance.capacity[robot]
        usage = self._model.new_int_var(0, self.instance.usage.bound if most is None else most, "")
        self._model.add(usage == sum(terms))
        return usage

    def _cumulated(self, in_time: bool) -> list[Any]:
        """For each task when work on it begins, or the usage at which a robot arrives; 0 where it is left out."""
        costs = self.instance.seconds if in_time else self.instance.usage
        most = costs.bound + max(self.instance.available_from)
        found = [self._model.new_int_var(0, most, "") for _ in self._tasks]
        for i in self._robots:
            first = self.instance.available_from[i] if in_time else 0
            for (a, b), literal in self._arcs[i].items():
                if b >= 0:
                    before = first if a < 0 else found[a] + self._work(i, a, in_time)
                    self._model.add(found[b] >= before + self._leg(i, a, b, in_time)).only_enforce_if(literal)
        return found

    def _set_prerequisites(self) -> None:
        for j, before in enumerate(self.instance.prerequisites):
            for k in before:
                self._model.add(self._done[j] <= self._done[k])
                for i in self.instance.allowed_robots(k):
                    end = self._begins[k] + max(1, self._work(i, k, True))
                    literals = [self._does[i, k]]
                    self._model.add(self._begins[j] >= end).only_enforce_if(literals)

    def _make_objective(self) -> Any:
        objective = self.instance.objective
        if objective == "average":
            return sum(self._arrivals)
        if objective == "makespan":
            return self._greatest([self._begins[j] + self._work(i, j, True) * d for (i, j), d in self._does.items()])
        total = sum(self._usages) if objective.startswith("total") else 0
        return total + (self._greatest(self._usages) if objective.endswith("max") else 0)

    def _greatest(self, terms: list[Any]) -> Any:
        instance = self.instance
        most = max(instance.usage.bound, instance.seconds.bound) + max(instance.available_from)
        greatest = self._model.new_int_var(0, most, "")
        for term in terms:
            self._model.add(greatest >= term)
        return greatest

    def solved(self, seconds: float, seed: int, build_s: float) -> Answer:
        """Search for so many seconds."""
        solver = self._cp.CpSolver()
        solver.parameters.max_time_in_seconds = seconds
        solver.parameters.num_workers = 1
        solver.parameters.random_seed = seed
        status = solver.solve(self._model)
        if status not in (self._cp.OPTIMAL, self._cp.FEASIBLE):
            return Answer(None, build_s=build_s)
        routes = [self._route(solver, i) for i in self._robots]
        proven = status == self._cp.OPTIMAL
        # Until it is proven best, the model may have arrivals later than they must be: it counts more than is true.
        exact = proven or self.instance.objective not in ("average", "makespan")
        claimed = self._claimed(solver, routes) if exact else None
        return Answer(routes, claimed, build_s, proven)

    def _route(self, solver: Any, robot: int) -> list[int]:
        after = {a: b for (a, b), literal in self._arcs[robot].items() if solver.boolean_value(literal)}
        route: list[int] = []
        task = after.get(-1, -1)
        while task >= 0:
            route.append(task)
            task = after[task]
        return route

    def _claimed(self, solver: Any, routes: list[list[int]]) -> float:
        instance = self.instance
        value = float(solver.value(self._objective))
        if instance.objective == "average":
            value /= max(1, sum(map(len, routes)))
        scale = instance.seconds.scale if instance.objective == "makespan" else instance.usage.scale
        return value / scale
