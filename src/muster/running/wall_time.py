"""The wall clock as the clock of missions that real robots carry out: when it is 0, and whether it is too late.

Time 0 of such a mission is its `starts_at`; of a mission without one, and where the start is shifted, the moment at
which the run begins. A `starts_at` without a zone is local time of this machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime

from muster.mission.errors import ParameterError
from muster.mission.model import Mission, Robot, Task
from muster.mission.system.clock import Clock, WallClock
from muster.mission.texts.counting import counted

STARTS = ("given", "now")
"""When a mission starts: as its `starts_at` says, or when the run begins, with all its times shifted."""


@dataclass(frozen=True)
class MissionStart:
    """Time 0 of a mission, by the wall clock.

    Attributes
    ----------
    mission : Mission
        The mission; its `starts_at` is that of the start that holds.
    zero_s : float
        Seconds since 1970 at which the mission's clock is 0.
    """

    mission: Mission
    zero_s: float

    @classmethod
    def of(cls, mission: Mission, starts: str = "given", clock: Clock | None = None) -> MissionStart:
        """Return the start of a mission whose run begins now.

        Raises
        ------
        ParameterError
            if `starts` is none of `STARTS`.
        """
        if starts not in STARTS:
            raise ParameterError(f"starts: {starts}; expected {' or '.join(STARTS)}")
        if starts == "given" and mission.starts_at is not None:
            return cls(mission, datetime.fromisoformat(mission.starts_at).timestamp())
        return cls.at(mission, (clock or WallClock()).now())

    @classmethod
    def at(cls, mission: Mission, zero_s: float) -> MissionStart:
        """Return the start of a mission at a time of the wall clock; its `starts_at`, if it has one, is moved there."""
        if mission.starts_at is None:
            return cls(mission, zero_s)
        zone = datetime.fromisoformat(mission.starts_at).tzinfo
        return cls(replace(mission, starts_at=datetime.fromtimestamp(zero_s, zone).isoformat()), zero_s)

    def seconds(self, clock: Clock | None = None) -> float:
        """Return the time of the mission's clock now; negative before the start."""
        return (clock or WallClock()).now() - self.zero_s


def require_time_left(mission: Mission, now_s: float) -> None:
    """Raise `ParameterError` if the time of a mission is over at a time of its clock.

    It is over when no task that has a time limit can begin any more, or all robots' shifts have ended.
    """
    if all(_has_ended(robot, now_s) for robot in mission.robots):
        over = "the shifts of all robots have ended"
    else:
        limits = {task.id: latest for task in mission.tasks if (latest := _latest_s(task)) < math.inf}
        late = [task for task, latest in limits.items() if now_s > latest]
        if not limits or len(late) < len(limits):
            return
        over = f"the time for {_some(late)} is over"
    began = "" if mission.starts_at is None else f"starts_at {mission.starts_at} was {_duration(now_s)} ago, and "
    raise ParameterError(
        f"mission {mission.name}: {began}{over}; expected a start that is not over, or its times shifted (--starts now)"
    )


def has_time_limits(mission: Mission) -> bool:
    """Return whether any task can come too late, or any shift ends."""
    ends = any(robot.available_until_s is not None for robot in mission.robots)
    return ends or any(_latest_s(task) < math.inf for task in mission.tasks)


def notes_on_start(mission: Mission, now_s: float) -> Iterator[str]:
    """Yield lines about a start that is not now: how long the run waits, or which tasks come too late."""
    if now_s < 0:
        yield f"the mission starts at {mission.starts_at}: robots wait for {_duration(-now_s)}"
    late = [task.id for task in mission.tasks if now_s > _latest_s(task)]
    if late:
        began = f"starts_at {mission.starts_at} was {_duration(now_s)} ago"
        yield f"warning: {began}: the time for {_some(late)} is over"


def planned_from(mission: Mission, now_s: float) -> Mission:
    """Return the mission for planning at a time of its clock: no robot is available before."""
    if now_s <= 0:
        return mission
    return replace(mission, robots=tuple(_available_from(robot, now_s) for robot in mission.robots))


def _available_from(robot: Robot, now_s: float) -> Robot:
    until_s = robot.available_until_s
    if robot.shifts_s:
        return robot.from_time(now_s if until_s is None else min(now_s, until_s))
    begins_s = max(robot.available_from_s, now_s)
    return replace(robot, available_from_s=begins_s if until_s is None else min(begins_s, until_s))


def _has_ended(robot: Robot, now_s: float) -> bool:
    return robot.available_until_s is not None and now_s >= robot.available_until_s


def _latest_s(task: Task) -> float:
    """The latest time at which work on a task may begin, travel and work not counted."""
    last = task.window_s[-1][1] if task.window_s else None
    return min(math.inf if last is None else last, math.inf if task.deadline_s is None else task.deadline_s)


def _some(tasks: Sequence[str]) -> str:
    return f"task {tasks[0]}" + (f" and {counted(len(tasks) - 1, 'more task')}" if len(tasks) > 1 else "")


def _duration(seconds: float) -> str:
    for unit, length in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2 * length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.0f} s"
