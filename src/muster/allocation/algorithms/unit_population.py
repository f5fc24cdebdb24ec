"""A population of plans in which units of work are bound to times, teams and relations.

A member says in which order units are appended to routes, and by whom: an order-based representation ([tcf-thesis],
section 2.3, reviews such algorithms). Every order is decoded to an admissible plan: time and again the first unit that
can follow is appended, by its team where that can do it, else by the one that costs least. Mutation moves a unit in the
order and may free its team; crossover takes a stretch of one order, with its teams, and the rest as in the other.
"""

from __future__ import annotations

import random
from collections.abc import Iterable
from dataclasses import dataclass, field

from muster.allocation.working_roster import Routes, WorkingRoster
from muster.model.problem import Problem

_FREED = 0.5  # how often a mutation frees the team of the unit that it moves
_TRIES = 100  # to find a mutant

Teams = dict[int, tuple[int, ...]]
Value = tuple[float, float]


@dataclass
class Member:
    """Units in the order in which they are appended, and their teams; then the plan that this comes to."""

    order: list[int]
    teams: Teams
    routes: Routes = field(default_factory=list)
    value: Value = (float("inf"), float("inf"))  # weight left out, objective


class UnitPopulation:
    """The population of the genetic algorithm and hill climbing, with the steps of `core.Population`."""

    def __init__(self, problem: Problem, size: int, seed: int) -> None:
        self._problem = problem
        self._random = random.Random(seed)
        self._roster = WorkingRoster(problem)
        self._units = list(self._roster.core.absent)
        self._members = [self._decoded(Member(sorted(self._units), {})) for _ in range(size)]

    def __len__(self) -> int:
        return len(self._members)

    def set_random(self, k: int) -> None:
        """A random order, done by random robots where one does a unit alone."""
        order = self._random.sample(self._units, len(self._units))
        alone: Teams = {unit: (self._random.choice(able),) for unit in order if (able := self._able(unit))}
        self._members[k] = self._decoded(Member(order, alone))

    def set(self, k: int, routes: Routes) -> bool:
        """The plan with these routes; False if they are not admissible."""
        roster = WorkingRoster(self._problem, routes)
        begins: dict[int, tuple[float, int]] = {}
        teams: dict[int, set[int]] = {}
        for robot, stops in enumerate(roster.core.stops):
            for at, (task, _, begin, _) in enumerate(stops):
                unit = self._problem.model.unit[task]
                begins[unit] = max(begins.get(unit, (begin, at)), (begin, at))
                teams.setdefault(unit, set()).add(robot)
        order = sorted(self._units, key=lambda unit: begins.get(unit, (float("inf"), unit)))
        chosen = {unit: tuple(sorted(team)) for unit, team in teams.items()}
        self._members[k] = Member(order, chosen, [list(route) for route in routes], roster.value)
        return True

    def set_mutant(self, k: int, of: int) -> None:
        """A mutant of a member, be it better or not."""
        for _ in range(_TRIES):
            mutant = self._mutant(self._members[of])
            if mutant.value[0] <= self._members[of].value[0]:
                self._members[k] = mutant
                return
        self._members[k] = self._members[of]

    def replace_worst(self, share: float) -> None:
        """Random plans for the worst share."""
        ranked = sorted(range(len(self._members)), key=lambda k: self._members[k].value, reverse=True)
        for k in ranked[: int(share * len(ranked) + 1e-9)]:
            self.set_random(k)

    def mutate(self, probability: float) -> None:
        """A mutation of each member, kept where it is better."""
        for k, member in enumerate(self._members):
            if self._random.random() <= probability:
                self._members[k] = min(member, self._mutant(member), key=_value)

    def cross(self, probability: float) -> None:
        """Each member with another; the best two of parents and children stay."""
        size = len(self._members)
        for n in range(size if size > 1 else 0):
            if self._random.random() <= probability:
                k = (n + 1 + self._random.randrange(size - 1)) % size
                one, other = self._members[n], self._members[k]
                family = [one, other, self._child(one, other), self._child(other, one)]
                self._members[n], self._members[k] = sorted(family, key=_value)[:2]

    def best(self) -> int:
        """The number of the best member."""
        return min(range(len(self._members)), key=lambda k: self._members[k].value)

    def weight(self, k: int) -> float:
        """Weight of the tasks done."""
        return self._problem.value(self._members[k].routes)[0]

    def objective(self, k: int) -> float:
        """Objective of a member's plan."""
        return self._members[k].value[1]

    def routes(self, k: int) -> Routes:
        """A member's plan."""
        return self._members[k].routes

    def _able(self, unit: int) -> list[int]:
        """The robots that may do a unit, where one alone does it."""
        rules = self._problem.model
        task, *more = rules.units[unit]
        if more or rules.is_for_team(task):
            return []
        return [robot for robot in range(len(self._problem.robots)) if self._problem.may(robot, task)]

    def _mutant(self, member: Member) -> Member:
        if not member.order:
            return member
        order, teams = list(member.order), dict(member.teams)
        unit = order.pop(self._random.randrange(len(order)))
        order.insert(self._random.randrange(len(order) + 1), unit)
        if self._random.random() < _FREED:
            teams.pop(unit, None)
        elif able := self._able(unit):
            teams[unit] = (self._random.choice(able),)
        return self._decoded(Member(order, teams))

    def _child(self, one: Member, other: Member) -> Member:
        """Order crossover: a stretch of one, the rest in the order of the other, each with its teams."""
        first, last = sorted(self._random.randrange(len(one.order) + 1) for _ in range(2))
        stretch = one.order[first:last]
        kept = set(stretch)
        rest = [unit for unit in other.order if unit not in kept]
        teams = {unit: team for unit, team in other.teams.items() if unit not in kept}
        teams |= {unit: one.teams[unit] for unit in stretch if unit in one.teams}
        return self._decoded(Member([*rest[:first], *stretch, *rest[first:]], teams))

    def _decoded(self, member: Member) -> Member:
        roster = self._roster
        roster.clear()
        waiting: Iterable[int] = member.order
        while left := [unit for unit in waiting if not self._append(unit, member.teams)]:
            if left == waiting:
                break
            waiting = left
        roster.finish()
        member.routes, member.value = roster.routes, roster.value
        return member

    def _append(self, unit: int, teams: Teams) -> bool:
        """Append a unit to routes; tells whether it could follow, or came with the other one of a transport."""
        roster = self._roster
        if roster.core.present(unit):
            return True
        if not roster.core.ready(unit):
            return False
        insertion = roster.best(unit, teams[unit]) if unit in teams else None
        insertion = insertion or roster.best(unit)
        return insertion is not None and roster.put(insertion)


def _value(member: Member) -> Value:
    return member.value
