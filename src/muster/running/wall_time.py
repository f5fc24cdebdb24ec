"""The wall clock as the clock of missions that real robots carry out: when it is 0, and whether it is too late.

Time 0 of such a mission is its `starts_at`; of a mission without one, and where the start is shifted, the moment at
which the run begins. A `starts_at` without a zone is local time of this machine.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from datetime import datetime
from typing import TYPE_CHECKING

from muster.mission.errors import ParameterError
from muster.mission.model import Mission
from muster.mission.system.clock import Clock, WallClock
from muster.mission.texts.counting import counted

if TYPE_CHECKING:
    from muster.model.under_way import UnderWay

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

    It is over when no task that has a time limit can begin any more, or all robots had to be back by now.
    """
    model = _model_of(mission)
    if all(now_s >= model.over_by_s(robot) for robot in mission.robots):
        over = "the shifts of all robots have ended"
    else:
        limits = {task.id: latest for task in mission.tasks if (latest := model.last_begin_s(task.id)) < math.inf}
        late = [task for task, latest in limits.items() if now_s > latest]
        if not limits or len(late) < len(limits):
            return
        over = f"the time for {_some(late)} is over"
    began = "" if mission.starts_at is None else f"starts_at {mission.starts_at} was {_duration(now_s)} ago, and "
    raise ParameterError(
        f"mission {mission.name}: {began}{over}; expected a start that is not over, or its times shifted (--starts now)"
    )


def has_time_limits(mission: Mission) -> bool:
    """Return whether any task can come too late, or any robot has to be back by some time."""
    model = _model_of(mission)
    limits_s = [*map(model.over_by_s, mission.robots), *(model.last_begin_s(task.id) for task in mission.tasks)]
    return min(limits_s, default=math.inf) < math.inf


def notes_on_start(mission: Mission, now_s: float) -> Iterator[str]:
    """Yield lines about a start that is not now: how long the run waits, or which tasks come too late."""
    if now_s < 0:
        yield f"the mission starts at {mission.starts_at}: robots wait for {_duration(-now_s)}"
    model = _model_of(mission)
    late = [task.id for task in mission.tasks if now_s > model.last_begin_s(task.id)]
    if late:
        began = f"starts_at {mission.starts_at} was {_duration(now_s)} ago"
        yield f"warning: {began}: the time for {_some(late)} is over"


def planned_from(mission: Mission, now_s: float) -> Mission:
    """Return the mission for planning at a time of its clock: no robot is available before."""
    if now_s <= 0:
        return mission
    model = _model_of(mission)
    until_s = [(robot, model.over_by_s(robot)) for robot in mission.robots]
    return replace(mission, robots=tuple(robot.from_time(min(now_s, by_s)) for robot, by_s in until_s))


def _model_of(mission: Mission) -> UnderWay:
    from muster.model.under_way import UnderWay  # with NumPy, without which servers know when missions start

    return UnderWay(mission, mission.tasks)


def _some(tasks: Sequence[str]) -> str:
    return f"task {tasks[0]}" + (f" and {counted(len(tasks) - 1, 'more task')}" if len(tasks) > 1 else "")


def _duration(seconds: float) -> str:
    for unit, length in (("days", 86400.0), ("hours", 3600.0), ("minutes", 60.0)):
        if seconds >= 2 * length:
            return f"{seconds / length:.1f} {unit}"
    return f"{seconds:.0f} s"
