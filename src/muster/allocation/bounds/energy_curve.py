"""How much energy a robot can have at most, by when it is at a place: exact, or above what is true, never below.

A curve is a list of points (time, energy). It is concave, rises from point to point, and is constant after the last
one: who is filled longer is there later. Before the first point the robot cannot be there.
"""

from __future__ import annotations

import itertools
from bisect import bisect_right
from collections.abc import Sequence

Curve = Sequence[tuple[float, float]]


def energy_at(curve: Curve, time: float) -> float:
    """Return the energy at a time that is not before the first point."""
    after = bisect_right(curve, time, key=lambda point: point[0])
    if after == 0:
        return curve[0][1]
    if after == len(curve):
        return curve[-1][1]
    (low, energy), (high, more) = curve[after - 1], curve[after]
    return energy + (more - energy) * (time - low) / (high - low)


def moved(curve: Curve, seconds: float, energy: float) -> list[tuple[float, float]]:
    """Return the curve once so much time and energy is gone."""
    return [(time + seconds, level - energy) for time, level in curve]


def with_at_least(curve: Curve, energy: float) -> list[tuple[float, float]]:
    """Return the part with at least so much energy; nothing where there is never so much."""
    if not curve or curve[-1][1] < energy:
        return []
    kept = [point for point in curve if point[1] >= energy]
    if len(kept) < len(curve):
        (low, level), (high, more) = curve[-len(kept) - 1], kept[0]
        kept.insert(0, (low + (high - low) * (energy - level) / (more - level), energy))
    return kept


def begun(curve: Curve, opens: float, closes: float) -> list[tuple[float, float]]:
    """Return the part within a span: the robot waits for its begin, and goes on filling until then."""
    if not curve or max(opens, curve[0][0]) > closes:
        return []
    first = max(opens, curve[0][0])
    inside = [(time, energy) for time, energy in curve if first < time < closes]
    last = [(closes, energy_at(curve, closes))] if first < closes and closes < curve[-1][0] else []
    return [(first, energy_at(curve, first)), *inside, *last]


def filled_partly(curve: Curve, rate: float, full: float) -> list[tuple[float, float]]:
    """Return the curve once a robot was filled for any length of time."""
    kept = [curve[0]]
    for (low, energy), (high, more) in itertools.pairwise(curve):
        if more - energy <= rate * (high - low):
            break
        kept.append((high, more))
    time, level = kept[-1]
    return kept if level >= full else [*kept, (time + (full - level) / rate, full)]


def filled_up(curve: Curve, rate: float, full: float) -> list[tuple[float, float]]:
    """Return the curve once a robot was filled until there is no more room."""
    return [(min(time + max(0.0, full - level) / rate for time, level in curve), full)]


def covers(curve: Curve, other: Curve) -> bool:
    """Whether there is at least as much energy as on the other curve at all times."""
    return curve[0][0] <= other[0][0] and all(energy_at(curve, time) >= energy for time, energy in other)
