"""How routes are drawn: lines of travel and work, and numbered marks of tasks, as large as there is room."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.report.figures.canvas import write
from muster.report.figures.styles import DASHED, Style, robot_style
from muster.report.route_lines import RobotLines

MOST_IDS = 60
"""Tasks up to which each is named."""
MOST_NUMBERS = 200
"""Tasks up to which each bears its place in the route."""


@dataclass(frozen=True)
class Detail:
    """How much is drawn of each task: size of marks and width of lines in points, and which texts."""

    mark: float
    line: float
    numbers: bool
    ids: bool


def detail_for(tasks: int) -> Detail:
    """How much is drawn where there are so many tasks."""
    crowd = max(1.0, tasks / MOST_IDS)
    smallest, greatest = (8.0, 11.0) if tasks <= MOST_NUMBERS else (1.5, 5.5)
    return Detail(
        mark=float(np.clip(11.0 / crowd**0.5, smallest, greatest)),
        line=float(np.clip(1.8 / crowd**0.25, 0.6, 1.8)),
        numbers=tasks <= MOST_NUMBERS,
        ids=tasks <= MOST_IDS,
    )


def stroke_of(style: Style, width: float) -> dict[str, Any]:
    """Return the keywords of a line in a robot's style."""
    from matplotlib.patheffects import Normal, Stroke

    if style.stroke != "hollow":
        return {"color": style.color, "linewidth": width, "linestyle": style.stroke}
    core = [Normal(), Stroke(linewidth=0.5 * width, foreground="white")]
    return {"color": style.color, "linewidth": 1.25 * width, "linestyle": "-", "path_effects": core}


def draw_lines(ax: Any, lines: RobotLines, detail: Detail) -> None:
    """Draw travel in the robot's stroke, the leg to the end dashed, work from entry to exit dotted."""
    style, name = robot_style(lines.index), lines.robot.id
    thin = {"color": style.color, "linewidth": 0.75 * detail.line, "zorder": 2}
    if len(lines.travel):
        stroke = stroke_of(style, detail.line)
        ax.plot(*lines.travel.T, gid=f"travel-{name}", zorder=2, solid_joinstyle="round", **stroke)
    if len(lines.work):
        ax.plot(*lines.work.T, gid=f"work-{name}", linestyle=(0, (1, 1)), **thin)
    if len(lines.lanes):
        ax.plot(*lines.lanes.T, gid=f"lanes-{name}", solid_joinstyle="round", **thin)
    if len(lines.end):
        ax.plot(*lines.end.T, gid=f"end-{name}", linestyle=DASHED, **thin)
        if lines.robot.end_position is not None:
            mark = {"marker": "v", "markersize": 0.7 * detail.mark, "markerfacecolor": "white", **thin, "zorder": 3}
            ax.plot(*lines.end[-1:].T, gid=f"end-place-{name}", linestyle="none", **mark)


def draw_tasks(ax: Any, lines: RobotLines, detail: Detail) -> None:
    """Draw the tasks of a route, numbered from 1. Marks of a later robot lie wholly above those of an earlier one."""
    style, zorder = robot_style(lines.index), 3 + lines.index * 1e-5
    if not lines.tasks:
        return
    size = detail.mark * (0.88 if style.marker in "sD" else 1.0)
    edge = 0.8 if detail.numbers else 0.0
    mark = {"marker": style.marker, "markersize": size, "color": style.color, "markeredgecolor": "white"}
    ax.plot(
        *lines.positions.T, gid=f"tasks-{lines.robot.id}", linestyle="none", markeredgewidth=edge, zorder=zorder, **mark
    )
    if detail.numbers:
        look: dict[str, Any] = {"color": style.ink, "fontweight": "bold", "zorder": zorder + 0.5e-5}
        for order, task, place in zip(lines.numbers, lines.tasks, lines.positions, strict=True):
            font = detail.mark * (0.6 if order < 10 else 0.53 if order < 100 else 0.43)
            write(ax, place, str(order), gid=f"order-{task.id}", fontsize=font, **look)
