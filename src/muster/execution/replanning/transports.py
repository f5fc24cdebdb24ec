"""Transports under way, as replanning sees them: who carries what, and the deliveries of what is on board."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster.execution.robots.robot_state import Activity, RobotState
from muster.mission.goods import by_commodity, negative
from muster.mission.ignorable_rules import without
from muster.mission.model import Task
from muster.state.goods_ledger import GoodsLedger
from muster.state.task_ledger import Ledger


@dataclass(frozen=True)
class Carried:
    """The goods that a task took on, on board of a robot, or about to be."""

    robot: str
    amounts: Mapping[str, float]


def on_board(crew: Mapping[str, RobotState], ledger: Ledger, goods: GoodsLedger) -> dict[str, Carried]:
    """By task what is on board when the work under way is done; robots that are out carry on what they have."""
    found = {}
    for robot, items in goods.on_board.items():
        found.update({item.task: Carried(robot, item.amounts) for item in items if item.task is not None})
    for task, state in _at_work(crew, ledger):
        more = {name: amount for name, amount in by_commodity(task.load).items() if amount > 0}
        if more:
            found[task.id] = Carried(state.robot.id, more)
    return found


def load_after_work(state: RobotState, ledger: Ledger, goods: GoodsLedger) -> dict[str, float]:
    """What a robot has on board when the work under way is done, by commodity."""
    load = goods.load(state.robot.id)
    for task, _ in _at_work({state.robot.id: state}, ledger):
        changes = by_commodity(task.load)
        if task.delivers is not None:
            delivered = goods.carried(task.delivers)
            changes = {name: changes.get(name, 0.0) - amount for name, amount in delivered.items()} | {
                name: amount for name, amount in changes.items() if name not in delivered
            }
        for name, amount in changes.items():
            load[name] = max(0.0, load.get(name, 0.0) + amount)
    return {name: amount for name, amount in load.items() if amount > 0}


def transports(
    tasks: Sequence[Task], carried: Mapping[str, Carried], ledger: Ledger
) -> tuple[list[Task], dict[str, str]]:
    """Open tasks, where a delivery of what is on board is what its robot puts down; and those of what is nowhere."""
    found, nowhere = [], {}
    left = {task.id for task in tasks}
    for task in tasks:
        name = task.delivers
        if name is None or name in left:
            found.append(task)
        elif name in carried:
            found.append(_put_down(task, carried[name]))
        else:
            nowhere[task.id] = _why(name, ledger)
            found.append(without(task, ("delivers",)))
    return found, nowhere


def deliveries_aboard(tasks: Sequence[Task], carried: Mapping[str, Carried]) -> dict[str, list[str]]:
    """By robot the open tasks that deliver what it has on board."""
    found: dict[str, list[str]] = {}
    left = {task.id for task in tasks}
    for task in tasks:
        if task.delivers is not None and task.delivers not in left and task.delivers in carried:
            found.setdefault(carried[task.delivers].robot, []).append(task.id)
    return found


def _put_down(task: Task, carried: Carried) -> Task:
    """The delivery of what a robot has on board, which no other robot can do."""
    own = by_commodity(task.load)
    put_down = {name: carried.amounts.get(name, 0.0) - own.get(name, 0.0) for name in (*carried.amounts, *own)}
    return without(task, ("delivers",), load=negative(put_down), only_robots=(carried.robot,))


def _why(name: str, ledger: Ledger) -> str:
    if name in ledger.cancelled:
        return f"load: {name}, which takes on what it delivers, is cancelled"
    return f"load: what {name} took on is not on board of any robot"


def _at_work(crew: Mapping[str, RobotState], ledger: Ledger) -> list[tuple[Task, RobotState]]:
    """Tasks under way, and who does them."""
    states = [one for one in crew.values() if not one.out and one.activity is Activity.WORKING and one.route]
    return [(ledger.tasks[state.route[0]], state) for state in states]
