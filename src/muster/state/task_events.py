"""Events of tasks: what robots do at them, and what becomes of them."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from muster.state import words
from muster.state.event import ExecutionEvent, happens
from muster.state.task_ledger import MissedTask, lying

if TYPE_CHECKING:
    from muster.state.mission_state import MissionState

Position = tuple[float, ...]


@happens("sets_out", "{robot} sets out for task {task}")
class SetsOut(ExecutionEvent):
    """A robot sets out for a task. `used` is its usage so far, in the mission's unit, here and below."""

    robot: str
    task: str
    used: float | None = None

    def change(self, state: MissionState) -> None:
        state.note_used(self.robot, self.used)
        if (robot := state.robots.get(self.robot)) is not None:
            robot.leave(self.time_s)


@happens("arrives", "{robot} is at task {task}")
class Arrives(ExecutionEvent):
    """A robot is at its task."""

    robot: str
    task: str
    used: float | None = None

    def change(self, state: MissionState) -> None:
        state.note_used(self.robot, self.used)
        if (robot := state.robots.get(self.robot)) is not None:
            robot.came_to[self.task] = self.time_s, self.used or 0.0


@happens("waits", "{robot} {words}")
class Waits(ExecutionEvent):
    """A robot waits at a task for something else than prerequisites, or now for that."""

    robot: str
    task: str
    cause: str
    words: str


@happens("starts", "{robot} begins task {task}")
class Starts(ExecutionEvent):
    """Robots begin a task: one, or a team, whose first is `robot`; `from_s` if not now: from when their work counts."""

    task: str
    robot: str
    team: tuple[str, ...] = ()
    used: float | None = None
    from_s: float | None = None

    def change(self, state: MissionState) -> None:
        robots = self.team or (self.robot,)
        state.note_used(self.robot, self.used)
        state.begin(self.task, robots, self.time_s if self.from_s is None else self.from_s)


@happens("ends", "{robot} has done task {task}")
class Ends(ExecutionEvent):
    """Robots have done a task.

    `usage` is planned and measured, of all robots and the way there; `arrival_usage` is that of the robot when it came;
    `parts` are by robot of a team the planned usage of its part, and its usage so far.
    """

    task: str
    robot: str
    team: tuple[str, ...] = ()
    used: float | None = None
    parts: Mapping[str, tuple[float, float]] = field(default_factory=dict)
    usage: tuple[float, float] | None = None
    arrival_usage: float | None = None

    def change(self, state: MissionState) -> None:
        robots = self.team or (self.robot,)
        for robot in robots:
            state.note_used(robot, self.parts[robot][1] if robot in self.parts else self.used)
        usage = self.usage or (0.0, 0.0)
        share = 0.0 if self.parts else usage[0] / len(robots)
        shares = {robot: self.parts[robot][0] if robot in self.parts else share for robot in robots}
        state.end(self.task, shares, usage, self.time_s)
        if self.arrival_usage is not None and self.task in state.ledger.tasks:
            state.ledger.arrival_usage[self.task] = self.arrival_usage


@happens("part_ends", "{robot} has done its part of task {task}", mark=words.DETAIL)
class PartEnds(ExecutionEvent):
    """Another robot of a team tells the usage of its part in a task that was done."""

    task: str
    robot: str
    usage: tuple[float, float]

    def change(self, state: MissionState) -> None:
        if self.task in state.ledger.usage:
            planned, measured = state.ledger.usage[self.task]
            state.ledger.usage[self.task] = planned + self.usage[0], measured + self.usage[1]
        if (robot := state.robots.get(self.robot)) is not None:
            robot.planned += self.usage[0]


@happens("done_elsewhere", "{robots} have done task {task}, as others have told", mark=words.DETAIL)
class DoneElsewhere(ExecutionEvent):
    """Robots of which another has told have done a task."""

    task: str
    robots: tuple[str, ...]

    def change(self, state: MissionState) -> None:
        state.ledger.end(self.task, self.robots, self.time_s)


@happens("work_broken_off", "work on task {task} is broken off")
class WorkBrokenOff(ExecutionEvent):
    """Work on a task is broken off: what was done of it is lost."""

    task: str
    robot: str

    def change(self, state: MissionState) -> None:
        state.ledger.break_off(self.task)


@happens("task_refused", words.refused)
class TaskRefused(ExecutionEvent):
    """A robot cannot do a task.

    `for_now`: with what it has on board. `blocked_by` is a robot that stands there, out; `others` are by task robots
    that cannot do it for the same reason.
    """

    task: str
    robot: str
    reason: str
    blocked_by: str = ""
    others: Mapping[str, tuple[str, ...]] = field(default_factory=dict)
    for_now: bool = False

    def change(self, state: MissionState) -> None:
        if self.for_now:
            state.misfits.add((self.robot, self.task))
            return
        if self.robot in state.ledger.at_work(self.task):
            state.ledger.break_off(self.task)
        for task, robots in (*self.others.items(), (self.task, (self.robot,))):
            for robot in robots:
                state.ledger.refuse(task, robot, self.reason)
        if self.blocked_by:
            state.ledger.blocked_by |= dict.fromkeys((self.task, *self.others), self.blocked_by)


