"""When the tasks of a plan are done, by whom, and who is at a station, as the files of other programs have it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from muster.mission.goods import Amount, by_commodity, shown_amounts
from muster.mission.model import Mission, Station, Task
from muster.mission.plan import teams_of
from muster.mission.values.time_types import moment_after
from muster.verification import Stop as TimedStop
from muster.verification import Verdict


@dataclass(frozen=True)
class Stop:
    """A robot at a task or a station, the number of it in the route, and the other robots of the task's team."""

    robot: str
    order: int
    visit: TimedStop
    others: tuple[str, ...]

    @property
    def waits_s(self) -> float:
        return self.visit.waits_s


def stops_of(verdict: Verdict) -> dict[str, tuple[Stop, ...]]:
    """For each task that is done, and each station, the stops of all robots there, in mission order."""
    visits = [(route.robot, order, stop) for route in verdict.routes for order, stop in enumerate(route.stops, 1)]
    teams = teams_of((robot, (visit.name,)) for robot, _, visit in visits if not visit.is_station)
    found: dict[str, tuple[Stop, ...]] = {}
    for robot, order, visit in visits:
        others = tuple(name for name in teams.get(visit.name, ()) if name != robot)
        found[visit.name] = (*found.get(visit.name, ()), Stop(robot, order, visit, others))
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
    return {name: value for name, value in found.items() if value is not None} | asked(task)


def asked(task: Task) -> dict[str, Any]:
    """What a task asks of time and robots, under the keys of a mission file."""
    windows = [list(window) for window in task.window_s]
    found = {
        "window_s": windows or None,
        "deadline_s": task.deadline_s,
        "due_s": task.due_s,
        "load": _load(task.load),
        "delivers": task.delivers,
        "duration_s": task.duration_s,
        "priority": None if task.priority == 1 else task.priority,
        "prerequisites": list(task.prerequisites) or None,
        "requires": list(task.requires) or None,
        "only_robots": None if task.only_robots is None else list(task.only_robots),
        "robots_needed": task.robots_needed,
    }
    return {name: value for name, value in found.items() if value is not None}


def _load(load: Amount | None) -> Any:
    """What a task takes on board: a number, or amounts in one line."""
    return shown_amounts(by_commodity(load)) if load is not None and not isinstance(load, float | int) else load


def station_properties(station: Station, stops: tuple[Stop, ...]) -> dict[str, Any]:
    """What a station does, and for each of `robots` that come there when, and what it adds to their batteries."""
    found: dict[str, Any] = {"services": list(station.services), "slots": station.slots}
    found |= {name: getattr(station, name) for name in ("charge_per_s", "swap_s") if getattr(station, name)}
    found |= {"robots": [stop.robot for stop in stops], "orders": [stop.order for stop in stops]}
    for name in ("arrives_s", "starts_s", "ends_s"):
        found[name] = [getattr(stop.visit, name) for stop in stops]
    found["waits_s"] = [stop.waits_s for stop in stops]
    return found | ({"charged": [stop.visit.charged or 0.0 for stop in stops]} if station.gives_energy else {})


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
