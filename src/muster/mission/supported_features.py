"""Refuses features that this version can neither plan nor judge yet."""

from __future__ import annotations

import math
from collections.abc import Iterator

from muster.mission.errors import NotSupportedError
from muster.mission.goods import by_commodity
from muster.mission.model import Action, Mission, Point, Task
from muster.mission.records import findings
from muster.mission.value_types import Fault, shown

_LARGEST_COORDINATE = 1e150  # the square of a greater one may be beyond float64
_MOST_LANES = 10_000  # of a raster search
_STRETCH = 1e7  # an observer stands no farther away than a million times what it sees


def require_supported(mission: Mission) -> None:
    """Refuse a mission that asks for more than this version can plan and judge.

    Raises
    ------
    NotSupportedError
        for actions with geometry beside travel tables, which do not know where they begin and end; for raster searches
        of very many lanes; and for numbers whose sums may overflow.
    """
    found = findings(_unsupported(mission), mission.source)
    if found:
        raise NotSupportedError(found)


def _unsupported(mission: Mission) -> Iterator[Fault]:
    for k, task in enumerate(mission.tasks):
        action = task.action
        if action is not None and action.has_geometry and mission.travel_rule == "matrix":
            expected = "an action without geometry: travel tables know the places of robots and tasks alone"
            yield Fault(("tasks", k, "action", "name"), shown(action.name), expected)
        if action is not None and _lanes(action) > _MOST_LANES:
            expected = f"at least side_m / {_MOST_LANES}: {(action.side_m or 0.0) / _MOST_LANES:g}"
            yield Fault(("tasks", k, "action", "spacing_m"), shown(action.spacing_m), expected)
    if not math.isfinite(_bound(mission)):
        yield Fault((), "numbers too large or too small", "numbers whose sums are below 1.8e308")


def _bound(mission: Mission) -> float:
    """What no sum in any plan is above; inf where one may be beyond float64."""
    robots, tasks = mission.robots, mission.tasks
    points = [*(p for r in robots for p in (r.position, r.end_position)), *(p for t in tasks for p in _portals(t))]
    points += [station.position for station in mission.stations]
    points += [robot.camera.mount for robot in robots if robot.camera is not None]
    sizes = [(t.action.side_m, t.action.spacing_m, t.action.height_m, t.action.width_m) for t in tasks if t.action]
    points += [tuple(size for size in row if size is not None) for row in sizes]
    points += [corner for t in tasks if t.action is not None for corner in t.action.area or ()]
    points += [point for t in tasks if t.action is not None for point in t.action.places.values()]
    far = max(abs(c) for point in points if point is not None for c in point)
    far = far if mission.lanes is None else max(far, mission.lanes.farthest_m)
    stretch = _STRETCH if any(t.action is not None and t.action.has_geometry for t in tasks) else 1.0
    if far > _LARGEST_COORDINATE / stretch:
        return math.inf
    tabled = [d for table in mission.travel_tables.values() for row in table.metres for d in row if math.isfinite(d)]
    metres = max([4 * stretch * far, *tabled])
    work = sum(t.actuation_cost + (t.duration_s or 0.0) + _action_bound(t.action, metres) for t in tasks)
    slowest = min(1.0, *(r.speed_mps for r in robots), *(r.efficiency for r in robots))
    legs = float(len(tasks) + 2 * len(robots))
    whole = (legs * metres + work) / slowest + max(r.available_from_s for r in robots)
    return whole * legs + sum(t.priority for t in tasks) + _service_bound(mission) + _load_bound(mission)


def _service_bound(mission: Mission) -> float:
    """Seconds that one visit of each station takes at most, with what the batteries hold."""
    held = sum(robot.battery.capacity for robot in mission.robots if robot.battery)
    return held + sum(station.swap_s + held / (station.charge_per_s or math.inf) for station in mission.stations)


def _load_bound(mission: Mission) -> float:
    """What all amounts of goods sum to."""
    amounts = [*(t.load for t in mission.tasks), *(r.load_at_start for r in mission.robots)]
    return sum(abs(value) for amount in amounts for value in by_commodity(amount).values())


def _portals(task: Task) -> tuple[Point, ...]:
    return task.entry or task.position, task.exit or task.position


def _lanes(action: Action) -> float:
    """At most so many, or one less; as many as there may be where they follow from a camera or an area."""
    if action.area is not None:
        return _MOST_LANES
    if action.side_m is None or action.height_m is None:
        return 1.0
    return _MOST_LANES if action.spacing_m is None else action.side_m / action.spacing_m


def _action_bound(action: Action | None, metres: float) -> float:
    """Metres or seconds that an action takes at most, whose legs are no longer than so many metres."""
    if action is None:
        return 0.0
    return (action.duration_s or 0.0) + (2 * metres * (_lanes(action) + 2) if action.has_geometry else 0.0)
