"""The map that robots have built, over the true one: what they have not seen, and the obstacles that they saw."""

from __future__ import annotations

from typing import Any

import numpy as np

from muster.report.figures.styles import TEXT, WALL
from muster.state.explored_map import OBSTACLE, UNSEEN, ExploredMap

_HAZE = 0.35
"""Opacity of what was not seen."""


def draw_explored(ax: Any, explored: ExploredMap) -> list[tuple[Any, str]]:
    """Draw the map on axes in the plane; returns its entries for the legend."""
    from matplotlib.colors import to_rgba
    from matplotlib.patches import Patch
    from matplotlib.transforms import Affine2D

    cells = np.array(explored.rows)
    picture = np.zeros((*cells.shape, 4))
    picture[cells == UNSEEN] = to_rgba(WALL, _HAZE)
    picture[cells == OBSTACLE] = to_rgba(TEXT)
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
    return [
        (Patch(facecolor=to_rgba(WALL, _HAZE)), "not seen"),
        (Patch(facecolor=TEXT), "obstacle that was seen"),
    ]
