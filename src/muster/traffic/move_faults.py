"""A judge of sequences of single moves, by geometry; it shares no code with what makes them."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from muster.mission.values.arrays import Floats, Indices

_ROUNDING_M = 1e-9


def faults(
    points: Floats,
    edges: Indices,
    starts: Sequence[int],
    moves: Sequence[tuple[int, int]],
    radii_m: Sequence[float],
    margin_m: float,
) -> list[str]:
    """What is wrong with a sequence of moves; empty if nothing is.

    Each move is replayed while all others stand. On its edge the robot keeps both radii and the margin from each of
    them, or comes no nearer than where it begins.

    Parameters
    ----------
    points, edges
        (n, 2) metres; (m, 2) from and to.
    starts
        the point of each robot.
    moves
        (robot, edge) one after another.
    """
    found = []
    places, radii = list(starts), np.asarray(radii_m, dtype=np.float64)
    for k, (robot, edge) in enumerate(moves):
        tail, head = edges[edge]
        if places[robot] != tail:
            found.append(f"move {k}: robot {robot} stands at {places[robot]}, but edge {edge} begins at {tail}")
        standing = points[places]
        distance = distances(standing, points[tail], points[head])
        moves_away = distance > np.linalg.norm(standing - points[tail], axis=1) - _ROUNDING_M
        near = (distance < radii + radii[robot] + margin_m - _ROUNDING_M) & ~moves_away
        near[robot] = False
        found += [
            f"move {k}: robot {robot} comes within {distance[other]:.3f} m of robot {other}"
            for other in np.flatnonzero(near)
        ]
        places[robot] = int(head)
    return found


def distances(points: Floats, begin: Floats, end: Floats) -> Floats:
    """Metres from each point (n, 2) to the straight piece between two others."""
    along = end - begin
    share = np.clip((points - begin) @ along / max(float(along @ along), 1e-300), 0.0, 1.0)
    return np.asarray(np.linalg.norm(points - begin - share[:, None] * along, axis=1))
