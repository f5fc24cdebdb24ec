"""A picture of joint paths: the graph, and the way of each robot from its start to its goal."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from muster.mission.values.arrays import Floats, Indices
from muster.report.figures.canvas import add_legend, add_title, limits, map_axes
from muster.report.figures.styles import robot_style

if TYPE_CHECKING:
    from matplotlib.axes import Axes

_LONG_SIDE_IN = 6.6


def plot_joint_paths(
    places: Floats, edges: Sequence[tuple[int, int]], vertices: Indices, name: str, facts: str
) -> Axes:
    """Draw the ways of robots over the edges of their graph.

    Parameters
    ----------
    places : Floats
        (n, 2), where each vertex is.
    edges : Sequence[tuple[int, int]]
        The vertices that each edge joins.
    vertices : Indices
        (steps + 1, robots), the vertex of each robot.
    name, facts : str
        The title, and a line beneath it.

    Raises
    ------
    MissingExtraError
        If matplotlib is not installed.
    """
    ax: Any
    low, high = limits(places, 0.05, on_ground=True)
    ax = map_axes(low, high, _LONG_SIDE_IN)
    both = places[np.asarray(edges, dtype=np.int64).reshape(-1, 2)]
    gaps = np.full((len(both), 1, 2), np.nan)
    lines = np.concatenate([both, gaps], axis=1).reshape(-1, 2)
    (grid,) = ax.plot(*lines.T, color="0.85", linewidth=0.8, zorder=1, gid="edges")
    entries = [(grid, "edges")]
    for robot, way in enumerate(vertices.T):
        ax.plot(*places[way].T, color=robot_style(robot).color, linewidth=1.0, alpha=0.7, zorder=2)
    for what, row, marker in (("starts", vertices[0], "s"), ("goals", vertices[-1], "o")):
        (marks,) = ax.plot(
            *places[row].T, linestyle="none", marker=marker, markersize=3, color="black", zorder=3, gid=what
        )
        entries.append((marks, what))
    add_legend(ax, entries)
    add_title(ax, name, [facts], "")
    return ax  # type: ignore[no-any-return]
