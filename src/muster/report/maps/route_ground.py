"""Below the routes: stems of places in the air, arrows of prerequisites and of what is carried where."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

import numpy as np

from muster.mission.model import Mission, Task
from muster.report.figures.styles import FRAME, MOST_ARROWS, MOST_TRANSPORTS, PREREQUISITE, TRANSPORT
from muster.report.route_lines import Places


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


def drawn_transports(tasks: Iterable[Task]) -> list[tuple[str, str]]:
    """List pick-ups and their deliveries, by id; none where there are too many to be drawn."""
    pairs = [(task.delivers, task.id) for task in tasks if task.delivers is not None]
    return pairs if len(pairs) <= MOST_TRANSPORTS else []


def draw_transports(ax: Any, mission: Mission, place_of: dict[str, Places], gap: float) -> list[tuple[Any, str]]:
    """Draw dashed arrows from pick-ups to deliveries, if they are few; returns the entry for the legend."""
    from matplotlib.lines import Line2D

    pairs = drawn_transports(mission.tasks)
    if not pairs:
        return []
    look: dict[str, Any] = {"color": TRANSPORT, "linewidth": 0.8, "linestyle": (0, (3, 2))}
    for pickup, delivery in pairs:
        arrow = _arrow(ax, place_of[pickup], place_of[delivery], gap, bend=-0.2, **look)
        arrow.set_gid(f"transport-{pickup}-{delivery}")
    return [(Line2D([], [], marker=9, markersize=5, **look), "transport")]


def _arrow(ax: Any, start: Places, end: Places, gap: float, *, bend: float = 0.12, **own: Any) -> Any:
    look: dict[str, Any] = {"color": PREREQUISITE, "linewidth": 0.9, "zorder": 1, **own}
    if len(start) == 3:
        return ax.quiver(*start, *(end - start), arrow_length_ratio=0.06, **look)
    from matplotlib.patches import FancyArrowPatch

    look |= {"arrowstyle": "-|>", "mutation_scale": 7, "connectionstyle": f"arc3,rad={bend}"}
    arrow = FancyArrowPatch((start[0], start[1]), (end[0], end[1]), shrinkA=gap, shrinkB=gap, **look)
    return ax.add_patch(arrow)
