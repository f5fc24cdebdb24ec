"""The state of a mission that is carried out: robots, tasks with their places, and the state of each task.

Events change it. A change of the mission has the name and the content that it has in a mission file's `events`; the
work of a robot has the words of the judge's schedule. An event of another kind changes nothing here.

| kind | data |
|---|---|
| `sets_out`, `arrives`, `starts`, `ends` | `robot`, `task` |
| `returns`, `robot_at_end` | `robot`, on the way to where its route ends |
| `lost` | `task`, `reason` |
| `robot_fails`, `robot_silent`, `robot_stuck`, `robot_returns` | `robot` |
| `waits_in_traffic` | `robot`, `waits_for` (a robot), `position`, `since_s` |
| `goes_on` | `robot`, `until_s`, `position`, `waited_s`: seconds by robot that it waited for |
| `traffic_jam` | `robots`, `position`, `since_s` |
| `robot_joins` | `robot`: a robot as in a mission file, or the id of one in the mission's `events` |
| `new_task` | `task`: a task, likewise |
| `cancel_task` | `task` |
| `move_task` | `task`, `position` |
| `delay_task` | `task`, `by_s` |
| `door_closes`, `door_opens` | `door` |
"""

from __future__ import annotations

from collections import deque
from collections.abc import Iterable, Mapping
from typing import Any, Self

from muster.execution.task_ledger import moved
from muster.mission.errors import MissionError, ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.records import Record
from muster.mission.value_types import Fault

OPEN, UNDER_WAY, DONE, LOST, CANCELLED = "open", "under way", "done", "lost", "cancelled"
OUT = ("robot_fails", "robot_silent", "robot_stuck")
"""Kinds of event after which a robot takes no part."""
ALARMING = ("lost", *OUT, "contact", "traffic_jam")
"""Kinds of event that somebody should look at."""
KEPT_OVER = 10_000
"""Tasks that are over which somebody who writes down what happens remembers, however long it goes on."""
_OVER = (DONE, LOST, CANCELLED)
_BECOMES = {"starts": UNDER_WAY, "ends": DONE, "lost": LOST, "cancel_task": CANCELLED, "work_broken_off": OPEN}


class MissionState:
    """Robots and tasks by id, in the order in which they came, and the state of each task.

    Parameters
    ----------
    most_over
        of so many tasks that are done, lost or cancelled the first are forgotten; None: none ever is.
    """

    def __init__(self, mission: Mission, most_over: int | None = None) -> None:
        self.mission = mission
        self._most_over, self._over = most_over, deque[str]()
        self.robots: dict[str, Robot] = {robot.id: robot for robot in mission.robots}
        self.tasks: dict[str, Task] = {task.id: task for task in mission.tasks}
        self.states: dict[str, str] = dict.fromkeys(self.tasks, OPEN)

    @classmethod
    def after(cls, mission: Mission, events: Iterable[tuple[str, Mapping[str, Any]]]) -> Self:
        """The state after events, each a kind and its data."""
        mission_state = cls(mission)
        for kind, data in events:
            mission_state.take(kind, data)
        return mission_state

    def take(self, kind: str, data: Mapping[str, Any]) -> str | None:
        """Apply an event; return the id of the task or robot that is new or has changed.

        Raises
        ------
        ParameterError
            if a new robot or task is none.
        """
        if kind == "robot_joins":
            robot: Robot = self._made(Robot, data["robot"], kind)
            self.robots[robot.id] = robot
            return robot.id
        if kind == "new_task":
            task: Task = self._made(Task, data["task"], kind)
            self.tasks[task.id], self.states[task.id] = task, OPEN
            return task.id
        name = data.get("task")
        if name not in self.tasks:
            return None
        if kind == "move_task":
            place = tuple(float(value) for value in data["position"])
            self.tasks[name] = moved(self.tasks[name], place)
            return str(name)
        if kind not in _BECOMES or self.states[name] == CANCELLED:
            return None
        self.states[name] = _BECOMES[kind]
        self._forget_before(str(name))
        return str(name)

    def _forget_before(self, name: str) -> None:
        """A task may be over: then one that was so long before is forgotten, if there are too many."""
        if self._most_over is None or self.states[name] not in _OVER:
            return
        self._over.append(name)
        if len(self._over) > self._most_over:
            first = self._over.popleft()
            if self.states.get(first) in _OVER:
                del self.tasks[first], self.states[first]

    def _made(self, model: type, data: Any, kind: str) -> Any:
        """A robot or task from a mapping, or by the id of one in the mission's own events."""
        if isinstance(data, str):
            brought = [getattr(event, kind) for event in self.mission.events if getattr(event, kind) is not None]
            there = self.robots if model is Robot else self.tasks
            known = {**there, **{one.id: one for one in brought}}
            data = known.get(data, data)
        faults: list[Fault] = []
        try:
            made = Record(model, f"a {model.__name__.lower()}").read(data, (), faults)
        except MissionError as error:
            raise ParameterError(f"event {kind}: {error}") from None
        if faults:
            raise ParameterError(f"event {kind}: {faults[0].value}; expected {faults[0].expected}")
        return made
