"""The table of a plan's schedule: when each robot is at each task. Times are the judge's."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Sequence

from muster.cli.tables import number, print_table, sequence
from muster.mission.model import Mission, Task
from muster.mission.time_types import clock_text
from muster.verification import Verdict


def print_schedule(mission: Mission, verdict: Verdict) -> None:
    """Print the schedule where the mission binds tasks to times or teams; else routes say enough."""
    if verdict.makespan_s is None or not binds_times(mission):
        return
    tasks = {task.id: task for task in mission.tasks}
    members: dict[str, list[str]] = defaultdict(list)
    for route in verdict.routes:
        for visit in route.visits:
            members[visit.task].append(route.robot)
    rows = []
    for route in verdict.routes:
        for visit in route.visits:
            times = [visit.arrives_s, visit.starts_s, visit.ends_s]
            others = [robot for robot in members[visit.task] if robot != route.robot]
            due_s = tasks[visit.task].due_s
            late = max(0.0, visit.ends_s - due_s) if due_s is not None else 0.0
            spent = [number(seconds) if seconds else "" for seconds in (visit.starts_s - visit.arrives_s, late)]
            rows.append(
                [
                    route.robot,
                    visit.task,
                    *(_time(t, mission) for t in times),
                    *spent,
                    sequence(others) if others else "",
                ]
            )
    _print(rows, clock=mission.starts_at is not None)


def _print(rows: Sequence[Sequence[str]], *, clock: bool) -> None:
    """Print the rows; without lateness or teams there are no columns for them."""
    unit = "" if clock else " [s]"
    columns = [
        "robot",
        "task",
        *(f"{name}{unit}" for name in ("arrives", "begins", "ends")),
        "waits [s]",
        "late [s]",
        "with",
    ]
    used = [k for k in range(len(columns)) if k < 6 or any(row[k] for row in rows)]
    shown = [columns[k] for k in used]
    right = [name for name in shown if name not in ("robot", "task", "with")]
    print_table(shown, [[row[k] for k in used] for row in rows], title="schedule", right=right)


def _time(seconds: float, mission: Mission) -> str:
    return number(seconds) if mission.starts_at is None else clock_text(seconds, mission.starts_at)


def binds_times(mission: Mission) -> bool:
    """Whether a window, deadline, due time, shift, lag, team or a common begin is asked for, or clock times are."""
    shifts = any(robot.available_until_s is not None for robot in mission.robots)
    return mission.starts_at is not None or shifts or any(map(_binds_time, mission.tasks))


def _binds_time(task: Task) -> bool:
    limits = task.window_s or task.deadline_s is not None or task.due_s is not None
    return bool(limits or task.lags or task.is_for_team or task.starts_with)
