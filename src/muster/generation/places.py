"""Random places."""

from __future__ import annotations

from random import Random


def random_place(random: Random, side_m: float) -> tuple[float, float]:
    """A place in a square of that side, metres."""
    return random.uniform(0, side_m), random.uniform(0, side_m)


def random_ground(random: Random, side_m: float) -> tuple[float, float, float]:
    """A place on the ground of a mission in space, in a square of that side, metres."""
    return (*random_place(random, side_m), 0.0)


def rounded(*place: float) -> tuple[float, ...]:
    """A place to the millimetre."""
    return tuple(round(coordinate, 3) for coordinate in place)
