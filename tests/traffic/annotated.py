"""Roadmaps with their conflicts, worked out the slow way, for tests."""

from types import SimpleNamespace

import numpy as np

from muster.traffic.move_faults import distances


def annotated(points, pairs, reach_m):
    """A roadmap of edges both ways between pairs of points; near is what comes within `reach_m`."""
    points = np.asarray(points, dtype=float)
    edges = np.array(sorted({(a, b) for pair in pairs for a, b in (pair, pair[::-1])}), dtype=np.int64)
    start, near, metres = [0], [], []
    for tail, head in edges:
        distance = distances(points, points[tail], points[head])
        at_tail = np.linalg.norm(points - points[tail], axis=1)
        close = np.flatnonzero((distance < reach_m) & (distance < at_tail - 1e-9))
        near += close.tolist()
        metres += distance[close].tolist()
        start.append(len(near))
    return SimpleNamespace(
        points=points,
        edges=edges,
        reach_start=np.array(start),
        reach_point=np.array(near, dtype=np.int64),
        reach_m=np.array(metres),
        speed_mps=np.full(len(edges), np.inf),
    )


def lattice(free, spacing_m, reach_m):
    """A point in each free cell of a drawing or array, joined to those beside, above and below; and their numbers."""
    free = np.array([[cell != "#" for cell in row] for row in free]) if isinstance(free[0], str) else np.asarray(free)
    numbers = np.full(free.shape, -1)
    numbers[free] = np.arange(free.sum())
    pairs = [(a, b) for a, b in zip(numbers[:, :-1].flat, numbers[:, 1:].flat, strict=True) if a >= 0 and b >= 0]
    pairs += [(a, b) for a, b in zip(numbers[:-1].flat, numbers[1:].flat, strict=True) if a >= 0 and b >= 0]
    cells = np.argwhere(free)
    return annotated(cells[:, ::-1] * spacing_m, pairs, reach_m), numbers
