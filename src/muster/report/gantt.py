"""A plan over time: a row for each robot."""

from __future__ import annotations

from collections.abc import Iterable, Sequence, Set
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.errors import MusterError
from muster.mission.model import Mission
from muster.report.canvas import (
    add_legend,
    add_title,
    alarm_of,
    new_axes,
    note_entries,
    quiet_frame,
    settle,
    shortened,
    write,
)
from muster.report.fonts import Names
from muster.report.ground import drawn_prerequisites
from muster.report.labels import text_size
from muster.report.styles import DASHED, GRID, PREREQUISITE, QUIET_TEXT, TEXT, Style, robot_style
from muster.verification import RouteFigures, Verdict, Visit

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_NAMES = 300
"""Tasks up to which bars are named."""
MOST_ROWS_NAMED = 60
"""Robots up to which each row is named."""
WORK_HEIGHT, WAIT_HEIGHT, TRAVEL_HEIGHT = 0.5, 0.3, 0.1
"""Heights of the bars, in rows."""
_FONT = 6.5
_STEPS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800)
_UNITS = ((600.0, "s", 1.0), (4 * 3600.0, "min", 60.0), (float("inf"), "h", 3600.0))
"""Up to which length of a mission time is told in which unit, and the unit's seconds."""

Span = tuple[float, float]


def plot_gantt(mission: Mission, verdict: Verdict, *, ax: Axes | None = None) -> Axes:
    """Draw when each robot travels, works and waits.

    A row for each robot, in mission order from the top, in the colours of `plot_routes`. Work is a high bar with the
    task's id, and a stroke where it takes no time; travel a thin bar; waiting a hatched one. The data is in seconds;
    the labels of a long mission are in minutes or hours.

    Raises
    ------
    MusterError
        if the plan deadlocks: it has no schedule.
    MissingExtraError
        if matplotlib is not installed.
    """
    if verdict.makespan_s is None:
        raise MusterError("no schedule to draw: in this plan tasks wait for each other for ever; see muster verify")
    if ax is None:
        ax = new_axes(10.0, _height_in(len(mission.robots)))
    names = Names(mission)
    with names.fonts():
        _draw(ax, mission, verdict, names)
    return ax


def _draw(ax: Any, mission: Mission, verdict: Verdict, names: Names) -> None:
    _frame(ax, mission, verdict, names)
    for row, route in enumerate(verdict.routes):
        _draw_row(ax, row, route)
    arrows = _arrows(mission, verdict)
    _draw_arrows(ax, arrows)
    _draw_makespan(ax, verdict.makespan_s or 0.0)
    add_title(ax, names.title(mission.name), _facts(verdict), alarm_of(verdict))
    add_legend(ax, [*_entries(verdict, has_arrows=bool(arrows)), *note_entries(names)])
    if sum(len(route.visits) for route in verdict.routes) <= MOST_NAMES:
        _name_tasks(ax, verdict, names, {arrow.task for arrow in arrows if arrow.row < arrow.to_row})


def _height_in(rows: int) -> float:
    """Return the height of the figure: rows of half an inch, lower ones where there are many."""
    return float(np.clip(rows * np.clip(8.0 / rows, 0.36, 0.5) + 1.2, 2.2, 14.0))


def _facts(verdict: Verdict) -> list[str]:
    return [
        f"makespan {_duration(verdict.makespan_s or 0.0)}",
        f"tasks {verdict.tasks_completed}/{verdict.tasks_total}",
    ]


def _duration(seconds: float) -> str:
    _, unit, size = next(limit for limit in _UNITS if seconds <= limit[0])
    return f"{seconds / size:.2f} {unit}"


def travel_spans(route: RouteFigures) -> list[Span]:
    """Find when the robot travels: from and until, seconds; the way to where its route ends included."""
    leaves = [route.leaves_s, *(visit.ends_s for visit in route.visits)]
    arrives = [visit.arrives_s for visit in route.visits]
    if route.back_s is not None:
        arrives.append(route.back_s)
    return _lasting(zip(leaves, arrives, strict=False))


def waiting_spans(route: RouteFigures) -> list[Span]:
    """Find when the robot waits at a task: from and until, seconds."""
    return _lasting((visit.arrives_s, visit.starts_s) for visit in route.visits)


def _lasting(spans: Iterable[Span]) -> list[Span]:
    return [(start, end) for start, end in spans if end > start]


