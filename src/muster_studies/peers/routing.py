"""OR-Tools routing: constraint programming with local search.

Its own objective is the cost of arcs, the greatest end of a dimension (`global span`), and soft bounds of a dimension
at nodes; guided local search punishes long arcs. Where arcs are not part of the objective they break ties, which also
shows guided local search the way; the routing library's own example of a global span does the same.
"""

from __future__ import annotations

import math
import time
from collections.abc import Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from typing import Any

from muster_studies.peers.costs import Costs
from muster_studies.peers.instance import Instance
from muster_studies.peers.peer import Answer, missing
from muster_studies.peers.processor_time import ProcessorStop


@dataclass(frozen=True)
class _Attempt:
    """A search: its first solution, and what one of the objective weighs against one of arcs that break ties."""

    first: str
    weight: int


_ATTEMPTS = (_Attempt("PATH_CHEAPEST_ARC", 100), _Attempt("PARALLEL_CHEAPEST_INSERTION", 10))
"""Neither is better throughout: each has half the time, and the better result counts."""
_LARGE = 200
"""With more tasks the insertion is far better, and has all the time."""
_LONGEST_S = 24 * 3600
"""The limit by the wall clock, without which guided local search warns that it may run forever."""
_USAGE, _TIME = "usage", "time"


class Routing:
    """OR-Tools routing with guided local search."""

    name = "OR-Tools"
    distribution = "ortools"
    settings = (
        "routing library; path cheapest arc and parallel cheapest insertion, half the time each (the latter alone "
        f"above {_LARGE} tasks), then guided local search"
    )
    random = False
    by_wall_clock = False

    def cannot(self, instance: Instance) -> str | None:
        return f"no {instance.unusual_rule}" if instance.unusual_rule else None

    def solve(self, instance: Instance, seconds: float, seed: int) -> Answer:
        attempts = _ATTEMPTS if len(instance.tasks) <= _LARGE else _ATTEMPTS[-1:]
        answers = [_attempted(instance, attempt, seconds / len(attempts)) for attempt in attempts]
        best = min(answers, key=lambda answer: _rank(instance, answer))
        return replace(best, build_s=sum(answer.build_s for answer in answers))


def _attempted(instance: Instance, attempt: _Attempt, seconds: float) -> Answer:
    begin = time.perf_counter()
    model = _Model(instance, attempt)
    build_s = time.perf_counter() - begin
    return model.solved(seconds, build_s)


def _rank(instance: Instance, answer: Answer) -> tuple[float, float]:
    """Lower is better: more tasks first, then the objective."""
    if answer.routes is None or answer.claimed is None:
        return math.inf, math.inf
    return -instance.weight(answer.routes), answer.claimed