@happens("new_task", "task {task} is added", mark=words.CHANGE)
class NewTask(ExecutionEvent):
    """A task is added: as in a mission file, or the id of one of the mission's events; `came_s`: ordered before now."""

    task: Mapping[str, Any] | str
    came_s: float | None = None

    @property
    def task_id(self) -> str:
        """The id of the task."""
        return self.task if isinstance(self.task, str) else str(self.task["id"])

    def change(self, state: MissionState) -> None:
        task = state.task_of(self.task)
        state.ledger.add(task)
        state.orders.come(task.id, self.time_s if self.came_s is None else self.came_s)


@happens("cancel_task", "task {task} is cancelled", mark=words.CHANGE)
class CancelTask(ExecutionEvent):
    """A task is cancelled, and so is the delivery of what it takes on, unless that is on board."""

    task: str

    def change(self, state: MissionState) -> None:
        if self.task not in state.ledger.tasks:
            return
        state.ledger.break_off(self.task)
        state.ledger.withdraw(self.task, self.time_s)
        if state.goods.carrier(self.task) is None:
            for other in state.ledger.open:
                if other.delivers == self.task:
                    why = f"load: {self.task}, which takes on what it delivers, is cancelled"
                    state.ledger.expire(other.id, why)
        state.orders.close(self.task, "cancelled", self.time_s)


@happens("move_task", "task {task} is moved to {position}", mark=words.CHANGE)
class MoveTask(ExecutionEvent):
    """A task is elsewhere from now on: metres in the map frame.

    `under_way`: a delivery whose load is on its way, which is brought to the new place; otherwise nobody is at it.
    """

    task: str
    position: Position
    under_way: bool = False

    def change(self, state: MissionState) -> None:
        if self.task in state.ledger.tasks:
            state.ledger.move(self.task, self.position, under_way=self.under_way)


@happens("delay_task", "task {task} takes {by_s} s longer", mark=words.CHANGE)
class DelayTask(ExecutionEvent):
    """The work of a task takes longer."""

    task: str
    by_s: float

    def change(self, state: MissionState) -> None:
        state.ledger.delay(self.task, self.by_s)


@happens("load_lies", "what task {task} took on lies at {position}, where {robot} failed")
class LoadLies(ExecutionEvent):
    """What a task took on board lies where its robot failed: it is done again, from there."""

    task: str
    robot: str
    position: Position
    load: Mapping[str, float]

    def change(self, state: MissionState) -> None:
        if self.task not in state.tasks:
            return
        state.ledger.reopen(lying(state.tasks[self.task], self.position, self.load))
        if (robot := state.robots.get(self.robot)) is not None:
            robot.done = [name for name in robot.done if name != self.task]
            robot.stops = [name for name in robot.stops if name != self.task]


@dataclass(frozen=True, kw_only=True)
class TaskMissed(ExecutionEvent):
    """A task was not begun in time; `next_s`: when it may begin all the same, None: never."""

    task: str
    reason: str
    next_s: float | None

    def change(self, state: MissionState) -> None:
        if self.task not in state.ledger.tasks:
            return
        state.ledger.missed.append(MissedTask(self.task, self.time_s, self.reason, self.next_s))
        if self.next_s is None:
            state.ledger.expire(self.task, self.reason)


@happens("window_missed", "task {task} is not begun in time", mark=words.missed_mark)
class WindowMissed(TaskMissed):
    """A time window has closed."""


@happens("deadline_missed", "task {task} is not begun in time", mark=words.missed_mark)
class DeadlineMissed(TaskMissed):
    """A task cannot end by its deadline any more."""


@happens("within_missed", "task {task} is not begun in time", mark=words.missed_mark)
class WithinMissed(TaskMissed):
    """Too much time has gone since a prerequisite, or what it delivers was taken on board."""


MISSED = {"openings": WindowMissed, "ends_by": DeadlineMissed, "gaps": WithinMissed}
"""By primitive: the event that says that a task cannot begin in time any more."""


@happens("standstill", words.standstill, mark=words.ALARM)
class Standstill(ExecutionEvent):
    """No robot gets on; `given_up`: why the task for which one waits is given up."""

    task: str
    waits_for: tuple[str, ...] = ()
    words: str
    given_up: str = ""

    def change(self, state: MissionState) -> None:
        if self.given_up and self.task in state.ledger.tasks:
            state.ledger.expire(self.task, self.given_up)


@happens("lost", words.lost, mark=words.lost_mark)
class Lost(ExecutionEvent):
    """A task is not done: it never will be, or the mission is over."""

    task: str
    reason: str

    def change(self, state: MissionState) -> None:
        state.ledger.lose(self.task, self.reason)
        state.orders.close(self.task, "lost", self.time_s)


@happens("forgets", "tasks that are long over are forgotten: {tasks}", mark=words.DETAIL)
class Forgets(ExecutionEvent):
    """A fleet on duty forgets tasks that are long over, but for sums."""

    tasks: tuple[str, ...]

    def change(self, state: MissionState) -> None:
        state.forget(self.tasks)


@happens("twice", "{robots} have both begun task {task}: they could not hear each other", mark=words.ALARM)
class Twice(ExecutionEvent):
    """Two robots that could not hear each other have begun the same task."""

    task: str
    robots: tuple[str, ...]

    def change(self, state: MissionState) -> None:
        before = state.done_twice.get(self.task, ())
        state.done_twice[self.task] = tuple(dict.fromkeys((*before, *self.robots)))
