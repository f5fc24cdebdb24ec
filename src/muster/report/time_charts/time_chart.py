"""A chart of rows over time, for plans and for recorded missions: what each robot does from when until when."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence, Set
from dataclasses import dataclass
from itertools import groupby
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.stations import station_sign
from muster.report.figures.canvas import new_axes, quiet_frame, settle, shortened, write
from muster.report.figures.fonts import Names
from muster.report.figures.labels import text_size
from muster.report.figures.styles import (
    DASHED,
    GRID,
    PREREQUISITE,
    QUIET_TEXT,
    SERVICE,
    SERVICE_EDGE,
    TEXT,
    TRAFFIC,
    Style,
    robot_style,
)
from muster.report.time_charts.level_lines import Level, draw_levels

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MOST_NAMES = 300
"""Tasks up to which bars are named."""
MOST_ROWS_NAMED = 60
"""Robots up to which each row is named."""
WORK_HEIGHT, WAIT_HEIGHT, TRAFFIC_HEIGHT, TRAVEL_HEIGHT = 0.5, 0.3, 0.2, 0.1
"""Heights of the bars, in rows."""
_FONT = 6.5
_STEPS = (1, 2, 5, 10, 20, 30, 60, 120, 300, 600, 1200, 1800)
_UNITS = ((600.0, "s", 1.0), (4 * 3600.0, "min", 60.0), (float("inf"), "h", 3600.0))
"""Up to which length of a mission time is told in which unit, and the unit's seconds."""

Span = tuple[float, float]
"""From when until when, seconds."""


@dataclass(frozen=True)
class Work:
    """Work at a task: from when until when, seconds."""

    task: str
    starts_s: float
    ends_s: float


@dataclass(frozen=True)
class Service:
    """A charge, swap or unloading at a station: from when until when, seconds."""

    station: str
    starts_s: float
    ends_s: float


@dataclass(frozen=True)
class Row:
    """What one robot does; spans of travel and waiting last. `traffic` is waiting in traffic, on the way or at work."""

    robot: str
    work: tuple[Work, ...]
    travel: tuple[Span, ...]
    waiting: tuple[Span, ...]
    traffic: tuple[Span, ...] = ()
    services: tuple[Service, ...] = ()
    level: Level | None = None


