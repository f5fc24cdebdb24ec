"""Shortest ways by looking at all pairs of corners, in fractions and plain Python: for small maps."""

import heapq
import math
from fractions import Fraction
from itertools import combinations, pairwise

import numpy as np


def shortest(nodes, sees):
    """The length of the shortest way from nodes[0] to nodes[1]; None if there is none."""
    ways = {node: [] for node in nodes}
    for p, q in combinations(nodes, 2):
        if sees(p, q):
            ways[p].append(q)
            ways[q].append(p)
    heap, done = [(0.0, nodes[0])], set()
    while heap:
        length, node = heapq.heappop(heap)
        if node == nodes[1]:
            return length
        if node not in done:
            done.add(node)
            for other in ways[node]:
                heapq.heappush(heap, (length + math.dist(node, other), other))
    return None


def over_cells(blocked, start, end):
    """The shortest way over free cells, in cells; row 0 is the lowest."""
    rows, columns = blocked.shape

    def free(column, row):
        return 0 <= column < columns and 0 <= row < rows and not blocked[row, column]

    def around(x, y):
        return [free(x - 1, y - 1), free(x, y - 1), free(x - 1, y), free(x, y)]

    def pinched(x, y):
        low_left, low_right, high_left, high_right = around(x, y)
        return low_left == high_right != low_right == high_left

    def stands(x, y):
        across = {math.floor(x), math.ceil(x) - 1}
        return any(free(c, r) for c in across for r in (math.floor(y), math.ceil(y) - 1))

    def sees(p, q):
        step = [b - a for a, b in zip(p, q, strict=True)]
        cuts = {Fraction(0), Fraction(1)}
        for a, d in zip(p, step, strict=True):
            if d:
                low, high = sorted((a, a + d))
                cuts |= {(line - a) / d for line in range(math.ceil(low), math.floor(high) + 1)}
        cuts = sorted(cuts)
        for s in cuts[1:-1]:
            x, y = p[0] + s * step[0], p[1] + s * step[1]
            if x.denominator == y.denominator == 1 and pinched(int(x), int(y)):
                return False
        return all(stands(*(a + (s + t) / 2 * d for a, d in zip(p, step, strict=True))) for s, t in pairwise(cuts))

    lattice = [(x, y) for x in range(columns + 1) for y in range(rows + 1) if any(around(x, y))]
    ends = [tuple(map(Fraction, point)) for point in (start, end)]
    if not all(stands(*end) for end in ends):
        return None
    nodes = [(Fraction(x), Fraction(y)) for x, y in lattice if not all(around(x, y)) and not pinched(x, y)]
    return shortest([*ends, *(node for node in nodes if node not in ends)], sees)


def among_polygons(boundary, obstacles, start, end):
    """The shortest way within a boundary and outside obstacles: lists of corners, whole numbers."""

    def cross(o, a, b):
        return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0])

    def where(ring, p):
        """1 inside, 0 on the border, -1 outside."""
        inside = False
        for a, b in zip(ring, ring[1:] + ring[:1], strict=True):
            turn = cross(a, b, p)
            if turn == 0 and min(a[0], b[0]) <= p[0] <= max(a[0], b[0]) and min(a[1], b[1]) <= p[1] <= max(a[1], b[1]):
                return 0
            if (a[1] > p[1]) != (b[1] > p[1]) and (turn > 0) == (b[1] > a[1]):
                inside = not inside
        return 1 if inside else -1

    def free(p):
        return where(boundary, p) >= 0 and all(where(ring, p) <= 0 for ring in obstacles)

    sides = [side for ring in (boundary, *obstacles) for side in zip(ring, ring[1:] + ring[:1], strict=True)]

    def sees(p, q):
        cuts = {Fraction(0), Fraction(1)}
        for a, b in sides:
            from_p, from_q = cross(a, b, p), cross(a, b, q)
            if from_p != from_q:
                cuts |= {Fraction(from_p) / (from_p - from_q)} & _Between()
            else:
                cuts |= {_share(p, q, a), _share(p, q, b)} & _Between() if from_p == 0 else set()
        middles = ((s + t) / 2 for s, t in pairwise(sorted(cuts)))
        return all(free(tuple(a + t * (b - a) for a, b in zip(p, q, strict=True))) for t in middles)

    nodes = [tuple(map(Fraction, p)) for p in (start, end, *boundary, *(p for ring in obstacles for p in ring))]
    return shortest(list(dict.fromkeys(nodes)), sees)


class _Between:
    """The numbers between 0 and 1."""

    def __rand__(self, numbers):
        return {number for number in numbers if 0 < number < 1}


def _share(p, q, a):
    """Where a lies on the line through p and q."""
    axis = 0 if p[0] != q[0] else 1
    return (a[axis] - p[axis]) / (q[axis] - p[axis])


def random_cells(random, size, share):
    return random.random(size) < share


def star(random, centre, radius, corners):
    """A simple polygon around a centre, with whole numbers as corners."""
    while True:
        angles = np.sort(random.random(corners) * 2 * np.pi)
        away = radius * (0.3 + 0.7 * random.random(corners))
        points = np.round(centre + away[:, None] * np.stack([np.cos(angles), np.sin(angles)], axis=1)).astype(int)
        ring = [tuple(map(int, point)) for point in points]
        if len(set(ring)) == corners:
            return ring
