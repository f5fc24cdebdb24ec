"""A problem as a constraint program over whole numbers, for OR-Tools CP-SAT.

Each robot's route is a circuit through its start and its tasks (`AddCircuit`; tasks of others are loops). Tasks with
prerequisites have a rank that grows along every leg and from every prerequisite, so that no plan deadlocks; with
`makespan` they also have a time. Costs are rounded down (`Scale`): every admissible plan is one of the program, with a
value not above its own, so that what the program proves is true of the plans.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from ortools.sat.python import cp_model

from muster.allocation.exact.costs import Costs, Routes, ancestors, in_time, like_robots
from muster.allocation.problem import Bools, Problem

# Presolve that drops dominated plans drops the best ones too in OR-Tools 9.15.6755, and makes wrong proofs. A plan to
# begin with is near the best; what takes time is the proof.
PROVING: Mapping[str, Any] = {"keep_all_feasible_solutions_in_presolve": True, "use_lns": False}

_LOOK_S = 0.02  # between two looks whether the run is to end


@dataclass(frozen=True)
class Solved:
    """The routes of the best plan that was found, and the bound of its objective; inf if there is none."""

    routes: list[list[int]] | None
    bound: float


def _run(solver: cp_model.CpSolver, model: cp_model.CpModel, interrupted: Callable[[], bool]) -> Any:
    """Solve in another thread, while this one receives Ctrl-C: CP-SAT's own handler would replace Python's."""
    solver.parameters.catch_sigint_signal = False
    with ThreadPoolExecutor(1) as beside:
        run = beside.submit(solver.solve, model)
        try:
            while not run.done() and not interrupted():
                wait([run], _LOOK_S)
        finally:
            while not run.done():
                solver.stop_search()
                wait([run], _LOOK_S)
        return run.result()


class Program:
    """The constraint program of a problem of which only some pairs (m, n) of robot and task are usable."""

    def __init__(self, problem: Problem, usable: Bools, weights: Sequence[int]) -> None:
        self._problem = problem
        self._usable = usable
        self._weights = weights
        self._robots = range(len(problem.robots))
        self._tasks = range(len(problem.tasks))
        self._before = ancestors(problem)
        self._costs = Costs.of(problem, sums=max(len(self._tasks), len(self._robots)))
        self.model = cp_model.CpModel()
        self._legs: dict[tuple[int, int, int], Any] = {}
        self._does = {(i, j): self.model.new_bool_var("") for i in self._robots for j in self._tasks if usable[i, j]}
        self._used = [self.model.new_bool_var("") for _ in self._robots]
        self._done = [self.model.new_bool_var("") for _ in self._tasks]
        self._usage = [self._circuit(i) for i in self._robots]
        for i in self._robots:
            for a, b in pairwise([len(self._tasks), *problem.beginning(i)]):
                self.model.add(self._legs[i, a, b] == 1)
        self._order = self._ranks() if any(problem.prerequisites) else []
        for j in self._tasks:
            self.model.add(sum(self._does[i, j] for i in self._robots if usable[i, j]) == self._done[j])
            for k in problem.prerequisites[j]:
                self.model.add_implication(self._done[j], self._done[k])
        self.scale = self._costs.scale
        self.groups = like_robots(self._problem, self._usable)
        for group in self.groups:
            for i, k in pairwise(group):
                self.model.add(self._usage[i] >= self._usage[k])
        self._maximises = False

    def _circuit(self, i: int) -> Any:
        """Robot i's route; returns its usage. Node 0 is its start, and task j is node j + 1."""
        costs, model, start = self._costs, self.model, len(self._tasks)
        mine = [j for j in self._tasks if self._usable[i, j]]
        arcs = [(0, 0, self._used[i].negated()), *((j + 1, j + 1, self._does[i, j].negated()) for j in mine)]
        terms = [int(costs.work[i, j]) * self._does[i, j] for j in mine]
        ways = [(start, j, int(costs.first[i, j])) for j in mine]
        ways += [(j, start, int(costs.last[i, j])) for j in mine]
        ways += [(a, b, int(costs.between[i, a, b])) for a in mine for b in mine if a != b and b not in self._before[a]]
        for a, b, cost in ways:
            if cost >= 0:
                leg = self._legs[i, a, b] = model.new_bool_var("")
                arcs.append(((a + 1) % (start + 1), (b + 1) % (start + 1), leg))
                terms.append(cost * leg)
        model.add_circuit(arcs)
        for j in mine:
            model.add_implication(self._does[i, j], self._used[i])
        capacity = self._problem.capacity[i]
        most = min(costs.longest, costs.scale.at_most(capacity)) if np.isfinite(capacity) else costs.longest
        usage = model.new_int_var(0, most, "")
        model.add(usage == sum(terms))
        return usage

    def _ranks(self) -> list[Any]:
        last = len(self._tasks) - 1
        rank = [self.model.new_int_var(len(self._before[j]), last, "") for j in self._tasks]
        for (_, a, b), leg in self._legs.items():
            if a <= last and b <= last:
                self.model.add(rank[b] >= rank[a] + 1).only_enforce_if(leg)
        for j in self._tasks:
            for k in self._problem.prerequisites[j]:
                self.model.add(rank[j] >= rank[k] + 1).only_enforce_if(self._done[j])
        return rank

    def _value(self) -> Any:
        """The objective in units; for `average` the sum over tasks."""
        objective, model = self._problem.objective, self.model
        if objective == "average":
            return sum(self._arrivals())
        if objective == "makespan":
            return self._makespan()
        greatest = model.new_int_var(0, self._costs.longest, "")
        if objective != "total":
            model.add_max_equality(greatest, self._usage)
            model.add(len(self._robots) * greatest >= sum(self._usage))
        total = sum(self._usage)
        return {"total": total, "max": greatest, "total+max": total + greatest}[objective]

    def _arrivals(self) -> list[Any]:
        """The usage at which each task is arrived at; 0 for a task that is not done."""
        costs = self._costs
        arrival = [self.model.new_int_var(0, costs.longest, "") for _ in self._tasks]
        for (i, a, b), leg in self._legs.items():
            if b == len(self._tasks):
                continue
            if a == len(self._tasks):
                before: Any = int(costs.first[i, b])
            else:
                before = arrival[a] + int(costs.work[i, a]) + int(costs.between[i, a, b])
            self.model.add(arrival[b] >= before).only_enforce_if(leg)
        return arrival

    def _makespan(self) -> Any:
        """The time of the last end, with the times at which work on each task begins and ends."""
        model, n = self.model, len(self._tasks)
        available = np.array([robot.available_from_s for robot in self._problem.robots])
        costs = Costs.of(in_time(self._problem), begin=float(available.max()))
        self.scale = costs.scale
        ready = costs.scale.down(available)
        makespan = model.new_int_var(0, costs.longest, "")
        begins = [model.new_int_var(0, costs.longest, "") for _ in self._tasks]
        ends = [model.new_int_var(0, costs.longest, "") for _ in self._tasks]
        busy: list[list[Any]] = [[int(ready[i]) * self._used[i]] for i in self._robots]
        for (i, a, b), leg in self._legs.items():
            if b == n:
                continue
            cost = int(costs.first[i, b]) if a == n else int(costs.between[i, a, b])
            before: Any = int(ready[i]) if a == n else ends[a]
            model.add(begins[b] >= before + cost).only_enforce_if(leg)
            busy[i].append(cost * leg)
        for (i, j), does in self._does.items():
            work = int(costs.work[i, j])
            model.add(ends[j] >= begins[j] + work).only_enforce_if(does)
            busy[i].append(work * does)
        for j in self._tasks:
            model.add(makespan >= ends[j])
            for k in self._problem.prerequisites[j]:
                model.add(begins[j] >= ends[k]).only_enforce_if(self._done[j])
        for terms in busy:
            model.add(makespan >= sum(terms))
        return makespan

    def maximise_weight(self) -> None:
        self._maximises = True
        self.model.maximize(sum(w * done for w, done in zip(self._weights, self._done, strict=True)))

    def minimise_value(self, weight: int, count: int | None, least: float | None, most: float | None) -> None:
        """Minimise the objective of plans of this weight, and number of tasks; it is known to be in a range."""
        self.model.add(sum(w * done for w, done in zip(self._weights, self._done, strict=True)) == weight)
        value, times = self._value(), 1
        if count is not None:
            self.model.add(sum(self._done) == count)
            times = count if self._problem.objective == "average" else 1
        if least is not None:
            self.model.add(value >= self.scale.at_least(least) * times)
        if most is not None:
            self.model.add(value <= self.scale.at_most(most * times))
        self.model.minimize(value)

    @property
    def unproven(self) -> float:
        """The bound of an objective of which nothing is known."""
        return float(sum(self._weights)) if self._maximises else 0.0

    def solve(
        self,
        time_limit: float,
        seed: int,
        workers: int,
        parameters: Mapping[str, Any] = PROVING,
        interrupted: Callable[[], bool] = lambda: False,
    ) -> Solved:
        """Run CP-SAT for so many seconds or until it is interrupted, with more of its parameters by name."""
        solver = cp_model.CpSolver()
        solver.parameters.max_time_in_seconds = time_limit
        solver.parameters.random_seed = seed % 2**31
        solver.parameters.num_workers = workers
        for name, setting in parameters.items():
            setattr(solver.parameters, name, setting)
        status = _run(solver, self.model, interrupted)
        if status == cp_model.INFEASIBLE:
            return Solved(None, math.inf)
        if status == cp_model.UNKNOWN:
            return Solved(None, self.unproven)
        assert status in (cp_model.OPTIMAL, cp_model.FEASIBLE), solver.status_name(status)
        bound = solver.best_objective_bound
        return Solved(self.routes(solver), min(bound, self.unproven) if self._maximises else max(bound, 0.0))

    def forbid(self, i: int, route: Sequence[int]) -> None:
        """Leave out all plans in which robot i has just this route, which is not admissible in real numbers."""
        start = len(self._tasks)
        self.model.add_bool_or([self._legs[i, a, b].negated() for a, b in pairwise([start, *route, start])])

    def hint(self, routes: Routes) -> None:
        """Tell the solver a plan to begin with; like robots change places where the program has them in order."""
        placed = [list(route) for route in routes]
        for group in self.groups:
            inside = sorted((placed[i] for i in group), key=lambda route: -self._costs.usage(group[0], route))
            for i, route in zip(group, inside, strict=True):
                placed[i] = route
        start = len(self._tasks)
        legs = {(i, a, b) for i, route in enumerate(placed) if route for a, b in pairwise([start, *route, start])}
        self.model.clear_hints()  # type: ignore[no-untyped-call]
        for key, leg in self._legs.items():
            self.model.add_hint(leg, key in legs)
        for (i, j), does in self._does.items():
            self.model.add_hint(does, j in placed[i])
        for i, used in enumerate(self._used):
            self.model.add_hint(used, bool(placed[i]))

    def complete_hint(self) -> float | None:
        """Add to the hint what follows from its routes, such as times, which CP-SAT does not do in a large program.

        Returns what the objective of the hint is, in units; None if the program has no such plan.
        """
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.fix_variables_to_their_hinted_value = True
        if _run(solver, self.model, lambda: False) != cp_model.OPTIMAL:
            return None
        values = solver.response_proto.solution
        self.model.clear_hints()  # type: ignore[no-untyped-call]
        self.model.proto.solution_hint.vars.extend(range(len(values)))
        self.model.proto.solution_hint.values.extend(values)
        return solver.objective_value

    def routes(self, solver: cp_model.CpSolver) -> list[list[int]]:
        """The routes of the solver's plan."""
        start = len(self._tasks)
        after = {(i, a): b for (i, a, b), leg in self._legs.items() if solver.boolean_value(leg)}
        routes = []
        for i in self._robots:
            route, at = [], after.get((i, start), start)
            while at != start:
                route.append(at)
                at = after[i, at]
            routes.append(route)
        return routes