@dataclass(frozen=True)
class TimeChart:
    """Rows to be drawn, and all that is drawn with them.

    Parameters
    ----------
    prerequisites
        pairs of tasks, the first of which comes before the second: arrows, where they are in different rows and obeyed.
    until_s
        how far the chart reaches, seconds.
    lines
        times to be marked, seconds, each with what it is.
    """

    rows: tuple[Row, ...]
    prerequisites: Collection[tuple[str, str]]
    until_s: float
    lines: tuple[tuple[float, str], ...]

    def draw(self, ax: Any, names: Names) -> list[tuple[Any, str]]:
        """Draw all but the title and the names of bars (`write_names`); the entries of a legend."""
        self._frame(ax, names)
        for number, row in enumerate(self.rows):
            _draw_row(ax, number, row)
        levels = draw_levels(ax, [row.level for row in self.rows])
        arrows = self._arrows()
        _draw_arrows(ax, arrows)
        for (at_s, name), style in zip(self.lines, _LINES, strict=False):
            ax.axvline(at_s, color=QUIET_TEXT, linewidth=1.0, linestyle=style, zorder=1.5, gid=name)
        return [*self._entries(has_arrows=bool(arrows)), *levels]

    def write_names(self, ax: Any, names: Names) -> None:
        """Name the bars; to be called when all that takes room is drawn, the legend too."""
        if sum(len(row.work) + len(row.services) for row in self.rows) <= MOST_NAMES:
            arrows = self._arrows()
            _name_tasks(ax, self.rows, names, {arrow.task for arrow in arrows if arrow.row < arrow.to_row})

    def _frame(self, ax: Any, names: Names) -> None:
        from matplotlib import rcParams
        from matplotlib.ticker import FuncFormatter, MultipleLocator

        last = self.until_s or 1.0
        _, unit, size = next(limit for limit in _UNITS if last <= limit[0])
        ax.set_xlim(-0.01 * last, 1.03 * last)
        ax.set_ylim(len(self.rows) - 0.4, -0.6)
        step = next((s for s in _STEPS if last / size / s <= 12), None) if unit != "s" or last > 12 else None
        if step is not None:
            ax.xaxis.set_major_locator(MultipleLocator(step * size))
        ax.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value / size:g}"))
        named = range(0, len(self.rows), -(-len(self.rows) // MOST_ROWS_NAMED) or 1)
        robots = [shortened(names.robot(self.rows[number].robot)) for number in named]
        ax.set_yticks(list(named), robots, parse_math=False, fontfamily=rcParams["font.family"])
        ax.set_xlabel(f"time [{unit}]")
        quiet_frame(ax)
        ax.grid(visible=False, axis="y")
        ax.tick_params(axis="y", length=0)

    def _arrows(self) -> list[_Arrow]:
        at = {work.task: (number, work) for number, row in enumerate(self.rows) for work in row.work}
        arrows = []
        for before, after in self.prerequisites:
            if before in at and after in at:
                (row, first), (to_row, then) = at[before], at[after]
                if row != to_row and first.ends_s <= then.starts_s:
                    arrows.append(_Arrow(row, first.ends_s, to_row, then.starts_s, before, after))
        return arrows

    def _entries(self, *, has_arrows: bool) -> list[tuple[Any, str]]:
        from matplotlib.lines import Line2D
        from matplotlib.patches import Patch

        grey = Style(QUIET_TEXT, "o", "-")
        entries: list[tuple[Any, str]] = [
            (Patch(facecolor=grey.color), "work"),
            (Line2D([], [], color=grey.color, linewidth=2.5, solid_capstyle="butt"), "travel"),
        ]
        if any(row.services for row in self.rows):
            entries.append((Patch(**_SERVICE), "[station]"))
        if any(row.waiting for row in self.rows):
            entries.append((Patch(**_waiting(grey)), "waiting"))
        if any(row.traffic for row in self.rows):
            entries.append((Patch(facecolor=TRAFFIC, edgecolor=QUIET_TEXT, linewidth=0.5), "in traffic"))
        if has_arrows:
            entries.append((Line2D([], [], color=PREREQUISITE, linewidth=1.0, marker=9, markersize=5), "prerequisite"))
        for (_, name), style in zip(self.lines, _LINES, strict=False):
            entries.append((Line2D([], [], color=QUIET_TEXT, linewidth=1.0, linestyle=style), name))
        return entries


_LINES: tuple[Any, ...] = (DASHED, ":")
"""How the lines of a chart look, in their order."""


def new_chart_axes(rows: int, *, levels: bool = False) -> Axes:
    """Make axes for so many rows: of half an inch, lower ones where there are many; with levels half as high again."""
    times = 1.5 if levels else 1.0
    return new_axes(10.0, float(np.clip(times * rows * np.clip(8.0 / rows, 0.36, 0.5) + 1.2, 2.2, times * 14.0)))


def duration(seconds: float) -> str:
    """A duration in words."""
    _, unit, size = next(limit for limit in _UNITS if seconds <= limit[0])
    return f"{seconds / size:.2f} {unit}"


def lasting(spans: Iterable[Span]) -> tuple[Span, ...]:
    """The spans with a length above 0."""
    return tuple((start, end) for start, end in spans if end > start)


def _draw_row(ax: Any, number: int, row: Row) -> None:
    style, name = robot_style(number), row.robot
    ax.axhline(number, color=GRID, linewidth=0.6, zorder=0.5)
    work = [(work.starts_s, work.ends_s) for work in row.work]
    thin = {"facecolor": style.color, "linewidth": 0, "snap": False, "zorder": 2}  # snapped to pixels it may vanish
    _bars(ax, number, row.travel, TRAVEL_HEIGHT, gid=f"travel-{name}", **thin)
    _bars(ax, number, row.waiting, WAIT_HEIGHT, gid=f"waiting-{name}", zorder=2, **_waiting(style))
    in_traffic = {"facecolor": TRAFFIC, "edgecolor": QUIET_TEXT, "linewidth": 0.5, "zorder": 3.1}
    _bars(ax, number, row.traffic, TRAFFIC_HEIGHT, gid=f"traffic-{name}", **in_traffic)
    look = {"facecolor": style.color, "edgecolor": style.color, "linewidth": 1.2, "zorder": 3}
    _bars(ax, number, work, WORK_HEIGHT, gid=f"work-{name}", **look)
    services = [(service.starts_s, service.ends_s) for service in row.services]
    _bars(ax, number, services, WORK_HEIGHT, gid=f"service-{name}", zorder=3, **_SERVICE)


def _bars(ax: Any, number: int, spans: Sequence[Span], height: float, **look: Any) -> None:
    if spans:
        lengths = [(start, end - start) for start, end in spans]
        ax.broken_barh(lengths, (number - height / 2, height), **look)


_SERVICE: dict[str, Any] = {"facecolor": SERVICE, "edgecolor": SERVICE_EDGE, "linewidth": 0.8}


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


def _draw_arrows(ax: Any, arrows: Sequence[_Arrow]) -> None:
    from matplotlib.patches import FancyArrowPatch

    look: dict[str, Any] = {"arrowstyle": "-|>", "mutation_scale": 7, "linewidth": 0.9, "color": PREREQUISITE}
    for arrow in arrows:
        half = WORK_HEIGHT / 2 * (1 if arrow.to_row > arrow.row else -1)
        start, end = (arrow.ends_s, arrow.row + half), (arrow.starts_s, arrow.to_row - half)
        patch = FancyArrowPatch(start, end, shrinkA=0, shrinkB=1, zorder=1, **look)
        patch.set_gid(f"prerequisite-{arrow.prerequisite}-{arrow.task}")
        ax.add_patch(patch)


@dataclass(frozen=True)
class _NamedBar:
    """A bar and what is written in or beside it: a station's name in brackets, or the ids of tasks."""

    starts_s: float
    ends_s: float
    text: str
    ids: tuple[str, ...]
    ink: str


def _named_bars(row: Row, names: Names, ink: str) -> list[_NamedBar]:
    """The bars of a row in the order of time; several tasks share one where they take no time and are at one place."""
    bars = []
    for (starts_s, ends_s), works in groupby(row.work, key=lambda work: (work.starts_s, work.ends_s)):
        tasks = tuple(work.task for work in works)
        bars.append(_NamedBar(starts_s, ends_s, ", ".join(map(names.task, tasks)), tasks, ink))
    for service in row.services:
        text = station_sign(names.station(service.station))
        bars.append(_NamedBar(service.starts_s, service.ends_s, text, (service.station,), TEXT))
    return sorted(bars, key=lambda bar: bar.starts_s)


def _name_tasks(ax: Any, rows: Sequence[Row], names: Names, from_above: Set[str]) -> None:
    """Write ids in bars that are long enough, else above or below them; none where there is no room.

    `from_above` are the tasks that an arrow reaches from above; they are better named below.
    """
    settle(ax)
    width, height = (float(side) * 72 / ax.figure.dpi for side in ax.get_window_extent().size)
    start, end = ax.get_xlim()
    points_per_second = width / (end - start)
    beside = height / len(rows) * WORK_HEIGHT / 2 + 0.6 * _FONT
    for number, row in enumerate(rows):
        until = {1: -np.inf, -1: -np.inf}  # where the names above and below the bars end, in points
        for bar in _named_bars(row, names, robot_style(number).ink):
            name, middle, tasks = shortened(bar.text), (bar.starts_s + bar.ends_s) / 2, bar.ids
            half = text_size(name, _FONT)[0] / 2
            look: dict[str, Any] = {"fontsize": _FONT, "zorder": 4, "gid": f"name-{tasks[0]}"}
            if (bar.ends_s - bar.starts_s) * points_per_second > 2 * half + 2:
                write(ax, (middle, number), name, color=bar.ink, fontweight="bold", **look)
                continue
            x = middle * points_per_second
            inwards = max(0.0, half - x + start * points_per_second) - max(0.0, x + half - end * points_per_second)
            x += inwards
            for side in (-1, 1) if not from_above.isdisjoint(tasks) else (1, -1):
                if until[side] < x - half - 2:
                    write(ax, (middle, number), name, (inwards, side * beside), halo=True, color=TEXT, **look)
                    until[side] = x + half
                    break
