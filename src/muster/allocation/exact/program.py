"""A problem as a constraint program over whole numbers, for OR-Tools CP-SAT.

Its constraints stand in files of their own: `circuits` the routes, with ranks that rule out deadlocks, `members` who
does a task together, `times` when. Costs are rounded down (`Scale`): every admissible plan is one of the program, with
a value not above its own, so that what the program proves is true of the plans.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ThreadPoolExecutor, wait
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

from ortools.sat.python import cp_model

from muster.allocation.exact.circuits import Circuits
from muster.allocation.exact.costs import Costs, Routes, like_robots
from muster.allocation.exact.goods import Cut, add_goods, most_detours, needs_stations
from muster.allocation.exact.members import add_members
from muster.allocation.exact.times import Times
from muster.model.problem import Bools, Problem

# After its presolve, whatever parts of it are left out, OR-Tools 9.15.6755 rules out the best plans of some programs,
# and makes wrong proofs. A plan to begin with is near the best; what takes time is the proof.
PROVING: Mapping[str, Any] = {"cp_model_presolve": False, "use_lns": False}
_LEFT_OUT = "core"  # a search of the solver that raises the bound unit by unit

_LOOK_S = 0.02  # between two looks whether the run is to end


@dataclass(frozen=True)
class Solved:
    """The routes of the best plan that was found, and the bound of its objective; inf if there is none."""

    routes: list[list[int]] | None
    bound: float


def run_until(solver: cp_model.CpSolver, model: cp_model.CpModel, interrupted: Callable[[], bool]) -> Any:
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
        self._weights = weights
        sums, detours = max(len(problem.tasks), len(problem.robots)), most_detours(problem)
        self._costs = Costs.of(problem, sums=sums, begin=detours)
        self._rules = problem.model
        self._circuits = Circuits(problem, usable, self._costs, with_detours=needs_stations(problem))
        self.model = self._circuits.model
        self._done = self._circuits.done
        add_members(self._circuits)
        add_goods(self._circuits)
        self._times: Times | None = None
        if problem.has_timed_rules or problem.objective == "makespan":
            self._times = Times(self._circuits, sum(weights) if problem.objective == "lateness" else 1)
        self.scale = self._costs.scale
        self.per = self._value_per = 1.0
        self.groups = like_robots(problem, usable)
        for group in self.groups:
            for i, k in pairwise(group):
                self.model.add(self._circuits.usage[i] >= self._circuits.usage[k])
        self._maximises = False
        self._least_of: Callable[[Sequence[int]], Any] | None = None  # what of the objective some tasks come to
        self._of_values: list[Cut] = []

    def _value(self, objective: str) -> Any:
        """The objective in units of the scale, times `per`; for `average` the sum over tasks."""
        if self._times is not None and objective in ("makespan", "lateness"):
            self.scale = self._times.scale
            if objective == "makespan":
                makespan = self._times.makespan()
                self._least_of = lambda tasks: makespan
                return makespan
            self.per = self._value_per = self._weights[0] / self._problem.tasks[0].priority
            late = self._times.lateness(self._weights)
            self._least_of = lambda tasks: sum(late.get(j, 0) for j in tasks)
            return sum(late.values())
        self.scale, usage = self._costs.scale, self._circuits.usage
        if objective == "average":
            arrivals = self._arrivals()
            self._least_of = lambda tasks: sum(arrivals[j] for j in tasks)
            return sum(arrivals)
        greatest = self.model.new_int_var(0, self._costs.longest, "")
        if objective not in ("total", "lateness"):
            self.model.add_max_equality(greatest, usage)
            self.model.add(len(usage) * greatest >= sum(usage))
        total = sum(usage)
        return {"total": total, "max": greatest, "total+max": total + greatest}[objective]

    def _arrivals(self) -> list[Any]:
        """The usage at which each task is arrived at, the most of its team; 0 for a task that is not done."""
        circuits, model, longest = self._circuits, self.model, self._costs.longest
        arrival = [model.new_int_var(0, longest, "") for _ in circuits.tasks]
        own = {
            (i, j): model.new_int_var(0, longest, "") if self._rules.is_for_team(j) else arrival[j]
            for i, j in circuits.does
        }
        for (i, a, b), leg in circuits.onward():
            before = 0 if a == circuits.start else own[i, a] + circuits.worked(i, a)
            model.add(own[i, b] >= before + circuits.travel(self._costs, (i, a, b))).only_enforce_if(leg)
        for (i, j), does in circuits.does.items():
            if self._rules.is_for_team(j):
                model.add(arrival[j] >= own[i, j]).only_enforce_if(does)
        return arrival

    def maximise_weight(self) -> None:
        self._maximises = True
        self.model.maximize(sum(w * done for w, done in zip(self._weights, self._done, strict=True)))

    def minimise_value(self, weight: int, count: int | None, least: float | None, most: float | None) -> None:
        """Minimise the objective of plans of this weight, and number of tasks; it is known to be in a range."""
        self._fix_weight(weight)
        value = self._value(self._problem.objective)
        if count is not None:
            self.model.add(sum(self._done) == count)
            self.per = count if self._problem.objective == "average" else self.per
        if least is not None:
            self.model.add(value >= math.floor(self.scale.at_least(max(0.0, least - self.slack)) * self.per))
        if most is not None:
            self.model.add(value <= self.scale.at_most(most * self.per))
        self.model.minimize(value)
        for cut in self._of_values:
            self._cut_value(cut)

    def minimise_total(self, weight: int, lateness: float) -> None:
        """Minimise the total cost of plans of this weight that are no later."""
        self._fix_weight(weight)
        late = self._value("lateness")
        self.model.add(late <= self.scale.at_most(lateness * self.per))
        self.scale, self.per = self._costs.scale, 1.0
        self.model.minimize(sum(self._circuits.usage))

    def _fix_weight(self, weight: int) -> None:
        self.model.add(sum(w * done for w, done in zip(self._weights, self._done, strict=True)) == weight)

    @property
    def slack(self) -> float:
        """How far the least objective of the program is below that of the plans, by rounding, at most."""
        priorities = sum(task.priority for task in self._problem.tasks)
        return self.scale.slack * (priorities if self._problem.objective == "lateness" else 1.0)

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
        solver.parameters.ignore_subsolvers.append(_LEFT_OUT)
        for name, setting in parameters.items():
            setattr(solver.parameters, name, setting)
        status = run_until(solver, self.model, interrupted)
        if status == cp_model.INFEASIBLE:
            return Solved(None, math.inf)
        if status == cp_model.UNKNOWN:
            return Solved(None, self.unproven)
        assert status in (cp_model.OPTIMAL, cp_model.FEASIBLE), solver.status_name(status)
        bound = solver.best_objective_bound
        return Solved(self.routes(solver), min(bound, self.unproven) if self._maximises else max(bound, 0.0))

    def forbid(self, routes: Routes, *, alone: bool = False) -> None:
        """Leave out a plan; `alone`: all plans with these routes, whatever the robots do that have none."""
        circuits = self._circuits
        others = [] if alone else [circuits.used[i] for i, route in enumerate(routes) if not route]
        self.model.add_bool_or([*others, *(circuits.legs[key].negated() for key in circuits.legs_of(routes))])

    def cut(self, cut: Cut) -> None:
        """Let all routes that begin alike, of this robot and those like it, use what calls at stations add."""
        circuits = self._circuits
        for i in next(group for group in self.groups if cut.robot in group):
            legs = circuits.legs_of([cut.tasks if k == i else () for k in circuits.robots]) if cut.whole else set()
            driven = [circuits.legs[key] for key in legs or circuits.legs_from_start(i, cut.tasks)]
            if math.isinf(cut.adds):
                self.model.add_bool_or([leg.negated() for leg in driven])
            else:
                least = min(self._costs.scale.below(cut.adds), self._costs.longest)
                self.model.add(circuits.detours[i] >= least).only_enforce_if(*driven)
        self._of_values.append(cut)
        if self._least_of is not None:
            self._cut_value(cut)

    def _cut_value(self, cut: Cut) -> None:
        """Let the part of the objective that is of a route's tasks be what the route comes to by itself."""
        if not cut.value or self._least_of is None or math.isinf(cut.adds):
            return
        circuits = self._circuits
        for i in next(group for group in self.groups if cut.robot in group):
            legs = circuits.legs_of([cut.tasks if k == i else () for k in circuits.robots])
            least = math.floor(self.scale.below(cut.value) * self._value_per)
            if self._problem.objective == "lateness":  # a sum of whole multiples does not come to every number
                least = max(0, least - sum(self._weights))
            self.model.add(self._least_of(cut.tasks) >= least).only_enforce_if(*(circuits.legs[key] for key in legs))

    def hint(self, routes: Routes) -> None:
        """Tell the solver a plan to begin with; like robots change places where the program has them in order."""
        placed = [list(route) for route in routes]
        for group in self.groups:
            inside = sorted((placed[i] for i in group), key=lambda route: -self._costs.usage(group[0], route))
            for i, route in zip(group, inside, strict=True):
                placed[i] = route
        legs = self._circuits.legs_of(placed)
        self.model.clear_hints()  # type: ignore[no-untyped-call]
        for key, leg in self._circuits.legs.items():
            self.model.add_hint(leg, key in legs)
        for (i, j), does in self._circuits.does.items():
            self.model.add_hint(does, j in placed[i])
        for i, used in enumerate(self._circuits.used):
            self.model.add_hint(used, bool(placed[i]))

    def complete_hint(self) -> float | None:
        """Add to the hint what follows from its routes, such as times, which CP-SAT does not do in a large program.

        Returns what the objective of the hint is, in units; None if the program has no such plan.
        """
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.fix_variables_to_their_hinted_value = True
        if run_until(solver, self.model, lambda: False) != cp_model.OPTIMAL:
            return None
        values = solver.response_proto.solution
        self.model.clear_hints()  # type: ignore[no-untyped-call]
        self.model.proto.solution_hint.vars.extend(range(len(values)))
        self.model.proto.solution_hint.values.extend(values)
        return solver.objective_value

    def routes(self, solver: cp_model.CpSolver) -> list[list[int]]:
        """The routes of the solver's plan."""
        circuits = self._circuits
        after = {(i, a): b for (i, a, b), leg in circuits.legs.items() if solver.boolean_value(leg)}
        return [circuits.route_of(i, after) for i in circuits.robots]
