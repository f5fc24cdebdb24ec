"""The areas of tasks beneath the routes: what is to be covered, and the holes in it."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from muster.mission.model import Mission, Point, Task
from muster.report.figures.styles import AREA, AREA_EDGE, FAINT, FRAME

_HOLE: dict[str, Any] = {"edgecolor": FRAME, "linewidth": 0.8}


def draw_areas(ax: Any, mission: Mission, *, spatial: bool) -> list[tuple[Any, str]]:
    """Draw each area once, however many tasks it is split into; returns its entries for the legend."""
    from matplotlib.patches import Patch, Polygon

    entries: dict[str, Any] = {}
    for k, (area, holes, cross_holes) in enumerate(areas_of(mission.tasks)):
        ground: dict[str, Any] = {"facecolor": AREA, "edgecolor": AREA_EDGE, "linewidth": 1.0}
        entries["area"] = Patch(**ground)
        if spatial:
            for ring in (area, *holes):
                ax.plot(*zip(*(*ring, ring[0]), strict=True), 0.0, color=AREA_EDGE, linewidth=1.0, gid=f"area-{k}")
            continue
        ax.add_patch(Polygon(area, zorder=0.6, gid=f"area-{k}", **ground))
        look = _HOLE | ({"facecolor": "white"} if cross_holes else {"facecolor": FAINT, "hatch": "xx"})
        for n, hole in enumerate(holes):
            ax.add_patch(Polygon(hole, zorder=0.7, gid=f"hole-{k}-{n}", **look))
            entries["not to be covered" if cross_holes else "hole, gone around"] = Patch(**look)
    return [(patch, label) for label, patch in entries.items()]


def area_corners(mission: Mission) -> list[Point]:
    """List the corners of all areas."""
    return [corner for area, _, _ in areas_of(mission.tasks) for corner in area]


def areas_of(tasks: Iterable[Task]) -> list[tuple[tuple[Point, ...], tuple[tuple[Point, ...], ...], bool]]:
    """Each area that tasks cover once, however many it is split into: corners, holes, whether holes are crossed."""
    actions = (task.action for task in tasks if task.action is not None)
    found = [(action.area, action.holes, action.cross_holes) for action in actions if action.area is not None]
    return list(dict.fromkeys(found))
