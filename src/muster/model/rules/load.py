"""What a robot has on board fits in; what one task takes on board and another delivers is one transport."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import ClassVar

import numpy as np

from muster.mission.goods import by_commodity, shown_amounts
from muster.mission.model import Robot, Task
from muster.model.parts import Meter, Parts
from muster.model.rules.rule import Bools, Change, Limits, Outlook, Question, Rule, Tried

Amounts = Mapping[str, float]


@dataclass(frozen=True)
class MoreRoom(Change):
    """What the robot would have to carry, by commodity."""

    load_capacity: Amounts

    @property
    def plain(self) -> Amounts:
        return self.load_capacity

    @property
    def short(self) -> str:
        return f"a load capacity of {shown_amounts(self.load_capacity)}"

    def robot(self, robot: Robot) -> Robot:
        most = robot.load_capacity
        if not isinstance(most, Mapping):
            return replace(robot, load_capacity=max(self.load_capacity.values()))
        return replace(robot, load_capacity={**most, **self.load_capacity})


class Load(Rule):
    """After every stop the load of each commodity is between 0 and the robot's `load_capacity`."""

    word: ClassVar[str] = "load"
    asked: ClassVar[Mapping[str, str]] = {"meters": "load"}
    key = "load_capacity"
    lifted_late = True
    of_a_route = True
    kept_by_calls = True

    def _holds(self, problem: Question) -> bool:
        return problem.holds(self.word)

    def compile(self, problem: Question, parts: Parts) -> None:
        names = commodities(problem)
        for j, task in enumerate(problem.tasks):
            if task.delivers in problem.task_index:
                parts.deliver(j, problem.task_index[task.delivers])
        for name in names:
            parts.meter(_meter(problem, name, parts.taken_on_by))

    def kinds(self, problem: Question) -> list[Hashable] | None:
        names = commodities(problem)
        return [_carries(robot, names) for robot in problem.robots] if names else None

    def refusal(self, problem: Question, i: int, j: int) -> str | None:
        lacking = _too_much(problem, problem.robots[i], problem.tasks[j])
        return None if lacking is None else f"{lacking[0]}, and it carries {lacking[1]}"

    def possible(self, limits: Limits) -> Bools | None:
        """Both tasks of a transport, or neither."""
        pickup = limits.problem.model.pickups
        if not any(k >= 0 for k in pickup):
            return None
        possible = np.ones_like(limits.usable)
        for j, k in enumerate(pickup):
            if k >= 0:
                both = limits.usable[:, j] & limits.usable[:, k]
                possible[:, j] = possible[:, k] = both
        return possible

    def never(self, problem: Question, i: int, j: int, outlook: Outlook) -> str | None:
        refused = self.refusal(problem, i, j)
        if refused is not None:
            return refused
        other = problem.model.partners[j]
        if other is None or outlook.limits.usable[i, other]:
            return None
        return f"it cannot do {problem.tasks[other].id}, which {_is_to(problem, j)}"

    def concerns(self, problem: Question, j: int) -> bool:
        other = problem.model.partners[j]
        return any(problem.tasks[k].load is not None for k in (j, other) if k is not None)

    def broken_at(self, tried: Tried) -> str:
        return "at every place in its route it would carry more than it can, or put down more than it has"

    def change(self, problem: Question, robot: Robot, task: Task) -> MoreRoom | None:
        if not self._holds(problem):
            return None
        needed = {name: load for name, load in by_commodity(task.load).items() if load > room_for(robot, name)}
        return MoreRoom(needed) if needed else None


def _carries(robot: Robot, names: Sequence[str]) -> Hashable:
    """What makes a robot the same as another for loads of these commodities."""
    return tuple((name, room_for(robot, name), _at_start(robot).get(name, 0.0)) for name in names)


def commodities(problem: Question) -> list[str]:
    """Everything that is carried; nothing where loads are ignored."""
    if not problem.holds("load"):
        return []
    named = {name for task in problem.tasks for name in by_commodity(task.load)}
    if not named:
        return []
    return sorted(named | {name for robot in problem.robots for name in _at_start(robot)})


def _meter(problem: Question, name: str, pickup_of: Mapping[int, int]) -> Meter:
    """What tasks change of a commodity on board, and what of that others deliver."""
    own = np.array([by_commodity(task.load).get(name, 0.0) for task in problem.tasks])
    change, pending, pending_at_start = own.copy(), np.zeros(len(own)), np.zeros(len(problem.robots))
    for j, pickup in pickup_of.items():
        pending[pickup] += own[pickup]
        pending[j] -= own[pickup]
        change[j] -= own[pickup]
    for i, deliveries in enumerate(problem.aboard):
        for j in deliveries:
            pending_at_start[i] -= own[j]
            pending[j] += own[j]
    return Meter(
        name,
        change,
        np.array([room_for(robot, name) for robot in problem.robots]),
        np.array([_at_start(robot).get(name, 0.0) for robot in problem.robots]),
        pending,
        pending_at_start,
    )


def room_for(robot: Robot, commodity: str) -> float:
    """How much of a commodity a robot carries; inf without a capacity, 0 of what its capacities do not name."""
    if robot.load_capacity is None:
        return np.inf
    return by_commodity(robot.load_capacity).get(commodity, 0.0)


def _at_start(robot: Robot) -> Amounts:
    return by_commodity(robot.load_at_start)


def _is_to(problem: Question, j: int) -> str:
    return "takes on what it delivers" if problem.tasks[j].delivers is not None else "delivers what it takes on"


def _too_much(problem: Question, robot: Robot, task: Task) -> tuple[str, str] | None:
    """What a task takes on that is more than a robot carries, and how much that is."""
    if not problem.holds("load"):
        return None
    for name, load in by_commodity(task.load).items():
        if load > (room := room_for(robot, name)):
            return f"takes {shown_amounts({name: load})} on board", f"{room:.10g}"
    return None
