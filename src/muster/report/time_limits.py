"""Limits of times in a time chart: windows, deadlines, due times, lateness, and teams; clock times at its axis."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterator, Sequence
from itertools import pairwise
from typing import Any

from muster.mission.model import Mission, Task
from muster.mission.time_types import clock_text
from muster.report.styles import ALARM, QUIET_TEXT, TEXT
from muster.report.time_chart import WORK_HEIGHT, Row, Work

WINDOW = "#CFE3F3"
_WINDOW_HEIGHT, _LATE_HEIGHT = 0.84, 0.08
_BELOW = WORK_HEIGHT / 2 + 0.03
"""Where lateness is drawn: just below the bars of work, in rows."""

Entry = tuple[Any, str]
"""A handle of a legend and its words."""


def draw_limits(ax: Any, mission: Mission, rows: Sequence[Row]) -> list[Entry]:
    """Draw the limits of the tasks that are done, and who begins them together; the entries of a legend."""
    done = list(_done(mission, rows))
    entries = [*_draw_windows(ax, done), *_draw_ticks(ax, done), *_draw_lateness(ax, done), *_draw_teams(ax, rows)]
    if mission.starts_at is not None:
        _name_clock_times(ax, mission.starts_at)
    return entries


def _done(mission: Mission, rows: Sequence[Row]) -> Iterator[tuple[int, Work, Task]]:
    tasks = {task.id: task for task in mission.tasks}
    for number, row in enumerate(rows):
        for work in row.work:
            if work.task in tasks:  # else it came in while the mission was carried out
                yield number, work, tasks[work.task]


def _draw_windows(ax: Any, done: Sequence[tuple[int, Work, Task]]) -> list[Entry]:
    """Shade, in the row of the robot, each window as far as the chart reaches."""
    from matplotlib.patches import Patch

    look: dict[str, Any] = {"facecolor": WINDOW, "alpha": 0.5, "linewidth": 0, "zorder": 0.3}
    last = ax.get_xlim()[1]
    for number, _, task in done:
        ends = [(opens, last if closes is None else min(closes, last)) for opens, closes in task.window_s]
        spans = [(opens, closes - opens) for opens, closes in ends if opens < last]
        if spans:
            ax.broken_barh(spans, (number - _WINDOW_HEIGHT / 2, _WINDOW_HEIGHT), gid=f"window-{task.id}", **look)
    return [(Patch(facecolor=WINDOW), "time window")] if any(task.window_s for _, _, task in done) else []


def _draw_ticks(ax: Any, done: Sequence[tuple[int, Work, Task]]) -> list[Entry]:
    """Draw a stroke at each deadline, and a dotted one at each due time."""
    from matplotlib.lines import Line2D

    entries: list[Entry] = []
    kinds = (
        ("deadline", "-", [(n, t.deadline_s) for n, _, t in done]),
        ("due", ":", [(n, t.due_s) for n, _, t in done]),
    )
    for name, stroke, all_of in kinds:
        ticks = [(number, at_s) for number, at_s in all_of if at_s is not None and at_s <= ax.get_xlim()[1]]
        look: dict[str, Any] = {"color": TEXT, "linewidth": 1.2, "linestyle": stroke}
        for number, at_s in ticks:
            high, low = number - _WINDOW_HEIGHT / 2, number + _WINDOW_HEIGHT / 2
            ax.plot([at_s, at_s], [high, low], zorder=3.5, gid=name, **look)
        if ticks:
            entries.append((Line2D([], [], **look), "due time" if name == "due" else name))
    return entries


def _draw_lateness(ax: Any, done: Sequence[tuple[int, Work, Task]]) -> list[Entry]:
    """Draw a red bar from the due time of a task to its end."""
    from matplotlib.patches import Patch

    late = [(row, work, task.due_s) for row, work, task in done if task.due_s is not None and work.ends_s > task.due_s]
    for number, work, due_s in late:
        span = [(due_s, work.ends_s - due_s)]
        ax.broken_barh(
            span, (number + _BELOW, _LATE_HEIGHT), facecolor=ALARM, linewidth=0, zorder=3.2, gid=f"late-{work.task}"
        )
    return [(Patch(facecolor=ALARM), "late")] if late else []


def _draw_teams(ax: Any, rows: Sequence[Row]) -> list[Entry]:
    """Link the bars of the robots that do one task together, where it begins."""
    from matplotlib.lines import Line2D

    members: dict[str, list[tuple[int, Work]]] = defaultdict(list)
    for number, row in enumerate(rows):
        for work in row.work:
            members[work.task].append((number, work))
    look: dict[str, Any] = {"color": QUIET_TEXT, "linewidth": 1.6, "marker": "o", "markersize": 3}
    linked = False
    for task, bars in members.items():
        for (above, work), (below, other) in pairwise(bars):
            if above != below:  # a robot may try one task again
                ax.plot([work.starts_s, other.starts_s], [above, below], zorder=3.4, gid=f"team-{task}", **look)
                linked = True
    return [(Line2D([], [], **look), "team")] if linked else []


def _name_clock_times(ax: Any, starts_at: str) -> None:
    """Write clock times at the ticks of the axis."""
    from matplotlib.ticker import FuncFormatter

    def text(seconds: float, _: Any) -> str:
        return clock_text(seconds, starts_at) if seconds >= 0 else ""

    ax.xaxis.set_major_formatter(FuncFormatter(text))
    ax.set_xlabel("clock time")
    ax.tick_params(axis="x", labelrotation=30)