def _frame(ax: Any, mission: Mission, verdict: Verdict, names: Names) -> None:
    from matplotlib import rcParams
    from matplotlib.ticker import FuncFormatter, MultipleLocator

    rows = len(mission.robots)
    last = max([verdict.makespan_s or 0.0, *(route.back_s or 0.0 for route in verdict.routes)]) or 1.0
    _, unit, size = next(limit for limit in _UNITS if last <= limit[0])
    ax.set_xlim(-0.01 * last, 1.03 * last)
    ax.set_ylim(rows - 0.4, -0.6)
    step = next((s for s in _STEPS if last / size / s <= 12), None) if unit != "s" or last > 12 else None
    if step is not None:
        ax.xaxis.set_major_locator(MultipleLocator(step * size))
    ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:g}"))
    named = range(0, rows, -(-rows // MOST_ROWS_NAMED))
    robots = [shortened(names.robot(mission.robots[row].id)) for row in named]
    ax.set_yticks(list(named), robots, parse_math=False, fontfamily=rcParams["font.family"])
    ax.set_xlabel(f"time [{unit}]")
    quiet_frame(ax)
    ax.grid(visible=False, axis="y")
    ax.tick_params(axis="y", length=0)


def _draw_row(ax: Any, row: int, route: RouteFigures) -> None:
    style, name = robot_style(row), route.robot
    ax.axhline(row, color=GRID, linewidth=0.6, zorder=0.5)
    work = [(visit.starts_s, visit.ends_s) for visit in route.visits]
    thin = {"facecolor": style.color, "linewidth": 0, "snap": False, "zorder": 2}  # snapped to pixels it may vanish
    _bars(ax, row, travel_spans(route), TRAVEL_HEIGHT, gid=f"travel-{name}", **thin)
    _bars(ax, row, waiting_spans(route), WAIT_HEIGHT, gid=f"waiting-{name}", zorder=2, **_waiting(style))
    look = {"facecolor": style.color, "edgecolor": style.color, "linewidth": 1.2, "zorder": 3}
    _bars(ax, row, work, WORK_HEIGHT, gid=f"work-{name}", **look)


def _bars(ax: Any, row: int, spans: Sequence[Span], height: float, **look: Any) -> None:
    if spans:
        lengths = [(start, end - start) for start, end in spans]
        ax.broken_barh(lengths, (row - height / 2, height), **look)


def _waiting(style: Style) -> dict[str, Any]:
    return {"facecolor": "white", "edgecolor": style.color, "hatch": "//////", "linewidth": 0.7}


@dataclass(frozen=True)
class _Arrow:
    """From the end of a prerequisite, in a row at a time in seconds, to the start of a task that waits for it."""

    row: int
    ends_s: float
    to_row: int
    starts_s: float
    prerequisite: str
    task: str


def _arrows(mission: Mission, verdict: Verdict) -> list[_Arrow]:
    """Find the prerequisites to be drawn: between rows, obeyed, and not too many."""
    at: dict[str, tuple[int, Visit]] = {v.task: (row, v) for row, r in enumerate(verdict.routes) for v in r.visits}
    arrows = []
    for before, after in drawn_prerequisites(mission):
        if before in at and after in at:
            (row, first), (to_row, then) = at[before], at[after]
            if row != to_row and first.ends_s <= then.starts_s:
                arrows.append(_Arrow(row, first.ends_s, to_row, then.starts_s, before, after))
    return arrows


def _draw_arrows(ax: Any, arrows: Sequence[_Arrow]) -> None:
    from matplotlib.patches import FancyArrowPatch

    look: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 7, "linewidth": 0.9, "color": PREREQUISITE}
    for arrow in arrows:
        half = WORK_HEIGHT / 2 * (1 if arrow.to_row > arrow.row else -1)
        start, end = (arrow.ends_s, arrow.row + half), (arrow.starts_s, arrow.to_row - half)
        patch = FancyArrowPatch(start, end, shrinkA=0, shrinkB=1, zorder=1, **look)
        patch.set_gid(f"prerequisite-{arrow.prerequisite}-{arrow.task}")
        ax.add_patch(patch)


def _draw_makespan(ax: Any, makespan_s: float) -> None:
    ax.axvline(makespan_s, color=QUIET_TEXT, linewidth=1.0, linestyle=DASHED, zorder=1.5, gid="makespan")


def _entries(verdict: Verdict, *, has_arrows: bool) -> list[tuple[Any, str]]:
    from matplotlib.lines import Line2D
    from matplotlib.patches import Patch

    grey = Style(QUIET_TEXT, "o", "-")
    entries: list[tuple[Any, str]] = [
        (Patch(facecolor=grey.color), "work"),
        (Line2D([], [], color=grey.color, linewidth=2.5, solid_capstyle="butt"), "travel"),
    ]
    if any(waiting_spans(route) for route in verdict.routes):
        entries.append((Patch(**_waiting(grey)), "waiting"))
    if has_arrows:
        entries.append((Line2D([], [], color=PREREQUISITE, linewidth=1.0, marker=9, markersize=5), "prerequisite"))
    entries.append((Line2D([], [], color=QUIET_TEXT, linewidth=1.0, linestyle=DASHED), "makespan"))
    return entries


def _name_tasks(ax: Any, verdict: Verdict, names: Names, from_above: Set[str]) -> None:
    """Write ids in bars that are long enough, else above or below them; none where there is no room.

    `from_above` are the tasks that an arrow reaches from above; they are better named below.
    """
    settle(ax)
    width, height = (float(side) * 72 / ax.figure.dpi for side in ax.get_window_extent().size)
    start, end = ax.get_xlim()
    points_per_second = width / (end - start)
    beside = height / len(verdict.routes) * WORK_HEIGHT / 2 + 0.6 * _FONT
    for row, route in enumerate(verdict.routes):
        until = {1: -np.inf, -1: -np.inf}  # where the names above and below the bars end, in points
        for (starts_s, ends_s), visits in groupby(route.visits, key=lambda visit: (visit.starts_s, visit.ends_s)):
            tasks = [visit.task for visit in visits]  # several where they take no time and are at one place
            name, middle = shortened(", ".join(map(names.task, tasks))), (starts_s + ends_s) / 2
            half = text_size(name, _FONT)[0] / 2
            look: dict[str, Any] = {"fontsize": _FONT, "zorder": 4, "gid": f"name-{tasks[0]}"}
            if (ends_s - starts_s) * points_per_second > 2 * half + 2:
                write(ax, (middle, row), name, color=robot_style(row).ink, fontweight="bold", **look)
                continue
            x = middle * points_per_second
            for side in (-1, 1) if not from_above.isdisjoint(tasks) else (1, -1):
                if until[side] < x - half - 2:
                    write(ax, (middle, row), name, (0, side * beside), halo=True, color=TEXT, **look)
                    until[side] = x + half
                    break
