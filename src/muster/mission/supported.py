"""What this version cannot plan and cannot judge yet: refused in one place, so that planner and judge agree."""

from __future__ import annotations

import math
from collections.abc import Iterator

from muster.mission.errors import NotSupportedError
from muster.mission.kinds import Fault, shown
from muster.mission.model import Mission, Point, Task, findings

_LARGEST_COORDINATE = 1e150  # the square of a greater one may be beyond float64


def require_supported(mission: Mission) -> None:
    """Refuse a mission that asks for more than this version can do.

    Raises
    ------
    NotSupportedError
        for actions with geometry, and numbers whose sums may overflow.
    """
    found = findings(_unsupported(mission), mission.source)
    if found:
        raise NotSupportedError(found)


def _unsupported(mission: Mission) -> Iterator[Fault]:
    for k, task in enumerate(mission.tasks):
        if task.action is not None and task.action.has_geometry:
            expected = "go-to-goal or sensor-activation; actions with geometry are not supported yet"
            yield Fault(("tasks", k, "action", "name"), shown(task.action.name), expected)
    if not math.isfinite(_bound(mission)):
        yield Fault((), "numbers too large or too small", "numbers whose sums are below 1.8e308")


def _bound(mission: Mission) -> float:
    """What no sum in any plan is above; inf where one may be beyond float64."""
    robots, tasks = mission.robots, mission.tasks
    points = [*(p for r in robots for p in (r.position, r.end_position)), *(p for t in tasks for p in _portals(t))]
    far = max(abs(c) for point in points if point is not None for c in point)
    if far > _LARGEST_COORDINATE:
        return math.inf
    tabled = [d for table in mission.travel_tables.values() for row in table.metres for d in row if math.isfinite(d)]
    metres = max([4 * far, *tabled])
    work = sum(t.actuation_cost + (t.duration_s or 0.0) + _action_s(t) for t in tasks)
    slowest = min(1.0, *(r.speed_mps for r in robots), *(r.efficiency for r in robots))
    legs = float(len(tasks) + 2 * len(robots))
    whole = (legs * metres + work) / slowest + max(r.available_from_s for r in robots)
    return whole * legs + sum(t.priority for t in tasks)


def _portals(task: Task) -> tuple[Point, ...]:
    return task.entry or task.position, task.exit or task.position


def _action_s(task: Task) -> float:
    return 0.0 if task.action is None else task.action.duration_s or 0.0
