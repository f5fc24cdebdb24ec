"""Routes and begins as a constraint program for OR-Tools CP-SAT, small enough for hundreds of tasks.

An arc from task to task stands for all robots, and each task for the robot that does it; the program of
`muster.allocation.exact` has arcs of each robot. An arc leads only to near tasks, or as the plan to begin with does.
Optional intervals on each robot are there for neighbourhoods of schedules.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cached_property
from graphlib import TopologicalSorter
from itertools import pairwise
from typing import Any

import numpy as np
from ortools.sat.python import cp_model

from muster.allocation.exact.program import run_until
from muster.model.problem import Bools
from muster_studies.peers.instance import Instance, Routes

NEAR = 30
"""Tasks that an arc leads to."""
_ANYWHERE = 0
"""The node of the circuit that routes begin and end at; tasks follow."""


class ScheduleProgram:
    """The least end of a mission whose tasks are all done, from a plan that does them all.

    Parameters
    ----------
    plan
        to begin with: for each robot the tasks of the instance.
    latest
        end of the mission, in the scale of `seconds`, of which the plan's is one.
    """

    def __init__(self, instance: Instance, plan: Routes, latest: int) -> None:
        self._instance = instance
        self._tasks = range(len(instance.tasks))
        self._robots = range(instance.robot_count)
        self._kinds = instance.seconds.kinds
        self._departing = [instance.seconds.departing(kind) for kind in range(max(self._kinds) + 1)]
        self._model = cp_model.CpModel()
        self._end = self._model.new_int_var(0, latest, "")
        self._begins = [self._model.new_int_var(0, latest, "") for _ in self._tasks]
        self._does = {(i, j): self._model.new_bool_var("") for j in self._tasks for i in instance.allowed_robots(j)}
        self._of_kind = self._kinds_of_tasks()
        self._firsts = {key: self._model.new_bool_var("") for key in self._does}
        self._lasts = [self._model.new_bool_var("") for _ in self._tasks]
        self._legs = {leg: self._model.new_bool_var("") for leg in self._usable_legs(plan)}
        self._choose_robots()
        self._follow_legs()
        self._begin_and_end()
        self._keep_order()
        self._model.minimize(self._end)
        self._begin_with(plan)

    def improve(self, seed: int, parameters: Mapping[str, Any], interrupted: Callable[[], bool]) -> None:
        """Look for a better plan until interrupted, which is the one to begin with from then on."""
        solver = cp_model.CpSolver()
        solver.parameters.random_seed = seed % 2**31
        solver.parameters.num_workers = 1
        for name, setting in parameters.items():
            setattr(solver.parameters, name, setting)
        status = run_until(solver, self._model, interrupted)
        if status not in (cp_model.OPTIMAL, cp_model.FEASIBLE):
            return
        after = {a: b for (a, b), leg in self._legs.items() if solver.boolean_value(leg)}
        first = {i: j for (i, j), literal in self._firsts.items() if solver.boolean_value(literal)}
        self._begin_with([_from(first.get(i), after) for i in self._robots])

    def _kinds_of_tasks(self) -> dict[tuple[int, int], cp_model.IntVar]:
        """By kind of robot and task whether one of that kind does it."""
        found: dict[tuple[int, int], cp_model.IntVar] = {}
        for (i, j), does in self._does.items():
            key = self._kinds[i], j
            if key not in found:
                found[key] = self._model.new_bool_var("")
            self._model.add_implication(does, found[key])
        for j in self._tasks:
            self._model.add_exactly_one(kind for (_, task), kind in found.items() if task == j)
        return found

    def _choose_robots(self) -> None:
        busy: list[list[cp_model.IntervalVar]] = [[] for _ in self._robots]
        for (i, j), does in self._does.items():
            work = int(self._instance.seconds.work[self._kinds[i]][j])
            busy[i].append(self._model.new_optional_fixed_size_interval_var(self._begins[j], work, does, ""))
        for j in self._tasks:
            self._model.add_exactly_one(self._does[i, j] for i in self._instance.allowed_robots(j))
        for intervals in busy:
            self._model.add_no_overlap(intervals)

    @cached_property
    def _comes_after(self) -> Bools:
        """(n, n) whether the second task waits for the first, others in between too."""
        prerequisites = self._instance.prerequisites
        after = np.zeros((len(self._tasks), len(self._tasks)), dtype=bool)
        for j in TopologicalSorter(dict(enumerate(prerequisites))).static_order():
            for before in prerequisites[j]:
                after[:, j] |= after[:, before]
                after[before, j] = True
        return after

    def _usable_legs(self, plan: Routes) -> Iterable[tuple[int, int]]:
        """From each task to near ones that it does not wait for; and those of the plan."""
        allowed, legs = self._instance.allowed, self._instance.seconds.legs.min(axis=0)
        usable = {leg for route in plan for leg in pairwise(route)}
        for a in self._tasks:
            common = (allowed[:, [a]] & allowed).any(axis=0) & ~self._comes_after[:, a]
            common[a] = False
            others = np.flatnonzero(common)
            usable |= {(a, int(b)) for b in others[np.argsort(legs[a, others], kind="stable")[:NEAR]]}
        return sorted(usable)

    def _follow_legs(self) -> None:
        for (a, b), leg in self._legs.items():
            for i in self._robots:
                self._keep_robot(leg, self._does.get((i, a)), self._does.get((i, b)))
            kinds = [kind for kind in range(len(self._departing)) if (kind, a) in self._of_kind]
            least = min(int(self._departing[kind][a, b]) for kind in kinds)
            self._model.add(self._begins[b] >= self._begins[a] + least).only_enforce_if(leg)
            for kind in kinds:
                takes = int(self._departing[kind][a, b])
                if takes > least:
                    of_kind = self._of_kind[kind, a]
                    self._model.add(self._begins[b] >= self._begins[a] + takes).only_enforce_if(leg, of_kind)

    def _keep_robot(self, leg: cp_model.IntVar, before: cp_model.IntVar | None, after: cp_model.IntVar | None) -> None:
        """A robot does the task that a leg leads to if, and only if, it does the one that the leg begins at."""
        if before is not None:
            self._model.add_bool_or(~leg, ~before, *(() if after is None else (after,)))
        if after is not None:
            self._model.add_bool_or(~leg, ~after, *(() if before is None else (before,)))

    def _begin_and_end(self) -> None:
        instance = self._instance
        arcs: list[tuple[int, int, cp_model.IntVar]] = [(a + 1, b + 1, leg) for (a, b), leg in self._legs.items()]
        arcs += [(j + 1, _ANYWHERE, last) for j, last in enumerate(self._lasts)]
        for (i, j), first in self._firsts.items():
            kind, does = self._kinds[i], self._does[i, j]
            arcs.append((_ANYWHERE, j + 1, first))
            self._model.add_implication(first, does)
            begin = instance.available_from[i] + int(instance.seconds.legs[kind][instance.starts[i], j])
            self._model.add(self._begins[j] >= begin).only_enforce_if(first)
            back = int(self._departing[kind][j, instance.ends_or_anywhere[i]])
            self._model.add(self._end >= self._begins[j] + back).only_enforce_if(self._lasts[j], does)
        self._model.add_multiple_circuit(arcs)
        for i in self._robots:
            self._model.add_at_most_one(first for (robot, _), first in self._firsts.items() if robot == i)

    def _keep_order(self) -> None:
        """Nothing begins before its prerequisites end; the mission ends after all."""
        for (kind, j), of_kind in self._of_kind.items():
            end = self._begins[j] + int(self._instance.seconds.work[kind][j])
            self._model.add(self._end >= end).only_enforce_if(of_kind)
            for task in self._tasks:
                if j in self._instance.prerequisites[task]:
                    self._model.add(self._begins[task] >= end).only_enforce_if(of_kind)

    def _begin_with(self, plan: Routes) -> None:
        """Tell the solver the plan, with the begins that follow from it."""
        self.plan = plan
        self._model.clear_hints()  # type: ignore[no-untyped-call]
        legs = {leg for route in plan for leg in pairwise(route)}
        for leg, literal in self._legs.items():
            self._model.add_hint(literal, leg in legs)
        for (i, j), does in self._does.items():
            self._model.add_hint(does, j in plan[i])
            self._model.add_hint(self._firsts[i, j], list(plan[i][:1]) == [j])
        solver = cp_model.CpSolver()
        solver.parameters.num_workers = 1
        solver.parameters.fix_variables_to_their_hinted_value = True
        if solver.solve(self._model) != cp_model.OPTIMAL:
            return
        values = solver.response_proto.solution
        self._model.clear_hints()  # type: ignore[no-untyped-call]
        self._model.proto.solution_hint.vars.extend(range(len(values)))
        self._model.proto.solution_hint.values.extend(values)


def _from(first: int | None, after: Mapping[int, int]) -> list[int]:
    """A route that begins with a task."""
    route, task = [], first
    while task is not None:
        route.append(task)
        task = after.get(task)
    return route
