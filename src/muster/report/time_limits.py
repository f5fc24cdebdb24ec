"""Draws the marks of a time chart: windows, deadlines, due times, lateness, and teams; clock times at its axis."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from itertools import groupby
from typing import Any

from muster.mission.model import Task
from muster.mission.values.time_types import clock_text
from muster.report.styles import ALARM, QUIET_TEXT, TEXT
from muster.report.time_chart import WORK_HEIGHT, Row
from muster.report.time_marks import DEADLINE, DUE, LATE, TEAM, WINDOW, TimeMark, time_marks

_SHADE = "#CFE3F3"
_WINDOW_HEIGHT, _LATE_HEIGHT = 0.84, 0.08
_BELOW = WORK_HEIGHT / 2 + 0.03
"""Where lateness is drawn: just below the bars of work, in rows."""

Entry = tuple[Any, str]
"""A handle of a legend and its words."""


def draw_limits(ax: Any, tasks: Iterable[Task], rows: Sequence[Row], starts_at: str | None) -> list[Entry]:
    """Draw the limits of those of these tasks that are done, and who begins tasks together; the entries of a legend.

    The axis has clock times if the mission starts at one.
    """
    marks = time_marks(tasks, rows)

    def of(kind: str) -> list[TimeMark]:
        return [mark for mark in marks if mark.kind == kind]

    entries = [
        *_draw_windows(ax, of(WINDOW)),
        *_draw_ticks(ax, of(DEADLINE), "deadline", "-"),
        *_draw_ticks(ax, of(DUE), "due time", ":"),
        *_draw_lateness(ax, of(LATE)),
        *_draw_teams(ax, of(TEAM)),
    ]
    if starts_at is not None:
        _name_clock_times(ax, starts_at)
    return entries


def _draw_windows(ax: Any, marks: Sequence[TimeMark]) -> list[Entry]:
    """Shade, in the row of the robot, each window as far as the chart reaches."""
    from matplotlib.patches import Patch

    look: dict[str, Any] = {"facecolor": _SHADE, "alpha": 0.5, "linewidth": 0, "zorder": 0.3}
    last = ax.get_xlim()[1]
    within = [mark for mark in marks if mark.from_s < last]
    for (row, task), windows in groupby(within, key=lambda mark: (mark.row, mark.task)):
        ends = [(mark.from_s, last if mark.until_s is None else min(mark.until_s, last)) for mark in windows]
        spans = [(opens, closes - opens) for opens, closes in ends]
        ax.broken_barh(spans, (row - _WINDOW_HEIGHT / 2, _WINDOW_HEIGHT), gid=f"window-{task}", **look)
    return [(Patch(facecolor=_SHADE), "time window")] if within else []


def _draw_ticks(ax: Any, marks: Sequence[TimeMark], name: str, stroke: str) -> list[Entry]:
    """Draw a stroke at each deadline, or a dotted one at each due time."""
    from matplotlib.lines import Line2D

    look: dict[str, Any] = {"color": TEXT, "linewidth": 1.2, "linestyle": stroke}
    within = [mark for mark in marks if mark.from_s <= ax.get_xlim()[1]]
    for mark in within:
        high, low = mark.row - _WINDOW_HEIGHT / 2, mark.row + _WINDOW_HEIGHT / 2
        ax.plot([mark.from_s, mark.from_s], [high, low], zorder=3.5, gid=mark.kind, **look)
    return [(Line2D([], [], **look), name)] if within else []


def _draw_lateness(ax: Any, marks: Sequence[TimeMark]) -> list[Entry]:
    """Draw a red bar from the due time of a task to its end."""
    from matplotlib.patches import Patch

    look: dict[str, Any] = {"facecolor": ALARM, "linewidth": 0, "zorder": 3.2}
    for mark in marks:
        span = (mark.from_s, (mark.until_s or mark.from_s) - mark.from_s)
        ax.broken_barh([span], (mark.row + _BELOW, _LATE_HEIGHT), gid=f"late-{mark.task}", **look)
    return [(Patch(facecolor=ALARM), "late")] if marks else []


def _draw_teams(ax: Any, marks: Sequence[TimeMark]) -> list[Entry]:
    """Link the bars of the robots that do one task together, where it begins."""
    from matplotlib.lines import Line2D

    look: dict[str, Any] = {"color": QUIET_TEXT, "linewidth": 1.6, "marker": "o", "markersize": 3}
    for mark in marks:
        ends = ([mark.from_s, mark.until_s], [mark.row, mark.to_row])
        ax.plot(*ends, zorder=3.4, gid=f"team-{mark.task}", **look)
    return [(Line2D([], [], **look), "team")] if marks else []


def _name_clock_times(ax: Any, starts_at: str) -> None:
    """Write clock times at the ticks of the axis."""
    from matplotlib.ticker import FuncFormatter

    def text(seconds: float, _: Any) -> str:
        return clock_text(seconds, starts_at) if seconds >= 0 else ""

    ax.xaxis.set_major_formatter(FuncFormatter(text))
    ax.set_xlabel("clock time")
    ax.tick_params(axis="x", labelrotation=30)
