"""The table of a plan's schedule: when each robot is at each stop. Times, levels and loads are the judge's."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from muster.cli.tables import number, print_table, sequence
from muster.mission.goods import shown_amounts
from muster.mission.model import Mission, Task
from muster.mission.values.time_types import clock_text
from muster.verification import Stop, Verdict

_NAMES = ("robot", "task", "stop", "with", "load after")
_ALWAYS = 6  # columns: the others are there where a row has something in them


@dataclass(frozen=True)
class _Context:
    """What the rows are made from; `members` are the robots of each task."""

    mission: Mission
    unit: str
    tasks: Mapping[str, Task]
    members: Mapping[str, Sequence[str]]


def print_schedule(mission: Mission, verdict: Verdict) -> None:
    """Print the schedule where the mission binds tasks to times, teams, goods or energy; else routes say enough."""
    if verdict.makespan_s is None or not (binds_times(mission) or _carries_or_charges(mission)):
        return
    members: dict[str, list[str]] = defaultdict(list)
    for route in verdict.routes:
        for visit in route.visits:
            members[visit.task].append(route.robot)
    context = _Context(mission, verdict.usage_unit, {task.id: task for task in mission.tasks}, members)
    _print([_row(context, route.robot, stop) for route in verdict.routes for stop in route.stops], context)


def _row(context: _Context, robot: str, stop: Stop) -> list[str]:
    """The cells of a stop."""
    task = None if stop.is_station else context.tasks[stop.name]
    others = [] if task is None else [other for other in context.members[task.id] if other != robot]
    late = max(0.0, stop.ends_s - task.due_s) if task is not None and task.due_s is not None else 0.0
    spent = [number(seconds) if seconds else "" for seconds in (stop.waits_s, late)]
    times = [_time(seconds, context.mission) for seconds in (stop.arrives_s, stop.starts_s, stop.ends_s)]
    levels = ["" if value is None else number(value) for value in (stop.charged, stop.level_after)]
    load = shown_amounts(stop.load_after) if context.mission.has_goods else ""
    return [robot, stop.shown, *times, *spent, sequence(others) if others else "", *levels, load]


def _print(rows: Sequence[Sequence[str]], context: _Context) -> None:
    """Print the rows; without lateness, teams, batteries or goods there are no columns for them."""
    seconds = "" if context.mission.starts_at is not None else " [s]"
    columns = [
        "robot",
        "stop" if context.mission.stations else "task",
        *(f"{name}{seconds}" for name in ("arrives", "begins", "ends")),
        "waits [s]",
        "late [s]",
        "with",
        f"charged [{context.unit}]",
        f"level after [{context.unit}]",
        "load after",
    ]
    used = [k for k in range(len(columns)) if k < _ALWAYS or any(row[k] for row in rows)]
    shown = [columns[k] for k in used]
    right = [name for name in shown if name not in _NAMES]
    print_table(shown, [[row[k] for k in used] for row in rows], title="schedule", right=right)


def _time(seconds: float, mission: Mission) -> str:
    return number(seconds) if mission.starts_at is None else clock_text(seconds, mission.starts_at)


def _carries_or_charges(mission: Mission) -> bool:
    return bool(mission.stations) or mission.has_goods or mission.has_batteries


def binds_times(mission: Mission) -> bool:
    """Whether a window, deadline, due time, shift, lag, team or a common begin is asked for, or clock times are."""
    shifts = any(robot.available_until_s is not None for robot in mission.robots)
    return mission.starts_at is not None or shifts or any(map(_binds_time, mission.tasks))


def _binds_time(task: Task) -> bool:
    limits = task.window_s or task.deadline_s is not None or task.due_s is not None
    return bool(limits or task.lags or task.is_for_team or task.starts_with)
