"""The levels of batteries over time, as lines in the rows of a time chart."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Battery, Robot, Task
from muster.report.figures.styles import FAINT, LEVEL
from muster.report.time_charts.activity_spans import TRAVEL, WORK, Span
from muster.verification import RouteFigures, Stop

if TYPE_CHECKING:
    from muster.report.record import Recording

_FULL, _EMPTY = 0.29, 0.48
"""Where a full and an empty battery are below the middle of a row, in rows: beneath the bars of work."""


@dataclass(frozen=True)
class Level:
    """What a battery holds: (seconds, share of the capacity), straight between them; and the share that stays in it."""

    points: tuple[tuple[float, float], ...]
    reserve: float = 0.0


def planned_level(route: RouteFigures, battery: Battery) -> Level | None:
    """The level over a route by the judge's figures; None where it has no schedule."""
    if not route.stops or route.stops[0].arrival_level is None:
        return None
    points = [(0.0, battery.level_at_start), (route.leaves_s, battery.level_at_start)]
    for stop in route.stops:
        points += _at_stop(stop)
    if route.back_s is not None:
        points.append((route.back_s, battery.level_at_start + route.charged - route.usage))
    return Level(tuple((at_s, level / battery.capacity) for at_s, level in points), battery.reserve)


def recorded_level(recording: Recording, robot: Robot, own: Sequence[Span]) -> Level | None:
    """The level as events and the report told it; None of a robot without a battery.

    Between two times at which it was told it falls while the robot travels, and while it does work that uses energy:
    `own` are the robot's spans. Where there is none of these it is straight.
    """
    if robot.battery is None:
        return None
    told = [(0.0, robot.battery.at_start)]
    for event in recording.events:
        charge = event.data.get("charge")
        if event.data.get("robot") == robot.id and isinstance(charge, int | float):
            told.append((event.time_s, float(charge)))
    rows = (recording.report or {}).get("robots") or ()
    last = next((row.get("charge") for row in rows if row.get("robot") == robot.id), None)
    if isinstance(last, int | float):
        told.append((recording.duration_s, float(last)))
    points = list(told[:1])
    times_s, used = _used(recording, robot, own)
    for start, end in pairwise(told):
        points += [*_falling(start, end, times_s, used), end]
    return Level(tuple(points), robot.battery.reserve)


def _used(recording: Recording, robot: Robot, own: Sequence[Span]) -> tuple[Sequence[float], Sequence[float]]:
    """What a robot had used at the ends of its spans, as nearly as these and its tasks tell: times and usages."""
    by_time = recording.mission.rules.usage == "time"
    tasks = {task.id: task for task in recording.tasks}
    times_s, used = [0.0], [0.0]
    for span in sorted(own, key=lambda span: span.from_s):
        amount = _usage(span, robot, tasks.get(span.task), by_time=by_time)
        if amount > 0 and span.from_s >= times_s[-1]:
            times_s += (span.from_s, span.until_s)
            used += (used[-1], used[-1] + amount)
    return times_s, used


def _usage(span: Span, robot: Robot, task: Task | None, *, by_time: bool) -> float:
    lasts_s = span.until_s - span.from_s
    if span.kind not in (TRAVEL, WORK):
        return 0.0
    if by_time:
        return lasts_s
    moves = span.kind == TRAVEL or (task is not None and task.action is not None and task.action.has_geometry)
    if moves:
        return lasts_s * robot.speed_mps
    return task.actuation_cost if task is not None and lasts_s > 0 else 0.0


def _falling(
    start: tuple[float, float], end: tuple[float, float], times_s: Sequence[float], used: Sequence[float]
) -> list[tuple[float, float]]:
    """The points of a fall between two that were told; none where it is straight."""
    first, last = np.interp([start[0], end[0]], times_s, used)
    if end[1] >= start[1] or last <= first:
        return []
    fall = (end[1] - start[1]) / (last - first)
    between = dict(zip(times_s, used, strict=True))
    return [
        (at_s, float(start[1] + fall * (by_then - first)))
        for at_s, by_then in between.items()
        if start[0] < at_s < end[0]
    ]


def draw_levels(ax: Any, levels: Sequence[Level | None]) -> list[tuple[Any, str]]:
    """Draw the level in each row, beneath its bars; the entries of a legend."""
    from matplotlib.lines import Line2D

    if all(level is None for level in levels):
        return []
    line: dict[str, Any] = {"color": LEVEL, "linewidth": 1.1}
    thin: dict[str, Any] = {"color": LEVEL, "linewidth": 0.5, "linestyle": (0, (2, 2))}
    for number, level in enumerate(levels):
        if level is not None and level.points:
            times, shares = zip(*level.points, strict=True)
            heights = [_height(number, share) for share in shares]
            ax.plot(times, heights, zorder=3.6, gid=f"level-{number}", **line)
            ax.fill_between(times, heights, _height(number, 0.0), color=FAINT, linewidth=0, zorder=0.6)
            if level.reserve:
                ends = (times[0], times[-1])
                ax.plot(ends, [_height(number, level.reserve)] * 2, zorder=3.5, gid=f"reserve-{number}", **thin)
    entries = [(Line2D([], [], **line), "battery, empty to full")]
    has_reserve = any(level is not None and level.reserve for level in levels)
    return [*entries, (Line2D([], [], **thin), "its reserve")] if has_reserve else entries


def _height(number: int, share: float) -> float:
    """The place of a share of the capacity in a row; rows are counted downward."""
    return number + _EMPTY + (_FULL - _EMPTY) * share


def _at_stop(stop: Stop) -> Iterator[tuple[float, float]]:
    """The level from the arrival until the end of a stop."""
    if stop.arrival_level is None or stop.level_after is None:
        return
    yield stop.arrives_s, stop.arrival_level
    yield stop.starts_s, stop.arrival_level
    yield stop.ends_s, stop.level_after