class _Model:
    """The mission as a routing model."""

    def __init__(self, instance: Instance, attempt: _Attempt) -> None:
        try:
            from ortools.constraint_solver import pywrapcp
        except ImportError:
            raise missing("OR-Tools") from None
        self.instance, self._attempt = instance, attempt
        self._nodes = max(instance.node_count, *(end + 1 for end in instance.ends_or_anywhere))
        self._manager = pywrapcp.RoutingIndexManager(
            self._nodes, instance.robot_count, instance.starts, instance.ends_or_anywhere
        )
        self._model: Any = pywrapcp.RoutingModel(self._manager)
        self._robots = range(instance.robot_count)
        self._set_costs()
        self._set_tasks()
        if instance.goods.limited:
            self._set_loads()
        if (
            instance.has_prerequisites
            or instance.timed
            or instance.goods.transports
            or instance.objective == "makespan"
        ):
            self._set_times()

    def _index(self, task: int) -> int:
        return int(self._manager.NodeToIndex(task))

    def _registered(self, costs: Costs) -> list[int]:
        """For each robot the evaluator of its legs, each table handed over once."""
        tables = [
            self._model.RegisterTransitMatrix(costs.departing(kind)[: self._nodes, : self._nodes].tolist())
            for kind in range(len(costs.legs))
        ]
        return [tables[kind] for kind in costs.kinds]

    @property
    def _counts_usage(self) -> bool:
        """Whether the usage on the way is needed, not only its sum."""
        return self.instance.limited or self.instance.objective not in ("total", "makespan")

    def _set_costs(self) -> None:
        instance, model = self.instance, self._model
        evaluators = self._registered(instance.usage)
        for i in self._robots:
            model.SetArcCostEvaluatorOfVehicle(evaluators[i], i)
        if not self._counts_usage:
            return
        most = [instance.usage.bound if c is None else c for c in instance.capacity]
        model.AddDimensionWithVehicleTransitAndCapacity(evaluators, 0, most, True, _USAGE)
        usage = model.GetDimensionOrDie(_USAGE)
        if instance.objective in ("max", "total+max"):
            usage.SetGlobalSpanCostCoefficient(self._attempt.weight if instance.objective == "max" else 1)
        if instance.objective == "average":
            for task in range(len(instance.tasks)):
                usage.SetCumulVarSoftUpperBound(self._index(task), 0, self._attempt.weight)

    def _set_loads(self) -> None:
        """What is on board after each task."""
        goods, nodes = self.instance.goods, self._nodes
        loads = self._model.RegisterUnaryTransitVector([*goods.loads, *[0] * (nodes - len(goods.loads))])
        room = [goods.room_or_all(i) for i in self._robots]
        self._model.AddDimensionWithVehicleCapacity(loads, 0, room, True, "loads")

    def _set_tasks(self) -> None:
        instance, model = self.instance, self._model
        arrivals = len(instance.tasks) if instance.objective == "average" else 1
        penalty = instance.usage.bound * (self._attempt.weight + 1) * arrivals
        for task in range(len(instance.tasks)):
            index, robots = self._index(task), instance.allowed_robots(task)
            if instance.optional:
                model.AddDisjunction([index], penalty * instance.weights[task])
            if len(robots) < instance.robot_count:
                # Not by SetAllowedVehiclesForIndex, which takes no list at all in Python as of 9.15.
                model.VehicleVar(index).SetValues([*([-1] if instance.optional else []), *robots])

    def _set_times(self) -> None:
        """Times of tasks: waiting is slack, and what a task waits for ends before it begins."""
        instance, model, costs = self.instance, self._model, self.instance.seconds
        horizon = instance.horizon
        limits = [horizon] * instance.robot_count
        model.AddDimensionWithVehicleTransitAndCapacity(self._registered(costs), horizon, limits, True, _TIME)
        times = model.GetDimensionOrDie(_TIME)
        for i in self._robots:
            times.SlackVar(model.Start(i)).SetMin(instance.available_from[i])
            if (until := instance.available_until[i]) is not None:
                times.CumulVar(model.End(i)).SetMax(until)
        for task, windows in enumerate(instance.windows):
            self._set_windows(times.CumulVar(self._index(task)), windows, horizon)
        if instance.objective == "makespan":
            times.SetGlobalSpanCostCoefficient(self._attempt.weight)
        for task, before in enumerate(instance.prerequisites):
            for k in before:
                self._set_precedence(times, k, task)
        for transport in instance.goods.transports:
            self._set_transport(times, *transport)

    def _set_transport(self, times: Any, pickup: int, delivery: int) -> None:
        """One robot does both, one after the other, or none does."""
        model, first, then = self._model, self._index(pickup), self._index(delivery)
        model.AddPickupAndDelivery(first, then)
        model.solver().Add(model.VehicleVar(first) == model.VehicleVar(then))
        model.solver().Add(times.CumulVar(first) <= times.CumulVar(then))

    @staticmethod
    def _set_windows(begin: Any, windows: Sequence[tuple[int, int | None]], horizon: int) -> None:
        """Work begins within one of the windows, which stand in order and do not overlap."""
        if not windows:
            return
        begin.SetRange(windows[0][0], windows[-1][1] or horizon)
        for (_, closes), (opens, _) in pairwise(windows):
            if closes is not None and closes + 1 <= opens - 1:
                begin.RemoveInterval(closes + 1, opens - 1)

    def _set_precedence(self, times: Any, before: int, task: int) -> None:
        instance, solver = self.instance, self._model.solver()
        costs = instance.seconds
        work = [int(costs.work[kind, before]) for kind in costs.kinds]
        first, then = self._index(before), self._index(task)
        robots = instance.allowed_robots(before)
        least = min(work[i] for i in robots)
        times.AddNodePrecedence(first, then, max(1, least))
        if any(work[i] > least for i in robots):
            robot = self._model.VehicleVar(first)
            longer = solver.Sum([(work[i] - least) * solver.IsEqualCstVar(robot, i) for i in robots if work[i] > least])
            solver.Add(times.CumulVar(then) >= times.CumulVar(first) + least + longer)
        if instance.optional:
            solver.Add(self._model.ActiveVar(then) <= self._model.ActiveVar(first))

    def solved(self, seconds: float, build_s: float) -> Answer:
        """Search for so many seconds."""
        from ortools.constraint_solver import pywrapcp
        from ortools.constraint_solver.routing_enums_pb2 import FirstSolutionStrategy, LocalSearchMetaheuristic

        parameters = pywrapcp.DefaultRoutingSearchParameters()
        parameters.first_solution_strategy = FirstSolutionStrategy.Value.Value(self._attempt.first)
        parameters.local_search_metaheuristic = LocalSearchMetaheuristic.GUIDED_LOCAL_SEARCH
        parameters.time_limit.FromSeconds(_LONGEST_S)
        stop = ProcessorStop(seconds)
        self._model.AddSearchMonitor(self._model.solver().CustomLimit(stop.due))
        solution = self._model.SolveWithParameters(parameters)
        if solution is None:
            return Answer(None, build_s=build_s)
        return Answer(self._routes(solution), self._claimed(solution), build_s)

    def _routes(self, solution: Any) -> list[list[int]]:
        routes = []
        for i in self._robots:
            route, index = [], solution.Value(self._model.NextVar(self._model.Start(i)))
            while not self._model.IsEnd(index):
                route.append(int(self._manager.IndexToNode(index)))
                index = solution.Value(self._model.NextVar(index))
            routes.append(route)
        return routes

    def _claimed(self, solution: Any) -> float | None:
        """The objective as the library counts it."""
        instance, model = self.instance, self._model
        if instance.objective == "total" and not self._counts_usage:
            return float(self._arcs(solution) / instance.usage.scale)
        if instance.objective == "total+max" and not instance.optional:
            return float(solution.ObjectiveValue() / instance.usage.scale)
        if instance.objective == "makespan":
            times = model.GetDimensionOrDie(_TIME)
            ends = [solution.Min(times.CumulVar(model.End(i))) for i in self._robots if self._used(solution, i)]
            return float(max(ends, default=0) / instance.seconds.scale)
        usage = model.GetDimensionOrDie(_USAGE)
        ends = [solution.Value(usage.CumulVar(model.End(i))) for i in self._robots]
        if instance.objective == "average":
            done = [index for index in map(self._index, range(len(instance.tasks))) if self._done(solution, index)]
            arrivals = sum(solution.Value(usage.CumulVar(index)) for index in done)
            return float(arrivals / max(1, len(done)) / instance.usage.scale)
        total = sum(ends) if instance.objective.startswith("total") else 0
        greatest = max(ends) if instance.objective.endswith("max") else 0
        return float((total + greatest) / instance.usage.scale)

    def _arcs(self, solution: Any) -> int:
        """The sum of the costs of all arcs."""
        model, total = self._model, 0
        for i in self._robots:
            index = model.Start(i)
            while not model.IsEnd(index):
                onward = solution.Value(model.NextVar(index))
                total += model.GetArcCostForVehicle(index, onward, i)
                index = onward
        return int(total)

    def _used(self, solution: Any, robot: int) -> bool:
        return not self._model.IsEnd(solution.Value(self._model.NextVar(self._model.Start(robot))))

    def _done(self, solution: Any, index: int) -> bool:
        return bool(solution.Value(self._model.NextVar(index)) != index)
