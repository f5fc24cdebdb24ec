"""When the tasks of a plan are done, and by whom, as the files of other programs have it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from muster.mission.model import Mission, Task
from muster.mission.plan import teams_of
from muster.mission.time_types import moment_after
from muster.verification import Verdict, Visit


@dataclass(frozen=True)
class Stop:
    """A robot's visit to a task, the number of it in the route, and the other robots of the task's team."""

    robot: str
    order: int
    visit: Visit
    others: tuple[str, ...]

    @property
    def waits_s(self) -> float:
        return self.visit.starts_s - self.visit.arrives_s


def stops_of(verdict: Verdict) -> dict[str, tuple[Stop, ...]]:
    """For each task that is done the stops of all robots that do it, in mission order."""
    visits = [(route.robot, order, visit) for route in verdict.routes for order, visit in enumerate(route.visits, 1)]
    teams = teams_of((robot, (visit.task,)) for robot, _, visit in visits)
    found: dict[str, tuple[Stop, ...]] = {}
    for robot, order, visit in visits:
        others = tuple(name for name in teams[visit.task] if name != robot)
        found[visit.task] = (*found.get(visit.task, ()), Stop(robot, order, visit, others))
    return found


def late_s(task: Task, ends_s: float) -> float | None:
    """By how much a task ends after its due time; None where it has none."""
    return None if task.due_s is None else max(0.0, ends_s - task.due_s)


def task_properties(mission: Mission, task: Task, stops: tuple[Stop, ...]) -> dict[str, Any]:
    """Who does a task and when, and what it asks of time; lists have an item for each of `robots`."""
    found: dict[str, Any] = {"robots": [stop.robot for stop in stops]}
    if stops:
        starts, ends = (max(getattr(stop.visit, name) for stop in stops) for name in ("starts_s", "ends_s"))
        found |= {
            "orders": [stop.order for stop in stops],
            "arrives_s": [stop.visit.arrives_s for stop in stops],
            "waits_s": [stop.waits_s for stop in stops],
            "starts_s": starts,
            "ends_s": ends,
            "starts_at": clock(mission, starts),
            "ends_at": clock(mission, ends),
            "late_s": late_s(task, ends),
        }
    windows = [list(window) for window in task.window_s]
    found |= {"window_s": windows or None, "deadline_s": task.deadline_s, "due_s": task.due_s}
    return {name: value for name, value in found.items() if value is not None}


def clock(mission: Mission, seconds: float) -> str | None:
    """The date and time so long after the start, by ISO 8601; None where the mission does not say when it starts."""
    if mission.starts_at is None:
        return None
    return moment_after(seconds, mission.starts_at).isoformat(timespec="milliseconds")


def utc(mission: Mission, seconds: float) -> datetime | None:
    """The same in UTC; None also where the start has no zone."""
    if mission.starts_at is None:
        return None
    moment = moment_after(seconds, mission.starts_at)
    return None if moment.tzinfo is None else moment.astimezone(UTC)
