"""When work begins and ends, as constraints of a program over whole numbers.

Lower bounds of times are rounded down, and upper ones up: the times of an admissible plan, rounded down, keep all of
them, so that every plan of the mission is one of the program.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import chain
from typing import Any

import numpy as np
from ortools.sat.python import cp_model

from muster.allocation.bounds.easier_problems import in_time
from muster.allocation.exact.circuits import Circuits, Leg
from muster.allocation.exact.costs import Costs
from muster.allocation.exact.goods import most_seconds


class Times:
    """When each unit begins and each task ends, in whole units of the scale."""

    def __init__(self, circuits: Circuits, sums: int) -> None:
        """`sums`: of how many times the objective is, at most."""
        self._circuits, self._problem, self._model = circuits, circuits.problem, circuits.model
        problem, rules = self._problem, circuits.rules
        self._rules = rules
        self.available = np.array([robot.available_from_s for robot in problem.robots])
        self.costs = Costs.of(in_time(problem), sums=sums, begin=self._latest_base() + most_seconds(problem))
        self.scale, longest = self.costs.scale, self.costs.longest
        self._ready = self.scale.down(self.available)
        begins = [self._model.new_int_var(0, longest, "") for _ in rules.units]
        self.begin = [begins[u] for u in rules.unit]
        self.end = [self._model.new_int_var(0, longest, "") for _ in circuits.tasks]
        bound = [i for i in circuits.robots if rules.spans(i) or math.isfinite(rules.lasts_most[i])]
        self._over = {i: self._model.new_int_var(0, longest, "") for i in bound}
        self._leave = {i: self._model.new_int_var(int(self._ready[i]), longest, "") for i in bound}
        self._follow_routes()
        self._end_routes()
        self._follow_prerequisites()
        self._keep_openings()

    def _latest_base(self) -> float:
        """No time is later than this by more than travel and work of all tasks: the latest that all begins from."""
        rules = self._rules
        opens = (begin for spans in rules.openings for begin, _ in spans)
        gaps = sum(after for j in self._circuits.tasks for _, after, _ in rules.gaps(j))
        rests = (span[0] for i in self._circuits.robots for span in rules.spans(i))
        return float(max(chain(self.available, opens, rests))) + gaps

    def _follow_routes(self) -> None:
        circuits, model = self._circuits, self._model
        for (i, j), does in circuits.does.items():
            model.add(self.end[j] >= self.begin[j] + int(self.costs.work[i, j])).only_enforce_if(does)
            self._keep_to_spans(i, self.begin[j], self.end[j], does)
        for (i, a, b), leg in circuits.onward():
            start = self._leave.get(i, int(self._ready[i]))
            self._drive((i, a, b), start if a == circuits.start else self.end[a], self.begin[b], leg)

    def _drive(self, key: Leg, free: Any, arrives: Any, leg: Any) -> None:
        """A robot that is free at a place comes to another: without a rest on the way."""
        way = self._circuits.travel(self.costs, key)
        if self._rules.spans(key[0]):
            leaves = self._model.new_int_var(0, self.costs.longest, "")
            self._model.add(leaves >= free).only_enforce_if(leg)
            self._keep_to_spans(key[0], leaves, leaves + way, leg)
            free = leaves
        self._model.add(arrives >= free + way).only_enforce_if(leg)

    def _keep_to_spans(self, i: int, begin: Any, end: Any, holds: Any) -> None:
        """What a robot that rests does stands within one of its spans."""
        model, spans = self._model, self._rules.spans(i)
        chosen = [model.new_bool_var("") for _ in spans]
        for (first, last), one in zip(spans, chosen, strict=True):
            model.add(begin >= self._down(first)).only_enforce_if(one)
            model.add(end <= self._at_most(last)).only_enforce_if(one)
        if spans:
            model.add_bool_or([*chosen, holds.negated()])

    def _end_routes(self) -> None:
        """Routes are over in time, and soon enough after they are left."""
        model, rules = self._model, self._rules
        for (i, j, end), leg in self._circuits.homeward():
            if i in self._over:
                self._drive((i, j, end), self.end[j], self._over[i], leg)
            if math.isfinite(rules.over_by[i]):
                model.add(self._back(i, j, end) <= self._at_most(rules.over_by[i])).only_enforce_if(leg)
            if math.isfinite(rules.lasts_most[i]):
                most = self._up(float(rules.lasts_most[i]))
                model.add(self._over[i] - self._leave[i] <= most).only_enforce_if(leg)

    def _back(self, i: int, j: int, end: int) -> Any:
        """When a robot is at its end, to which it goes from a task."""
        return self._over.get(i, self.end[j] + self._circuits.travel(self.costs, (i, j, end)))

    def _follow_prerequisites(self) -> None:
        circuits, model = self._circuits, self._model
        for j in circuits.tasks:
            for k, after, within in self._rules.gaps(j):
                done = circuits.done[j]
                earliest = self.end[k] + self._down(after)
                model.add(self.begin[j] >= earliest).only_enforce_if(done)
                if math.isfinite(within):
                    latest = self.begin[k] + self._longest_work(k) + self._up(within)
                    model.add(self.begin[j] <= latest).only_enforce_if(done)

    def _longest_work(self, j: int) -> Any:
        """How long a task takes its slowest member, rounded up."""
        circuits = self._circuits
        work = [(int(self.costs.work[i, j]) + 1) * circuits.does[i, j] for i in circuits.members(j)]
        if not self._rules.is_for_team(j) or not work:
            return sum(work)
        slowest = self._model.new_int_var(0, self.costs.longest + 1, "")
        self._model.add_max_equality(slowest, work)
        return slowest

    def _keep_openings(self) -> None:
        rules, model = self._rules, self._model
        for j in self._circuits.tasks:
            done = self._circuits.done[j]
            if math.isfinite(rules.ends_by[j]):
                model.add(self.end[j] <= self._at_most(rules.ends_by[j])).only_enforce_if(done)
            if rules.openings[j]:
                spans = [[self._down(begin), self._at_most(end)] for begin, end in rules.openings[j]]
                allowed = cp_model.Domain.from_intervals([span for span in spans if span[0] <= span[1]])
                model.add_linear_expression_in_domain(self.begin[j], allowed).only_enforce_if(done)

    def _down(self, seconds: float) -> int:
        return math.floor(seconds * self.scale.units)

    def _up(self, seconds: float) -> int:
        return math.ceil(seconds * self.scale.units)

    def _at_most(self, seconds: float) -> int:
        """A limit in units, rounded down; where it is above all times, the greatest of these."""
        return min(self.costs.longest, self.scale.at_most(seconds)) if math.isfinite(seconds) else self.costs.longest

    def makespan(self) -> Any:
        """The time of the last end; with the way to the robots' ends where the rules say so."""
        circuits, model = self._circuits, self._model
        makespan = model.new_int_var(0, self.costs.longest, "")
        with_return = self._problem.mission.rules.makespan_includes_return
        busy: list[list[Any]] = [[int(self._ready[i]) * circuits.used[i]] for i in circuits.robots]
        for key, leg in circuits.onward():
            busy[key[0]].append(circuits.travel(self.costs, key) * leg)
        for (i, j), does in circuits.does.items():
            busy[i].append(int(self.costs.work[i, j]) * does)
        for (i, j, end), leg in circuits.homeward() if with_return else ():
            way = circuits.travel(self.costs, (i, j, end))
            busy[i].append(way * leg)
            model.add(makespan >= self._back(i, j, end)).only_enforce_if(leg)
        for ended in self.end:
            model.add(makespan >= ended)
        for terms in busy:
            model.add(makespan >= sum(terms))
        return makespan

    def lateness(self, weights: Sequence[int]) -> dict[int, Any]:
        """For each task with a due time its whole weight times the time that it ends after that, if it is done."""
        circuits, terms = self._circuits, dict[int, Any]()
        for j in circuits.tasks:
            due = self._rules.due[j]
            if math.isfinite(due):
                late = self._model.new_int_var(0, self.costs.longest, "")
                self._model.add(late >= self.end[j] - self._up(due)).only_enforce_if(circuits.done[j])
                terms[j] = weights[j] * late
        return terms
