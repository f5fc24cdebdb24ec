"""Robots and tasks at random places of a square, without limits: missions of benches and of teams of growing size."""

from __future__ import annotations

from random import Random

from muster.mission.model import Mission, Robot, Task
from muster.running.negotiation_trials.random_missions import SIDE_M, random_place


def uniform_mission(random: Random, *, robots: int, tasks: int, side_m: float = SIDE_M) -> Mission:
    """Robots r_0, r_1 ..., then tasks 0, 1 ..., in a square of that side; published figures depend on this order."""
    return Mission(
        name=f"uniform-{tasks}-{robots}",
        robots=tuple(Robot(id=f"r_{k}", position=random_place(random, side_m)) for k in range(robots)),
        tasks=tuple(Task(id=str(k), position=random_place(random, side_m)) for k in range(tasks)),
    )


def large_mission(tasks: int, robots: int, seed: int = 0) -> Mission:
    """Tasks and robots at random places of a square of 1000 m, without prerequisites."""
    return uniform_mission(Random(seed), robots=robots, tasks=tasks, side_m=1000.0)
