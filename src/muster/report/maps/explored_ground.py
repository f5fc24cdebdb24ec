"""The map that robots have built, over the true one: what they have not seen, and the obstacles that they saw."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt

from muster.motion.grid import Grid
from muster.report.figures.canvas import is_spatial
from muster.report.figures.styles import TEXT, WALL
from muster.state.explored_map import OBSTACLE, UNSEEN, ExploredMap

_HAZE = 0.35
"""Opacity of what was not seen."""


def draw_explored(ax: Any, explored: ExploredMap) -> list[tuple[Any, str]]:
    """Draw the map on axes, in space on the ground at height 0; returns its entries for the legend."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Patch

    cells = np.array(explored.rows)
    colors = {UNSEEN: to_rgba(WALL, _HAZE), OBSTACLE: to_rgba(TEXT)}
    if is_spatial(ax):
        _draw_in_space(ax, explored, cells, colors)
    else:
        _draw_in_plane(ax, explored, cells, colors)
    return [
        (Patch(facecolor=colors[UNSEEN]), "not seen"),
        (Patch(facecolor=colors[OBSTACLE]), "obstacle that was seen"),
    ]


def _draw_in_plane(ax: Any, explored: ExploredMap, cells: npt.NDArray[np.int64], colors: dict[int, Any]) -> None:
    from matplotlib.transforms import Affine2D

    picture = np.zeros((*cells.shape, 4))
    for value, color in colors.items():
        picture[cells == value] = color
    x, y, yaw = explored.origin
    rows, columns = cells.shape
    extent = (0.0, columns * explored.cell_m, 0.0, rows * explored.cell_m)
    view = (ax.get_xlim(), ax.get_ylim())
    placed = Affine2D().rotate(yaw).translate(x, y) + ax.transData
    ax.imshow(
        picture, origin="lower", extent=extent, transform=placed, interpolation="nearest", zorder=2, gid="explored"
    )
    ax.set_xlim(view[0])
    ax.set_ylim(view[1])


def _draw_in_space(ax: Any, explored: ExploredMap, cells: npt.NDArray[np.int64], colors: dict[int, Any]) -> None:
    from mpl_toolkits.mplot3d.art3d import Poly3DCollection

    frame = Grid(np.zeros(cells.shape, dtype=np.bool_), explored.cell_m, explored.origin)
    for value, color in colors.items():
        faces = _faces(cells == value, frame)
        if len(faces):
            ax.add_collection3d(Poly3DCollection(faces, facecolors=[color], zorder=0.6, gid=f"explored-{value}"))


def _faces(those: npt.NDArray[np.bool_], frame: Grid) -> npt.NDArray[np.float64]:
    """Return rectangles (n, 4, 3) on the ground, metres, one a run of such cells of a row."""
    edges = np.diff(np.pad(those, ((0, 0), (1, 1))).astype(np.int8), axis=1)
    row, first = np.nonzero(edges == 1)
    last = np.nonzero(edges == -1)[1]
    corners = np.stack([(first, row), (last, row), (last, row + 1), (first, row + 1)]).transpose(2, 0, 1)
    flat = frame.to_map(corners.reshape(-1, 2).astype(np.float64)).reshape(-1, 4, 2)
    return np.concatenate([flat, np.zeros((*flat.shape[:2], 1))], axis=2)
