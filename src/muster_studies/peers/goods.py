"""What is carried in a mission, as input of other solvers: whole amounts of one kind, and transports."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from muster.mission.goods import ONLY, Amount, by_commodity
from muster.model.problem import Problem

Transport = tuple[int, int]
"""Two tasks of the instance: the one that takes a load on board, and the one that delivers it."""


@dataclass(frozen=True)
class Goods:
    """What tasks take on board, and what robots can carry.

    Parameters
    ----------
    loads
        for each task what is on board when it is done more than before: below 0 of one that delivers.
    room
        for each robot the most that it carries; None: any amount.
    """

    loads: tuple[int, ...]
    room: tuple[int | None, ...]
    transports: tuple[Transport, ...]

    @property
    def limited(self) -> bool:
        """Whether a load may find no room."""
        return any(self.loads) and any(room is not None for room in self.room)

    @property
    def total(self) -> int:
        """All that is taken on board by all tasks."""
        return sum(load for load in self.loads if load > 0)

    def room_or_all(self, robot: int) -> int:
        """The most that a robot carries; all there is where it carries any amount."""
        room = self.room[robot]
        return self.total if room is None else min(room, self.total)

    @property
    def alone(self) -> list[int]:
        """The tasks that are not of a transport."""
        paired = {task for transport in self.transports for task in transport}
        return [task for task in range(len(self.loads)) if task not in paired]


def goods_of(problem: Problem, tasks: Sequence[int]) -> Goods:
    """The goods of some tasks of a problem, which `unusual_goods` has nothing against."""
    index = {j: k for k, j in enumerate(tasks)}
    transports = [
        (index[partner], index[j])
        for j in tasks
        if problem.tasks[j].delivers is not None and (partner := problem.model.partners[j]) in index
    ]
    loads = [_whole(problem.tasks[j].load) for j in tasks]
    for pickup, delivery in transports:
        loads[delivery] = -loads[pickup]
    room = [None if robot.load_capacity is None else _whole(robot.load_capacity) for robot in problem.robots]
    return Goods(tuple(loads), tuple(room), tuple(transports))


def unusual_goods(problem: Problem, tasks: Sequence[int]) -> bool:
    """Whether goods are of several kinds, in parts, on board at first, or put down without a transport."""
    amounts = [problem.tasks[j].load for j in tasks]
    found = [value for amount in amounts for value in by_commodity(amount).items()]
    return any(name != ONLY or value < 0 or value % 1 for name, value in found) or any(
        robot.load_at_start is not None for robot in problem.robots
    )


def _whole(amount: Amount | None) -> int:
    return int(by_commodity(amount).get(ONLY, 0))
