"""Shortest ways found the slow way: every point sees every other or not, by code that shares nothing with Muster's."""

from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np
import shapely

SHARES = (0.5, *np.linspace(0, 1, 30)[1:-1])
"""Of the way between two points: where it is looked first whether they see each other."""


def grid_sees(blocked, a, b):
    """Between any two crossings of lines of the grid the piece is in a free cell; no crossing is a pinch."""
    a, b = ([Fraction(float(value)) for value in point] for point in (a, b))
    d = [b[0] - a[0], b[1] - a[1]]
    times = {Fraction(0), Fraction(1)}
    for axis in (0, 1):
        if d[axis]:
            low, high = sorted((a[axis], b[axis]))
            times |= {(line - a[axis]) / d[axis] for line in range(int(low), int(high) + 2) if low < line < high}
    times = sorted(times)

    def at(t):
        return [a[0] + t * d[0], a[1] + t * d[1]]

    inner = [at(t) for t in times[1:-1]]
    middles = [at((s + t) / 2) for s, t in pairwise(times)]
    return all(grid_free(blocked, point) for point in middles) and not any(pinched(blocked, point) for point in inner)


def _cell_free(blocked, column, row):
    rows, columns = blocked.shape
    return 0 <= column < columns and 0 <= row < rows and not blocked[row, column]


def _around(value):
    whole = value.numerator // value.denominator
    return (whole - 1, whole) if value == whole else (whole,)


def grid_free(blocked, point):
    x, y = (Fraction(value) for value in point)
    return any(_cell_free(blocked, column, row) for column in _around(x) for row in _around(y))


def pinched(blocked, point):
    x, y = point
    if x.denominator != 1 or y.denominator != 1:
        return False
    free = [_cell_free(blocked, int(x) + i, int(y) + j) for i, j in ((-1, -1), (0, -1), (-1, 0), (0, 0))]
    return free in ([True, False, False, True], [False, True, True, False])


def grid_lengths(blocked, places):
    """Shortest lengths between places, in cells, by way of all points of the grid."""
    rows, columns = blocked.shape
    corners = [(x, y) for x in range(columns + 1) for y in range(rows + 1)]
    corners = [p for p in corners if grid_free(blocked, p) and not pinched(blocked, [Fraction(v) for v in p])]
    return _lengths(places, corners, lambda a, b: grid_sees(blocked, a, b), lambda p: grid_free(blocked, p))


def cells_region(blocked):
    """The free cells of a grid without pinches as one region of the plane."""
    return shapely.union_all([shapely.box(x, y, x + 1, y + 1) for y, x in np.argwhere(~blocked)])


def sparse_region_lengths(region, places):
    """As `region_lengths`, faster: all pairs of vertices at once, one search for all places."""
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    nodes = np.concatenate([places, np.unique(shapely.get_coordinates(region), axis=0)])
    first, second = np.triu_indices(len(nodes), 1)
    apart = (nodes[first] != nodes[second]).any(axis=1)
    first, second = first[apart], second[apart]
    outside = shapely.box(*region.bounds).difference(region).buffer(-1e-6)
    shapely.prepare([region, outside])
    for share in SHARES:  # most pairs have a point that is outside, which is sooner found
        x, y = ((1 - share) * nodes[first] + share * nodes[second]).T
        clear = ~shapely.contains_xy(outside, x, y)
        first, second = first[clear], second[clear]
    seen = shapely.covers(region, shapely.linestrings(np.stack([nodes[first], nodes[second]], axis=1)))
    first, second = first[seen], second[seen]
    weights = np.linalg.norm(nodes[first] - nodes[second], axis=1)
    graph = csr_array((weights, (first, second)), shape=(len(nodes), len(nodes)))
    return dijkstra(graph, directed=False, indices=range(len(places)))[:, : len(places)]


def region_lengths(region, places):
    """Shortest lengths between places of a region, by way of all its vertices."""
    corners = [tuple(p) for p in np.unique(shapely.get_coordinates(region), axis=0)]
    return _lengths(
        places,
        corners,
        lambda a, b: region.covers(shapely.LineString([a, b])),
        lambda p: region.covers(shapely.Point(p)),
    )


def _lengths(places, corners, sees, free):
    from scipy.sparse import csr_array
    from scipy.sparse.csgraph import dijkstra

    nodes = [tuple(map(float, p)) for p in places] + corners
    usable = [k >= len(places) or free(p) for k, p in enumerate(nodes)]
    edges = [
        (i, j, np.hypot(nodes[i][0] - nodes[j][0], nodes[i][1] - nodes[j][1]))
        for i, j in combinations(range(len(nodes)), 2)
        if usable[i] and usable[j] and nodes[i] != nodes[j] and sees(nodes[i], nodes[j])
    ]
    # No way leads through another place.
    lengths = np.full((len(places), len(places)), np.inf)
    for i in range(len(places)):
        for j in range(len(places)):
            if not (usable[i] and usable[j]):
                continue
            if nodes[i] == nodes[j]:
                lengths[i, j] = 0.0
                continue
            kept = [e for e in edges if all(k >= len(places) or k in (i, j) for k in e[:2])]
            if not kept:
                continue
            first, second, weights = (list(column) for column in zip(*kept, strict=True))
            graph = csr_array((weights, (first, second)), shape=(len(nodes), len(nodes)))
            lengths[i, j] = dijkstra(graph, directed=False, indices=i)[j]
    return lengths
