"""Robots and tasks at random places of a square, without limits: missions of benches and of teams of growing size."""

from __future__ import annotations

from random import Random

from muster.mission.model import Mission, Robot, Task

SIDE_M = 100.0


def uniform_mission(random: Random, *, robots: int, tasks: int, side_m: float = SIDE_M) -> Mission:
    """Robots r_0, r_1 ..., then tasks 0, 1 ..., in a square of that side; published figures depend on this order."""
    return Mission(
        name=f"uniform-{tasks}-{robots}",
        robots=tuple(Robot(id=f"r_{k}", position=place(random, side_m)) for k in range(robots)),
        tasks=tuple(Task(id=str(k), position=place(random, side_m)) for k in range(tasks)),
    )


def place(random: Random, side_m: float = SIDE_M) -> tuple[float, float]:
    """A place in the square, metres."""
    return random.uniform(0, side_m), random.uniform(0, side_m)
