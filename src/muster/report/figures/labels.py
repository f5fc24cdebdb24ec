"""Label placement: where to write beside points so that the text covers as little as possible.

Greedy; all in points (1/72 inch).
"""

from __future__ import annotations

from itertools import pairwise
from unicodedata import east_asian_width

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

_DIRECTIONS = np.array([(1, 0), (-1, 0), (0, 1), (0, -1), (0.8, 0.8), (-0.8, 0.8), (0.8, -0.8), (-0.8, -0.8)])
_FARTHER = 4.0
_LINE, _MARK, _OUTSIDE, _ORDER = 1.0, 8.0, 1000.0, 0.3


def text_size(text: str, font_size: float) -> tuple[float, float]:
    """Estimate how wide and high a line of text is, in the unit of `font_size`."""
    columns = sum(2 if east_asian_width(c) in "WF" else 1 for c in text)
    return 0.62 * font_size * max(columns, 1), 0.85 * font_size


def line_obstacles(lines: Array, step: float = 3.0) -> Array:
    """Turn polylines `(n, 2)`, parted by NaN, into obstacles `(m, 3)`: x, y, weight, one every `step`."""
    rows = [np.empty((0, 2))]
    for start, end in pairwise(lines):
        length = float(np.hypot(*(end - start)))
        if np.isfinite(length):
            shares = np.linspace(0.0, 1.0, 2 + int(length / step))[:, None]
            rows.append(start + shares * (end - start))
    points = np.vstack(rows)
    return np.column_stack([points, np.full(len(points), _LINE)])


def dot_obstacles(places: Array, step: float = 3.0) -> Array:
    """Turn places `(n, 2)` that lie close together, such as the cells of a wall, into obstacles `(m, 3)`."""
    points = np.unique(np.round(places / step), axis=0) * step
    return np.column_stack([points, np.full(len(points), _LINE)])


def mark_obstacles(centres: Array, radius: float) -> Array:
    """Turn marks `(n, 2)` of a radius into obstacles `(9 n, 3)`: x, y, weight."""
    grid = np.array([(x, y) for x in (-1, 0, 1) for y in (-1, 0, 1)]) * radius * 0.75
    points = (centres[:, None, :] + grid[None, :, :]).reshape(-1, 2)
    return np.column_stack([points, np.full(len(points), _MARK)])


def place_labels(anchors: Array, sizes: Array, gap: float, obstacles: Array, bounds: Array) -> Array:
    """Find offsets of the labels' centres from their anchors.

    Parameters
    ----------
    anchors, sizes
        `(n, 2)`: the points to be named, and width and height of their labels; earlier ones choose first.
    gap
        least distance between an anchor and its label.
    obstacles
        `(m, 3)`: x, y and weight of what should not be covered.
    bounds
        `(2, 2)`: lower left and upper right corner of the picture.
    """
    offsets = np.empty_like(anchors)
    for k, (anchor, size) in enumerate(zip(anchors, sizes, strict=True)):
        candidates = np.vstack([_DIRECTIONS * (gap + more + size / 2) for more in (0.0, _FARTHER)])
        costs = [_cost(anchor + offset, size / 2, obstacles, bounds) for offset in candidates]
        offsets[k] = candidates[int(np.argmin(costs + _ORDER * np.arange(len(costs))))]
        corners = (anchor + offsets[k]) + np.array(
            [(x, y) for x in (-1, -0.5, 0, 0.5, 1) for y in (-1, 0, 1)]
        ) * size / 2
        obstacles = np.vstack([obstacles, np.column_stack([corners, np.full(len(corners), _MARK)])])
    return offsets


def _cost(centre: Array, half: Array, obstacles: Array, bounds: Array) -> float:
    """Sum up what a label covers: the weights of the obstacles within it, and much for leaving the picture."""
    covered = np.all(np.abs(obstacles[:, :2] - centre) <= half + 0.5, axis=1)
    outside = bool(np.any(centre - half < bounds[0]) or np.any(centre + half > bounds[1]))
    return float(obstacles[covered, 2].sum()) + _OUTSIDE * outside
