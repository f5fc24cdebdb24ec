"""A picture of one path over a mission's map."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.model import Mission, Point
from muster.motion.grid import Grid
from muster.motion.path import NoPath, Path
from muster.report.figures.canvas import add_legend, add_title, frame_of_map, is_spatial, limits, map_axes, new_axes
from muster.report.figures.styles import robot_style
from muster.report.maps.floor import draw_map, map_corners
from muster.report.maps.route_ground import draw_stems
from muster.report.route_lines import places

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LONG_SIDE_IN = 6.6


def plot_way(
    mission: Mission, found: Path | NoPath, start: Point, goal: Point, *, facts: str, image: Grid | None = None
) -> Axes:
    """Draw a path, or the two points that none joins.

    Parameters
    ----------
    mission
        whose map is drawn.
    found, start, goal
        what was found between two points of the map frame, metres.
    facts
        a line on the path, beneath the title.
    image
        the cells of a map that is an image (`World.image`).

    Raises
    ------
    MissingExtraError
        if matplotlib is not installed.
    """
    spatial = len(start) == 3
    way = found.points if isinstance(found, Path) else places((start, goal), len(start))
    low, high = _limits(mission, way, image)
    side = _LONG_SIDE_IN
    ax: Any = new_axes(side + 2.6, side + 1.0, spatial=True) if spatial else map_axes(low, high, side)
    frame_of_map(ax, low, high)
    entries = draw_map(ax, mission.map, image, spatial=is_spatial(ax)) if mission.map is not None else []
    look = {"color": robot_style(0).color, "zorder": 3}
    if isinstance(found, Path):
        (line,) = ax.plot(*way.T, linewidth=1.8, solid_joinstyle="round", gid="path", **look)
        if spatial:
            draw_stems(ax, found.turns, float(low[2]))
        ax.plot(*found.turns[1:-1].T, linestyle="none", marker=".", markersize=4, gid="turns", **look)
        entries = [(line, f"path, {found.length_m:.2f} m"), *entries]
    ends = {"linestyle": "none", "markersize": 8, "markerfacecolor": "white", "markeredgecolor": look["color"]}
    for name, point, marker in (("start", start, "s"), ("goal", goal, "o")):
        (mark,) = ax.plot(*np.array([point]).T, marker=marker, gid=name, zorder=4, **ends)
        entries.append((mark, name))
    add_legend(ax, entries)
    add_title(ax, mission.name, [facts], "" if isinstance(found, Path) else f"no path: {found.reason}")
    return ax  # type: ignore[no-any-return]


def _limits(mission: Mission, way: Any, image: Grid | None) -> tuple[Any, Any]:
    corners = [] if mission.map is None else map_corners(mission.map, image)
    points = np.vstack([way, places(corners, way.shape[1])])
    return limits(points, 0.05, on_ground=mission.map is not None)
