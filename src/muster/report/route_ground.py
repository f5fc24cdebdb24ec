"""Below the routes: stems of places in the air, and arrows of prerequisites."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from muster.mission.model import Mission, Task
from muster.report.route_lines import Places
from muster.report.styles import FRAME, MOST_ARROWS, PREREQUISITE


def draw_stems(ax: Any, tops: Places, floor: float) -> None:
    """Draw thin lines from the points `(n, 3)` of a 3-D picture down to its floor, which show their position."""
    feet = tops * [1, 1, 0] + [0, 0, floor]
    rows = np.stack([tops, feet, np.full_like(tops, np.nan)], axis=1).reshape(-1, 3)
    ax.plot(*rows.T, color=FRAME, linewidth=0.6, linestyle=(0, (2, 2)), zorder=0.8, gid="stems")


def drawn_prerequisites(tasks: Iterable[Task]) -> list[tuple[str, str]]:
    """List prerequisites and their dependants, by id; none where there are too many to be drawn."""
    pairs = [(before, task.id) for task in tasks for before in task.prerequisites]
    return pairs if len(pairs) <= MOST_ARROWS else []


def draw_prerequisites(ax: Any, mission: Mission, place_of: dict[str, Places], gap: float) -> list[tuple[Any, str]]:
    """Draw arrows from prerequisites to dependants, if they are few; `gap` in points stays free at both ends.

    Returns the entry for the legend, if there is any arrow.
    """
    from matplotlib.lines import Line2D

    pairs = drawn_prerequisites(mission.tasks)
    if not pairs:
        return []
    for before, after in pairs:
        _arrow(ax, place_of[before], place_of[after], gap).set_gid(f"prerequisite-{before}-{after}")
    return [(Line2D([], [], color=PREREQUISITE, linewidth=1.0, marker=9, markersize=5), "prerequisite")]


def _arrow(ax: Any, start: Places, end: Places, gap: float) -> Any:
    if len(start) == 3:
        quiver = {"arrow_length_ratio": 0.06, "color": PREREQUISITE, "linewidth": 0.9, "zorder": 1}
        return ax.quiver(*start, *(end - start), **quiver)
    from matplotlib.patches import FancyArrowPatch

    look: dict[str, Any] = {
        "arrowstyle": "-|>",
        "mutation_scale": 7,
        "linewidth": 0.9,
        "color": PREREQUISITE,
        "zorder": 1,
    }
    arrow = FancyArrowPatch(
        (start[0], start[1]), (end[0], end[1]), shrinkA=gap, shrinkB=gap, connectionstyle="arc3,rad=0.12", **look
    )
    return ax.add_patch(arrow)
