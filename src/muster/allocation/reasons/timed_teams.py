"""Which teams could do a task beside the routes of a plan, where times, teams and relations matter."""

from __future__ import annotations

import itertools
from collections.abc import Iterator, Sequence

import numpy as np

from muster import core
from muster.model.bottleneck import fills
from muster.model.problem import Problem
from muster.model.rules.rule import ROUNDING, InPlan, stop_of

Member = tuple[int, int]
"""A robot, and the task that it does."""


class TimedTeams(InPlan):
    """Routes, and the robots that could do one more task together."""

    is_timed = True

    def __init__(self, problem: Problem, routes: Sequence[Sequence[int]]) -> None:
        super().__init__(problem, routes)
        self.problem: Problem = problem

    def members(self, j: int) -> Sequence[int]:
        return [i for i, route in enumerate(self.routes) if j in route]

    def _arrival(self, i: int, j: int, gap: int) -> float:
        """When robot i would be at task j after the tasks before a gap."""
        problem = self.problem
        if gap == 0:
            there = problem.travel_seconds(i, [problem.start(i)], [j])
            return problem.robots[i].available_from_s + float(there[0, 0])
        there = problem.travel_seconds(i, [self.routes[i][gap - 1]], [j])
        if not has_schedule(self.inspection):
            return float(there[0, 0])  # of a plan without a schedule nothing more is known
        return stop_of(self.inspection, i, gap - 1)[2] + float(there[0, 0])

    def _teams(self, i: int, j: int) -> Iterator[list[Member]]:
        """Different robots for all places of a task and of those that begin with it, robot i at the task."""
        rules = self.problem.model
        together = rules.beginning_with(j)
        unit = [j, *(k for k in together if k not in self.done)]
        taken = {robot for k in together for robot in self.members(k)}
        if i not in taken:
            yield from self._completed(unit, i, taken, [])

    def _completed(self, unit: Sequence[int], i: int, taken: set[int], members: list[Member]) -> Iterator[list[Member]]:
        if not unit:
            yield members
            return
        for team in self._teams_of(unit[0], None if members else i):
            if not taken & set(team):
                more = [*members, *((robot, unit[0]) for robot in team)]
                yield from self._completed(unit[1:], i, taken | set(team), more)

    def _teams_of(self, j: int, required: int | None) -> Iterator[tuple[int, ...]]:
        """The teams of one task, with a robot that must be in it; the robots that are free first before others."""
        able = [k for k in self._by_arrival(j) if self._keeps_relations(k, j)]
        if required is not None and required not in able:
            return
        tied = self._members_by_relation(j)
        if tied is not None:
            if tied <= set(able) and self._is_enough(j, sorted(tied)):
                yield tuple(sorted(tied))
            return
        others = [k for k in able if k != required]
        given = () if required is None else (required,)
        for size in self._sizes(j, len(able)):
            for rest in itertools.combinations(others, size - len(given)):
                team = (*given, *rest)
                if self._is_enough(j, team) and self._without_idlers(j, team):
                    yield team

    def _sizes(self, j: int, most: int) -> range:
        rules = self.problem.model
        if rules.is_for_team(j) and rules.sums(j):
            return range(1, most + 1)
        count = sum(count for count, _ in rules.seats(j))
        return range(count, count + 1)

    def _is_enough(self, j: int, team: Sequence[int]) -> bool:
        """Whether robots fill the places of a team, or have the abilities."""
        rules = self.problem.model
        if rules.is_for_team(j) and rules.sums(j):
            return self._able(j, team)
        rows = [fits[list(team)] for count, fits in rules.seats(j) for _ in range(count)]
        return len(rows) == len(team) and fills(np.array(rows, dtype=np.bool_))

    def _without_idlers(self, j: int, team: Sequence[int]) -> bool:
        """Whether a team of abilities needs all members but the first one."""
        rules = self.problem.model
        if not (rules.is_for_team(j) and rules.sums(j)):
            return True
        return not any(self._able(j, [k for k in team if k != one]) for one in team[1:])

    def _able(self, j: int, team: Sequence[int]) -> bool:
        needs = self.problem.model.sums(j)
        return all(float(able[list(team)].sum()) >= needed * (1 - ROUNDING) for needed, able in needs.values())

    def _by_arrival(self, j: int) -> list[int]:
        able = [k for k in range(len(self.problem.robots)) if self.problem.may(k, j)]
        return sorted(able, key=lambda k: (self._arrival(k, j, len(self.routes[k])), k))

    def _keeps_relations(self, k: int, j: int) -> bool:
        rules = self.problem.model
        same = all(not self.members(other) or k in self.members(other) for other in rules.same_crew[j])
        return same and not any(k in self.members(other) for other in rules.apart[j])

    def _members_by_relation(self, j: int) -> set[int] | None:
        """The robots that do the tasks of the plan which the same robots must do; None: there are no such tasks."""
        teams = [set(self.members(k)) for k in self.problem.model.same_crew[j] if self.members(k)]
        return set.intersection(*teams) if teams else None


def has_schedule(found: core.Inspection) -> bool:
    """Whether there are times at which inspected routes can be done."""
    return found.stops is not None
