"""The tasks that points of interest become, by the rules `found` of a mission ([tcf-thesis] 4.3, 7.3)."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import fields
from typing import Any

from muster.mission.model import Event, Found, Mission, MovedTask, Task, Work
from muster.perception.point_search import FoundPoint


class FoundTasks:
    """Names the task of each point that is found.

    Parameters
    ----------
    mission
        its `found` says what becomes of which tag.
    ground_m
        the height of points in a mission in space.
    """

    def __init__(self, mission: Mission, ground_m: float) -> None:
        self._mission, self._ground_m = mission, ground_m
        self._tasks: dict[tuple[int, int], str] = {}

    def event(self, find: FoundPoint, now: float) -> Event | None:
        """The new task of a find; of one that was found before, that its task is elsewhere; None without a rule."""
        place = self._place(find)
        task = self.task(find)
        if task is not None:
            return Event(at_s=now, move_task=MovedTask(task=task, position=place))
        rule = _rule_for(self._mission.found, find.tag)
        if rule is None:
            return None
        name = self._free_name(find)
        self._tasks[find.tag, find.number] = name
        return Event(at_s=now, new_task=task_of(rule.becomes, name, place))

    def task(self, find: FoundPoint) -> str | None:
        """The task that a find has become."""
        return self._tasks.get((find.tag, find.number))

    def tag_of(self, task: str) -> int | None:
        """The tag of the find that has become a task; None: no find has."""
        return next((tag for (tag, _), name in self._tasks.items() if name == task), None)

    def refused(self, task: str) -> None:
        """What was found did not become this task after all."""
        self._tasks = {find: name for find, name in self._tasks.items() if name != task}

    def resume(self, find: FoundPoint, task: str) -> None:
        """Take over the task that a find has become before."""
        self._tasks[find.tag, find.number] = task

    def _place(self, find: FoundPoint) -> tuple[float, ...]:
        x, y = (round(float(value), 4) for value in find.point.position[:2])
        return (x, y) if self._mission.dimensions == 2 else (x, y, self._ground_m)

    def _free_name(self, find: FoundPoint) -> str:
        taken = {task.id for task in self._mission.tasks} | {
            event.new_task.id for event in self._mission.events if event.new_task is not None
        }
        name = f"found-{find.tag}" + (f"-{find.number + 1}" if find.number else "")
        while name in taken:
            name += "'"
        return name


def task_of(work: Work, name: str, position: Sequence[float]) -> Task:
    """Work as a task at a place."""
    own: dict[str, Any] = {f.name: getattr(work, f.name) for f in fields(Work)}
    return Task(id=name, position=tuple(position), **own)


def _rule_for(rules: Sequence[Found], tag: int) -> Found | None:
    return next((rule for rule in rules if rule.tags is None or tag in rule.tags), None)
