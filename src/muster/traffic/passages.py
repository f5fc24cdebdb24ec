"""Passages for one: the stretches of a roadmap on which robots do not get past each other."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from muster.mission.values.arrays import Bools, Indices
from muster.traffic.roadmaps.roadmap import Roadmap


@dataclass(frozen=True, eq=False)
class Passage:
    """A stretch for one robot: its points, by number, and how many ways lead out of it.

    One leads out of a dead end, and none where a whole part of the roadmap has room for one alone.
    """

    points: Indices
    exits: int

    @property
    def is_dead_end(self) -> bool:
        return self.exits == 1


def passages(roadmap: Roadmap) -> tuple[Passage, ...]:
    """The passages for one of a roadmap: what hangs together of the points past which nobody gets, where it is narrow.

    What lies beyond a passage and has no room for two robots belongs to it, as the end of a dead end does.
    """
    found = (_passage(roadmap, group) for group in _groups(roadmap, roadmap.narrow & ~roadmap.passable))
    return tuple(one for one in found if one is not None)


def _groups(roadmap: Roadmap, chosen: Bools) -> list[Indices]:
    """The connected groups of the chosen points, directions aside."""
    from scipy.sparse.csgraph import connected_components

    _, group = connected_components(_links(roadmap, chosen), directed=False)
    points = np.flatnonzero(chosen)
    order = np.argsort(group[points], kind="stable")
    ends = np.flatnonzero(np.diff(group[points][order])) + 1
    return [some for some in np.split(points[order], ends) if len(some)]


def _links(roadmap: Roadmap, chosen: Bools) -> Any:
    from scipy.sparse import coo_array

    n = len(roadmap.points)
    edges = roadmap.edges[chosen[roadmap.edges].all(axis=1)]
    return coo_array((np.ones(len(edges), dtype=np.int8), edges.T), shape=(n, n)).tocsr()


def _passage(roadmap: Roadmap, points: Indices) -> Passage | None:
    """A passage from its points, with what has no room for two beyond it; exits are told apart close by.

    None for a nook that has no room for a second robot at its end, so that nobody has to get past.
    """
    inside = np.zeros(len(roadmap.points), dtype=np.bool_)
    inside[points] = True
    near = _near(roadmap, points)
    exits = 0
    for beyond in _groups(roadmap, near & ~inside):
        if not _touches(roadmap, inside, beyond):
            continue
        if _has_room_for_two(roadmap, beyond):
            exits += 1
        else:
            inside[beyond] = True
    found = np.flatnonzero(inside)
    return None if exits == 1 and not _has_room_for_two(roadmap, found) else Passage(found, exits)


def _near(roadmap: Roadmap, points: Indices) -> Bools:
    """(n,): the points that are two edges at most from some of these."""
    near = np.zeros(len(roadmap.points), dtype=np.bool_)
    near[points] = True
    for _ in range(2):
        touched = near[roadmap.edges].any(axis=1)
        near[roadmap.edges[touched]] = True
    return near


def _touches(roadmap: Roadmap, inside: Bools, beyond: Indices) -> bool:
    outside = np.zeros(len(roadmap.points), dtype=np.bool_)
    outside[beyond] = True
    ends = roadmap.edges
    return bool((inside[ends[:, 0]] & outside[ends[:, 1]] | inside[ends[:, 1]] & outside[ends[:, 0]]).any())


def _has_room_for_two(roadmap: Roadmap, points: Indices) -> bool:
    """Whether two of these points are out of each other's way."""
    layer = roadmap.layer[points[0]]
    extent, reach_m = np.ptp(roadmap.points[points], axis=0), roadmap.reaches_m[layer, layer]
    if np.hypot(*extent) < reach_m:
        return False
    gaps = roadmap.points[points[:200], None] - roadmap.points[None, points]
    return bool((np.linalg.norm(gaps, axis=2) >= reach_m).any())
