"""Routes as circuits of a constraint program: which legs are driven, by whom each task is done, and what it uses.

Each robot's route is a circuit through its start and its tasks (`AddCircuit`; tasks of others are loops). The start is
place n of n tasks, as a place to come from and to go to.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from ortools.sat.python import cp_model

from muster.allocation.exact.costs import Costs, ancestors
from muster.model.problem import Bools, Problem

Leg = tuple[int, int, int]
"""Of a robot, from one place to another."""


class Circuits:
    """The routes of a problem of which only some pairs (m, n) of robot and task are usable, in a model."""

    def __init__(self, problem: Problem, usable: Bools, costs: Costs, *, with_detours: bool = False) -> None:
        self._with_detours = with_detours
        self.problem, self.rules, self.costs = problem, problem.model, costs
        self.model = cp_model.CpModel()
        self.robots, self.tasks = range(len(problem.robots)), range(len(problem.tasks))
        self.start = len(problem.tasks)
        self._usable = usable
        self._before = ancestors(problem)
        self.legs: dict[Leg, Any] = {}
        self.does = {(i, j): self.model.new_bool_var("") for i in self.robots for j in self.tasks if usable[i, j]}
        self.used = [self.model.new_bool_var("") for _ in self.robots]
        self.done = [self.model.new_bool_var("") for _ in self.tasks]
        self._worked = {pair: self._work(*pair) for pair in self.does}
        self.detours: dict[int, Any] = {}  # by robot, where calls at stations may add to its usage
        self.usage = [self._circuit(i) for i in self.robots]
        self._keep_beginnings()
        self._keep_prerequisites()
        self._rank_units()

    def members(self, j: int) -> list[int]:
        """The robots that may do a task."""
        return [i for i in self.robots if self._usable[i, j]]

    def onward(self) -> Iterator[tuple[Leg, Any]]:
        """The legs to tasks."""
        return ((key, leg) for key, leg in self.legs.items() if key[2] != self.start)

    def homeward(self) -> Iterator[tuple[Leg, Any]]:
        """The legs with which routes end."""
        return ((key, leg) for key, leg in self.legs.items() if key[2] == self.start)

    def travel(self, costs: Costs, leg: Leg) -> int:
        """What a leg costs; -1: there is no way."""
        i, a, b = leg
        if a == self.start:
            return int(costs.first[i, b])
        return int(costs.last[i, a]) if b == self.start else int(costs.between[i, a, b])

    def worked(self, i: int, j: int) -> Any:
        """The usage of robot i for the work of task j if it does it."""
        return self._worked[i, j]

    def _work(self, i: int, j: int) -> Any:
        """With usage in time all members of a team pay for the slowest of them."""
        own = int(self.costs.work[i, j])
        if not (self.problem.in_time and self.rules.is_for_team(j)):
            return own
        others = [k for k in self.members(j) if self.costs.work[k, j] > own]
        usage = self.model.new_int_var(own, max([own, *(int(self.costs.work[k, j]) for k in others)]), "")
        for k in others:
            self.model.add(usage >= int(self.costs.work[k, j])).only_enforce_if(self.does[i, j], self.does[k, j])
        return usage

    def _circuit(self, i: int) -> Any:
        """Robot i's route; returns its usage. In the circuit node 0 is its start, and task j is node j + 1."""
        model, start = self.model, self.start
        mine = [j for j in self.tasks if self._usable[i, j]]
        arcs = [(0, 0, self.used[i].negated()), *((j + 1, j + 1, self.does[i, j].negated()) for j in mine)]
        terms = [self._paid(i, j) for j in mine]
        ways = [(i, start, j) for j in mine] + [(i, j, start) for j in mine]
        ways += [(i, a, b) for a in mine for b in mine if a != b and b not in self._before[a]]
        for key in ways:
            cost = self.travel(self.costs, key)
            if cost >= 0:
                leg = self.legs[key] = model.new_bool_var("")
                arcs.append(((key[1] + 1) % (start + 1), (key[2] + 1) % (start + 1), leg))
                terms.append(cost * leg)
        model.add_circuit(arcs)
        for j in mine:
            model.add_implication(self.does[i, j], self.used[i])
        usage = model.new_int_var(0, self._most(i), "")
        if self._with_detours:
            self.detours[i] = model.new_int_var(0, self.costs.longest, "")
            terms.append(self.detours[i])
        model.add(usage == sum(terms))
        return usage

    def _paid(self, i: int, j: int) -> Any:
        """The usage for the work of a task in a route, 0 where the robot does not do it."""
        work = self._worked[i, j]
        if isinstance(work, int):
            return work * self.does[i, j]
        paid = self.model.new_int_var(0, self.costs.longest, "")
        self.model.add(paid >= work).only_enforce_if(self.does[i, j])
        return paid

    def _most(self, i: int) -> int:
        capacity = self.problem.capacity[i]
        longest = self.costs.longest
        return min(longest, self.costs.scale.at_most(capacity)) if np.isfinite(capacity) else longest

    def _keep_beginnings(self) -> None:
        for i in self.robots:
            for a, b in pairwise([self.start, *self.problem.beginning(i)]):
                self.model.add(self.legs[i, a, b] == 1)

    def _keep_prerequisites(self) -> None:
        for j in self.tasks:
            for k in self.problem.model.awaited[j]:
                self.model.add_implication(self.done[j], self.done[k])

    def _rank_units(self) -> None:
        """Rule out deadlocks: a rank of each unit that grows along every leg and from every prerequisite.

        Where no deadlock is possible, ranks still help: they rule out at once that tasks form a circuit without the
        start. The times along such a circuit would grow a unit at a time, up to their limit.
        """
        problem, unit = self.problem, self.rules.unit
        last = len(self.tasks) - 1
        rank = [self.model.new_int_var(0, last, "") for _ in self.tasks]
        for (_, a, b), leg in self.onward():
            if a != self.start:
                self.model.add(rank[unit[b]] >= rank[unit[a]] + 1).only_enforce_if(leg)
        for j in self.tasks:
            for k in problem.model.awaited[j]:
                self.model.add(rank[unit[j]] >= rank[unit[k]] + 1).only_enforce_if(self.done[j])

    def route_of(self, i: int, after: dict[tuple[int, int], int]) -> list[int]:
        """The tasks of robot i in order, by which place follows which."""
        route, at = [], after.get((i, self.start), self.start)
        while at != self.start:
            route.append(at)
            at = after[i, at]
        return route

    def legs_from_start(self, i: int, tasks: Sequence[int]) -> set[Leg]:
        """The legs with which a route begins."""
        return {(i, a, b) for a, b in pairwise([self.start, *tasks])}

    def legs_of(self, routes: Sequence[Sequence[int]]) -> set[Leg]:
        """The legs that routes are made of."""
        start = self.start
        return {(i, a, b) for i, route in enumerate(routes) if route for a, b in pairwise([start, *route, start])}
