"""How a mission stands at a moment: what each robot does, what it waits for and has left, how far each task is."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from muster.execution.changes import OUT
from muster.execution.robot_state import Activity, Hand
from muster.execution.task_ledger import Ledger

if TYPE_CHECKING:
    from muster.execution.executor import Executor

TaskState = Literal["open", "under way", "done", "lost", "cancelled"]
_AT_TASK = (Activity.DRIVING, Activity.WAITING, Activity.WORKING)


@dataclass(frozen=True, kw_only=True)
class RobotStatus:
    """One robot, now.

    Parameters
    ----------
    activity
        `driving`, `waiting`, `working`, `returning`, `idle`.
    out
        why it takes no part, in words; empty if it does.
    task
        at which it is, or to which it drives.
    waits_for
        the prerequisites for which it waits there.
    route
        tasks that it is still to do, that at hand first.
    used, usage_left
        in the mission's unit; None left: any amount.
    charge
        what its battery says, 0 to 1; None where it says nothing.
    available
        the availability `a_i` of [tcf-thesis], 5.3.1.
    """

    activity: str
    out: str
    task: str | None
    waits_for: tuple[str, ...]
    route: tuple[str, ...]
    used: float
    usage_left: float | None
    charge: float | None
    available: bool


@dataclass(frozen=True)
class Status:
    """The crew and the tasks by their ids, now."""

    robots: Mapping[str, RobotStatus]
    tasks: Mapping[str, TaskState]


def status_of(executor: Executor) -> Status:
    """How the mission that is carried out stands."""
    limited = "capacity" not in executor.planned.ignored
    robots = {name: _robot(hand, executor.ledger, limited=limited) for name, hand in executor.crew.items()}
    return Status(robots, {task: _state(task, executor) for task in executor.ledger.tasks})


def _robot(hand: Hand, ledger: Ledger, *, limited: bool) -> RobotStatus:
    at_task = hand.activity in _AT_TASK and bool(hand.route)
    capacity = hand.capacity if limited else None
    return RobotStatus(
        activity=hand.activity.value,
        out=OUT.get(hand.out, hand.out),
        task=hand.route[0] if at_task else None,
        waits_for=tuple(ledger.missing(hand.route[0])) if hand.activity is Activity.WAITING else (),
        route=tuple(hand.route),
        used=hand.used,
        usage_left=None if capacity is None else max(0.0, capacity - hand.used),
        charge=None if hand.told is None else hand.told.charge,
        available=hand.available,
    )


def _state(task: str, executor: Executor) -> TaskState:
    ledger = executor.ledger
    if task in ledger.ends_s:
        return "done"
    if task in ledger.cancelled:
        return "cancelled"
    if task in ledger.starts_s:
        return "under way"
    return "lost" if executor.done else "open"
