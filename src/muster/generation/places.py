"""Random places."""

from __future__ import annotations

from random import Random


def random_place(random: Random, side_m: float) -> tuple[float, float]:
    """A place in a square of that side, metres."""
    return random.uniform(0, side_m), random.uniform(0, side_m)


def rounded(*place: float) -> tuple[float, ...]:
    """A place to the millimetre."""
    return tuple(round(coordinate, 3) for coordinate in place)
