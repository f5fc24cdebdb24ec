"""Who does a task: one robot or a team, and relations between tasks, as constraints of a program.

Abilities are rounded up and needs down, so that every team of the mission is one of the program.
"""

from __future__ import annotations

import math
from typing import Any

from muster.allocation.exact.circuits import Circuits

_ABILITY_UNITS = 2.0**24  # of the greatest need
_ROUNDING = 1e-9


def add_members(circuits: Circuits) -> None:
    """Let each task that is done be done by as many robots as it needs, and those who may."""
    rules, model = circuits.rules, circuits.model
    for j in circuits.tasks:
        members = [circuits.does[i, j] for i in circuits.members(j)]
        if rules.sums(j):
            _needs(circuits, j, members)
        elif rules.is_for_team(j):
            _parts(circuits, j)
        else:
            model.add(sum(members) == circuits.done[j])
    _units(circuits)
    _relations(circuits)
    _enough_tasks(circuits)


def _needs(circuits: Circuits, j: int, members: list[Any]) -> None:
    """At least one robot, and abilities that sum to the needs."""
    model, done = circuits.model, circuits.done[j]
    model.add_bool_or([*members, done.negated()])
    for member in members:
        model.add_implication(member, done)
    for needed, abilities in circuits.rules.sums(j).values():
        units = _ABILITY_UNITS / max(needed, 1e-12)
        least = math.floor(needed * (1 - _ROUNDING) * units)
        sums = (math.ceil(min(abilities[i], needed) * units) * circuits.does[i, j] for i in circuits.members(j))
        model.add(sum(sums) >= least * done)


def _parts(circuits: Circuits, j: int) -> None:
    """Each member has a place of one part, and each part has all its places taken."""
    model, seats = circuits.model, dict[int, list[Any]]()
    for count, fits in circuits.rules.seats(j):
        taken = []
        for i in circuits.members(j):
            if fits[i]:
                taken.append(model.new_bool_var(""))
                seats.setdefault(i, []).append(taken[-1])
        model.add(sum(taken) == count * circuits.done[j])
    for i in circuits.members(j):
        model.add(sum(seats.get(i, [])) == circuits.does[i, j])


def _units(circuits: Circuits) -> None:
    """Tasks that begin together are done together, by different robots."""
    for unit in circuits.rules.units:
        for j in unit[1:]:
            circuits.model.add(circuits.done[j] == circuits.done[unit[0]])
        for i in circuits.robots if len(unit) > 1 else ():
            circuits.model.add_at_most_one(circuits.does[i, j] for j in unit if (i, j) in circuits.does)


def _enough_tasks(circuits: Circuits) -> None:
    """A robot that does any task does as many as it must."""
    for i, least in enumerate(circuits.rules.least_stops.tolist()):
        if least > 1:
            does = [circuits.does[i, j] for j in circuits.tasks if (i, j) in circuits.does]
            circuits.model.add(sum(does) >= least * circuits.used[i])


def _relations(circuits: Circuits) -> None:
    rules, model = circuits.rules, circuits.model
    for j in circuits.tasks:
        for k in (k for k in rules.exclusive[j] if k > j):
            model.add_at_most_one(circuits.done[j], circuits.done[k])
        for k in rules.same_crew[j]:
            for i in circuits.robots:
                a, b = circuits.does.get((i, j), 0), circuits.does.get((i, k), 0)
                model.add(a == b).only_enforce_if(circuits.done[j], circuits.done[k])
        for k in rules.apart[j]:
            for i in circuits.robots:
                if (i, j) in circuits.does and (i, k) in circuits.does:
                    model.add_at_most_one(circuits.does[i, j], circuits.does[i, k])
