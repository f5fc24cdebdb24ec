"""The events of a mission file: failures, new tasks and other changes at given times."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from muster.mission.records import Checked, Record, record, spec, specified
from muster.mission.robots import Robot
from muster.mission.site import IN_DEGREES, Point
from muster.mission.tasks import Task
from muster.mission.value_types import Fault, JsonSchema, Number, Position, Text, shown


@record
class MovedTask(Checked):
    task: str = spec(Text(), "id of the task")
    position: Point = spec(Position(), "where it is from then on", instead=IN_DEGREES)


@record
class MovedRobot(Checked):
    robot: str = spec(Text(), "id of the robot")
    position: Point = spec(Position(), "where somebody has put it", instead=IN_DEGREES)


@record
class DelayedTask(Checked):
    task: str = spec(Text(), "id of the task")
    by_s: float = spec(Number(minimum=0), "how much longer it takes")


@record
class Event(Checked):
    """Something that happens while the mission is carried out: a time, and exactly one of the others."""

    at_s: float = spec(Number(minimum=0), "when")
    robot_fails: str | None = spec(Text(), "id of the robot", default=None)
    robot_silent: str | None = spec(Text(), "id of the robot", default=None)
    robot_returns: str | None = spec(Text(), "id of the robot", default=None)
    robot_removed: str | None = spec(Text(), "id of the robot that somebody takes away", default=None)
    robot_moved: MovedRobot | None = spec(Record(MovedRobot, "a robot and its position"), "who is moved", default=None)
    robot_joins: Robot | None = spec(Record(Robot, "a robot"), "the robot", default=None)
    new_task: Task | None = spec(Record(Task, "a task"), "the task", default=None)
    cancel_task: str | None = spec(Text(), "id of the task", default=None)
    move_task: MovedTask | None = spec(Record(MovedTask, "a task and its position"), "what moves", default=None)
    delay_task: DelayedTask | None = spec(Record(DelayedTask, "a task and its delay"), "what is late", default=None)
    door_closes: str | None = spec(Text(), "id of the zone or lane that is closed from then on", default=None)
    door_opens: str | None = spec(Text(), "id of the zone or lane that is open from then on", default=None)

    station_fails: str | None = spec(Text(), "id of the station that serves nobody from then on", default=None)
    station_returns: str | None = spec(Text(), "id of the station that serves again from then on", default=None)

    @property
    def door(self) -> str | None:
        """The door that closes or opens."""
        return self.door_opens if self.door_closes is None else self.door_closes

    @classmethod
    def cross_check(cls, values: Mapping[str, Any]) -> Iterable[Fault]:
        names = [f.name for f in specified(cls) if f.name != "at_s"]
        given = [name for name in names if values.get(name) is not None]
        if len(given) != 1:
            yield Fault((), ", ".join(given) or "no happening", f"exactly one of {', '.join(names)}")
        action = None if values.get("new_task") is None else values["new_task"].action
        if action is not None and action.split is not None and action.part is None:
            expected = "part beside it: what comes later is one task"
            yield Fault(("new_task", "action", "split"), shown(action.split), expected)

    @classmethod
    def schema_extra(cls) -> JsonSchema:
        return {"minProperties": 2, "maxProperties": 2}
