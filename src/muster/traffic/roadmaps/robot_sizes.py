"""Sizes of robots: radii for which one layer of a roadmap serves, since their free spaces are alike."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from itertools import pairwise

import numpy as np

from muster.motion.free_space import GridSpace, PolygonSpace

MOST_SIZES = 6
"""So many layers at most have radii that other layers serve as well."""
_LIKE = 1.25
"""A layer serves robots that are smaller by this factor at most."""


def sizes(radii_m: Iterable[float], alike: Callable[[float, float], bool]) -> tuple[float, ...]:
    """The radii above 0 for which layers are made, in order: each radius has one that is as wide, or a little wider.

    Each has its own, unless there are many: then those go whose next wider one has a free space `alike`.
    """
    found = sorted({radius for radius in radii_m if radius > 0})
    while len(found) > MOST_SIZES:
        factors = [wider / radius for radius, wider in pairwise(found)]
        spare = [k for k in np.argsort(factors, kind="stable") if factors[k] <= _LIKE]
        gone = next((int(k) for k in spare if alike(found[k], found[k + 1])), None)
        if gone is None:
            break
        del found[gone]
    return tuple(found)


def same_ways(space: GridSpace | PolygonSpace, wider: GridSpace | PolygonSpace) -> bool:
    """Whether the free space of a wider robot leads to the same rooms by the same gaps, closing none of them."""
    if isinstance(space, GridSpace) and isinstance(wider, GridSpace):
        return _same_cells(space, wider)
    assert isinstance(space, PolygonSpace)
    assert isinstance(wider, PolygonSpace)
    import shapely

    parts, within = shapely.get_parts(space.region), shapely.get_parts(wider.region)
    if len(parts) != len(within):
        return False
    inside = shapely.STRtree(parts).query(shapely.point_on_surface(within), predicate="intersects")[1]
    if len(np.unique(inside)) != len(parts):
        return False
    order = np.argsort(inside)
    return bool((shapely.get_num_interior_rings(within)[order] == shapely.get_num_interior_rings(parts)).all())


def _same_cells(space: GridSpace, wider: GridSpace) -> bool:
    from scipy.ndimage import label

    if space.grid.shape != wider.grid.shape:
        return False
    parts, count = label(~space.grid.blocked)
    within, count_within = label(~wider.grid.blocked)
    pairs = np.unique(np.stack([parts[within > 0], within[within > 0]]), axis=1)
    if not count == count_within == pairs.shape[1] == len(np.unique(pairs[0])):
        return False
    corners = np.ones((3, 3), dtype=np.int64)
    return bool(label(space.grid.blocked, corners)[1] == label(wider.grid.blocked, corners)[1])
