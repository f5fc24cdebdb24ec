"""Where work is truly done: a simulated world knows, whatever its robots take themselves for.

A robot that errs about its pose, or about where what it found lies, takes a task for done that is not. It goes on so,
and so does the mission; the report says what is true.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import asdict, dataclass, replace
from typing import Any

from muster.execution.reports.report import Report
from muster.mission.model import Mission, Robot, Task
from muster.motion.actions.tolerance import ends_at_its_place, tolerance_m
from muster.running.state_estimation import LocalisedPort, RobotsInWorld
from muster.simulation import SimulatedWorld
from muster.state import ExecutionEvent, OtherEvent
from muster.state.task_events import Ends, MoveTask, Starts

TagOf = Callable[[str], int | None]
"""The tag that a task has come of, by the task's id; None: of none."""
Shift = tuple[float, float]
PlaceAt = Callable[[str, float], Shift | None]


@dataclass(frozen=True)
class DoneAt:
    """How far from its true place a robot did a task, and how far it may have been.

    Of a team it is the robot that was farthest off.
    """

    task: str
    robot: str
    off_m: float
    within_m: float

    @property
    def is_done(self) -> bool:
        """Whether the task is truly done."""
        return self.off_m <= self.within_m

    @property
    def reason(self) -> str:
        """Why it is not done."""
        return f"off its place: {self.robot} did it {self.off_m:.2f} m away; expected within {self.within_m:.2f} m"


class TruePlaces:
    """Follows which robots work on what, and how far from the true places they do it.

    Parameters
    ----------
    mission
        its tags are where they truly are.
    world, robots
        where bodies truly are, and where robots take themselves to be.
    tag_of
        which tags tasks have come of.
    place_at
        where a robot truly was at a time of the mission, as far as that is known: for events that are heard late.
    """

    def __init__(
        self,
        mission: Mission,
        world: SimulatedWorld,
        robots: RobotsInWorld,
        tag_of: TagOf,
        place_at: PlaceAt = lambda robot, time_s: None,
    ) -> None:
        self._tags, self._world, self._robots, self._tag_of = mission.tags, world, robots, tag_of
        self._place_at, self._happened_s = place_at, math.inf
        self._farthest: dict[str, dict[str, float]] = {}
        self._under_way: dict[str, Task] = {}
        self.done: dict[str, DoneAt] = {}
        """By task that robots have taken for done."""

    def follow(
        self, events: Iterable[ExecutionEvent], tasks: Mapping[str, Task], happened_s: float = math.inf
    ) -> Iterator[OtherEvent]:
        """Follow what robots tell of tasks, by id; yields what is not done.

        It happened while robots stood where they did it: now, or at a time of the mission before.
        """
        self._happened_s = happened_s
        for event in events:
            if isinstance(event, Starts):
                self._begin(tasks[event.task], event.team or (event.robot,))
            elif isinstance(event, MoveTask) and event.task in self._under_way:
                self._under_way[event.task] = tasks[event.task]
            elif isinstance(event, Ends) and (off := self._end(event.task)) is not None:
                yield off

    def _begin(self, task: Task, robots: Iterable[str]) -> None:
        self._under_way[task.id] = task
        self._farthest[task.id] = dict.fromkeys(robots, 0.0)
        pickup = None if task.action is None else task.action.pickup
        if pickup is not None:
            for robot in self._farthest[task.id]:
                self._farthest[task.id][robot] = math.dist(self._place_of_deed(robot), pickup[:2])

    def look(self) -> None:
        """Note how far off robots are that work along a way."""
        for task in self._under_way.values():
            if not ends_at_its_place(task):
                self._note(task)

    def _end(self, name: str) -> OtherEvent | None:
        task = self._under_way.pop(name, None)
        if task is None:
            return None
        self._note(task)
        off = self._farthest.pop(name)
        robot = max(off, key=lambda one: off[one])
        done = DoneAt(name, robot, off[robot], tolerance_m(task, self._body(robot)))
        self.done[name] = done
        if done.is_done:
            return None
        return OtherEvent(time_s=self._world.time_s, kind="off_place", content=asdict(done))

    def snapshot(self) -> list[dict[str, Any]]:
        """Return what was done so far, as plain data for `resume`."""
        return [asdict(done) for done in self.done.values()]

    def resume(self, snapshot: Iterable[Mapping[str, Any]]) -> None:
        """Take over what was done before a run was interrupted."""
        self.done.update((row["task"], DoneAt(**row)) for row in snapshot)

    def _note(self, task: Task) -> None:
        off = self._farthest[task.id]
        for robot in off:
            off[robot] = max(off[robot], self._off_m(task, robot, is_alone=len(off) == 1))

    def _off_m(self, task: Task, robot: str, *, is_alone: bool) -> float:
        """How far off a robot is now. Those of a team stand about a place, and are as far off as they err."""
        at_place = is_alone and ends_at_its_place(task)
        x, y = self._place_of_deed(robot) if at_place else self._true_place(robot)
        to = task.exit or task.position if at_place else self._believed_place(robot)
        east, north = self._found_off(task)
        return math.hypot(x - to[0] + east, y - to[1] + north)

    def _true_place(self, robot: str) -> Shift:
        x, y, _ = self._world.ports[robot].true_position
        return x, y

    def _place_of_deed(self, robot: str) -> Shift:
        """Where a robot truly was when what it tells happened."""
        return self._place_at(robot, self._happened_s) or self._true_place(robot)

    def _believed_place(self, robot: str) -> Shift:
        port = self._robots.ports[robot]
        if not isinstance(port, LocalisedPort):
            return self._true_place(robot)
        x, y = map(float, port.estimate.pose[:2])
        return x, y

    def _found_off(self, task: Task) -> Shift:
        """By how much a task that was found lies off the tag that it came of."""
        tag = self._tag_of(task.id)
        there = [(float(t.position[0]), float(t.position[1])) for t in self._tags if t.id == tag]
        if not there:
            return 0.0, 0.0
        x, y = task.position[:2]
        east, north = min(there, key=lambda place: math.dist(place, (x, y)))
        return x - east, y - north

    def _body(self, robot: str) -> Robot:
        return self._world.ports[robot].body


def with_truth(report: Report, mission: Mission, done: Mapping[str, DoneAt]) -> Report:
    """A report in which tasks are done that are truly done; the others are lost, with how far off they were done."""
    off = {name: at.reason for name, at in done.items() if not at.is_done and name in report.tasks_done}
    rows = tuple(
        replace(row, done_m_off=done[row.task].off_m, within_m=done[row.task].within_m) if row.task in done else row
        for row in report.tasks
    )
    true = tuple(name for name in report.tasks_done if name not in off)
    orders = report.orders
    if orders is not None:
        came = len(off.keys() - {task.id for task in mission.tasks})
        orders = replace(orders, done=orders.done - came, lost=orders.lost + came)
    lost = (*report.tasks_lost, *off.items())
    return replace(report, tasks=rows, tasks_done=true, tasks_lost=lost, orders=orders)
