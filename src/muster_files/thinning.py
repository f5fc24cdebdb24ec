"""Fewer way points around corners: bends that lie close together become one, on their outer side.

The shortest path around a corner has a bend every few centimetres. An autopilot slows down at each of them, and leaving
some out would cut the corner. So the segments before and after are extended to their intersection, which is farther
from the corner, and the new segments are checked for collisions.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import replace
from itertools import pairwise

from muster.execution.reports.itinerary import Itinerary, Passage
from muster.motion.port import Place

_HAIR_M = 1e-6
"""So much farther out than where they meet: pieces on the very edge of what is free are free or not by rounding."""

Clear = Callable[[Sequence[Place]], bool]
"""Whether the robot can go straight from each of some places to the next."""


def thinned(itinerary: Itinerary, tolerance_m: float, clear: Clear) -> Itinerary:
    """The itinerary with fewer bends; old and new paths are nowhere farther apart than `tolerance_m`.

    Tasks and times do not change; a robot does nothing at bends.
    """
    given = itinerary.passages
    kept, k = [given[0]], 1
    while k < len(given):
        joined, used = given[k], 1
        for run in range(2, _bends_from(given, k) + 1):
            corner = _corner(kept[-1].place, given[k : k + run], given[k + run].place, tolerance_m)
            if corner is None or not clear([kept[-1].place, corner.place, given[k + run].place]):
                break
            joined, used = corner, run
        kept.append(joined)
        k += used
    return replace(itinerary, passages=tuple(kept))


def _bends_from(passages: Sequence[Passage], first: int) -> int:
    """The number of consecutive passages that are bends."""
    k = first
    while k < len(passages) - 1 and _is_bend(*passages[k - 1 : k + 2]):
        k += 1
    return k - first


def _is_bend(before: Passage, here: Passage, after: Passage) -> bool:
    """Whether a robot neither stays, turns, is at a station, nor begins or ends a task at a passage."""
    amid = here.task is None or before.task == here.task == after.task
    return amid and here.station is None and here.stays_s == 0 and here.heading is None


def _corner(before: Place, bends: Sequence[Passage], after: Place, tolerance_m: float) -> Passage | None:
    """One bend for several, at the intersection of the segments before and after; None without one nearby."""
    first, last = bends[0], bends[-1]
    meeting = _meeting(before, first.place, last.place, after)
    if meeting is None:
        return None
    ahead, back = math.dist(first.place[:2], meeting), math.dist(meeting, last.place[:2])
    share = ahead / (ahead + back) if ahead + back else 0.5
    height = first.place[2] + share * (last.place[2] - first.place[2])
    place = (*_beyond(first.place, last.place, meeting), height)
    old, new = [bend.place for bend in bends], [before, place, after]
    if max(_away(place, old), *(_away(bend, new) for bend in old)) > tolerance_m:
        return None
    time = first.arrives_s + share * (last.arrives_s - first.arrives_s)
    return replace(first, place=place, arrives_s=time, leaves_s=time)


def _meeting(a: Place, b: Place, c: Place, d: Place) -> tuple[float, float] | None:
    """The intersection, seen from above, of the line from a through b and the line from d through c."""
    (ux, uy), (wx, wy) = (b[0] - a[0], b[1] - a[1]), (c[0] - d[0], c[1] - d[1])
    turn = ux * wy - uy * wx
    if turn == 0:
        return None
    x, y = c[0] - b[0], c[1] - b[1]
    beyond_b, beyond_c = (x * wy - y * wx) / turn, (x * uy - y * ux) / turn
    return (b[0] + beyond_b * ux, b[1] + beyond_b * uy) if min(beyond_b, beyond_c) >= 0 else None


def _beyond(b: Place, c: Place, meeting: tuple[float, float]) -> tuple[float, float]:
    """A point moved slightly away from the segment between b and c."""
    x, y = meeting[0] - (b[0] + c[0]) / 2, meeting[1] - (b[1] + c[1]) / 2
    length = math.hypot(x, y)
    return (meeting[0] + _HAIR_M * x / length, meeting[1] + _HAIR_M * y / length) if length else meeting


def _away(point: Place, line: Sequence[Place]) -> float:
    """The distance, metres, from a point to a line through places."""
    return min(_from_piece(point, a, b) for a, b in pairwise(line))


def _from_piece(point: Place, a: Place, b: Place) -> float:
    along = [q - p for p, q in zip(a, b, strict=True)]
    square = sum(c * c for c in along)
    share = sum((r - p) * c for r, p, c in zip(point, a, along, strict=True)) / square if square else 0.0
    share = min(max(share, 0.0), 1.0)
    nearest = [p + share * c for p, c in zip(a, along, strict=True)]
    return math.dist(point, nearest)
