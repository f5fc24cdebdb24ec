"""The ledger of goods: what each robot has on board, what was delivered, put down and unloaded, and what lies where."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Mapping
from dataclasses import dataclass, field

from muster.mission.goods import by_commodity, shown_amounts
from muster.mission.model import Robot, Task
from muster.state.task_ledger import Ledger

_ROUNDING = 1e-9


@dataclass
class Item:
    """Goods on board of a robot: of the task that took them on; None: the robot had them at the start."""

    task: str | None
    amounts: dict[str, float]


Sums = dict[str, float]


@dataclass
class GoodsLedger:
    """What became of all goods.

    Parameters
    ----------
    on_board
        by robot, in the order in which it took them on.
    lying
        by task the goods that it took on and that lie where their robot failed; the task is open again.
    taken, delivered, put_down, unloaded, left
        sums by commodity: of what was taken on, or was on board at the start; delivered; put down by tasks with a
        negative load; unloaded at stations; and what lies where a robot failed and belongs to no task.
    """

    on_board: dict[str, list[Item]] = field(default_factory=dict)
    lying: dict[str, Sums] = field(default_factory=dict)
    taken: Sums = field(default_factory=dict)
    delivered: Sums = field(default_factory=dict)
    put_down: Sums = field(default_factory=dict)
    unloaded: Sums = field(default_factory=dict)
    left: Sums = field(default_factory=dict)

    def join(self, robot: Robot) -> None:
        """A robot takes part, with what it has on board."""
        amounts = dict(by_commodity(robot.load_at_start))
        self.on_board[robot.id] = [Item(None, amounts)] if amounts else []
        _add(self.taken, amounts)

    def load(self, robot: str) -> Sums:
        """What a robot has on board, by commodity."""
        sums: Sums = {}
        for item in self.on_board.get(robot, ()):
            _add(sums, item.amounts)
        return {name: amount for name, amount in sums.items() if amount > _ROUNDING}

    def carrier(self, task: str) -> str | None:
        """The robot that has on board what a task took on; None: nobody."""
        found = (robot for robot, items in self.on_board.items() if any(item.task == task for item in items))
        return next(found, None)

    def carried(self, task: str) -> Mapping[str, float]:
        """What of a task's goods is on board."""
        items = (item for items in self.on_board.values() for item in items if item.task == task)
        return next((item.amounts for item in items), {})

    @property
    def tasks(self) -> set[str]:
        """The tasks whose goods are on board."""
        return {item.task for items in self.on_board.values() for item in items if item.task is not None}

    def end(self, task: Task, robot: str) -> None:
        """A robot has done a task."""
        items = self.on_board.setdefault(robot, [])
        if task.delivers is not None:
            for item in [item for item in items if item.task == task.delivers]:
                items.remove(item)
                _add(self.delivered, item.amounts)
        loads = by_commodity(task.load)
        more = {name: amount for name, amount in loads.items() if amount > 0}
        if more:
            items.append(Item(task.id, dict(more)))
            if self.lying.pop(task.id, None) is None:
                _add(self.taken, more)
        for name, amount in loads.items():
            if amount < 0:
                self._put_down(items, name, -amount)

    def _put_down(self, items: list[Item], name: str, amount: float) -> None:
        """Goods leave a robot, the oldest first."""
        for item in items:
            some = min(amount, item.amounts.get(name, 0.0))
            if some > 0:
                item.amounts[name] -= some
                _add(self.put_down, {name: some})
                amount -= some
        _drop_empty(items)

    def loose(self, robot: str, tied: Collection[str]) -> Sums:
        """What a robot has on board but for the goods of some tasks, which others deliver."""
        gone: Sums = {}
        for item in self.on_board.get(robot, ()):
            if item.task not in tied:
                _add(gone, item.amounts)
        return gone

    def unload(self, robot: str, tied: Collection[str]) -> None:
        """A robot unloads at a station all but the goods of some tasks, which others deliver."""
        _add(self.unloaded, self.loose(robot, tied))
        self.on_board[robot] = [item for item in self.on_board.get(robot, ()) if item.task in tied]

    def fall(self, robot: str) -> None:
        """A robot fails: what it has on board lies where it is, and tasks that took it on are open again."""
        items, self.on_board[robot] = self.on_board.get(robot, []), []
        for item in items:
            if item.task is None:
                _add(self.left, item.amounts)
            else:
                self.lying[item.task] = dict(item.amounts)

    def refusal(self, task: Task, robot: Robot) -> str:
        """Why a robot cannot do a task with what it has on board; empty if it can."""
        if task.delivers is not None and self.carrier(task.delivers) != robot.id:
            return f"load: {robot.id} does not have on board what {task.delivers} takes on"
        here = self.load(robot.id)
        for name, amount in by_commodity(task.load).items():
            most = None if robot.load_capacity is None else by_commodity(robot.load_capacity).get(name, 0.0)
            then = here.get(name, 0.0) + amount
            if most is not None and amount > 0 and then > most * (1 + _ROUNDING) + _ROUNDING:
                return f"load: {shown_amounts({name: then})} on board with it, of {most:g}"
            if then < -_ROUNDING:
                return f"load: puts down {shown_amounts({name: -amount})}, {here.get(name, 0.0):g} on board"
        return ""


def tied_goods(ledger: Ledger) -> set[str]:
    """The tasks whose goods a task delivers that is still to be done."""
    return {task.delivers for task in ledger.open if task.delivers is not None}


def _add(sums: Sums, amounts: Mapping[str, float] | Iterable[tuple[str, float]]) -> None:
    for name, amount in dict(amounts).items():
        sums[name] = sums.get(name, 0.0) + amount


def _drop_empty(items: list[Item]) -> None:
    items[:] = [item for item in items if any(amount > _ROUNDING for amount in item.amounts.values())]
