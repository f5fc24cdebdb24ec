"""Robots and tasks at random places of a square, without limits: missions of benches and of teams of growing size."""

from __future__ import annotations

from dataclasses import replace
from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_place
from muster.mission.model import OBJECTIVES, Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Flag, Number, Whole

SIDE_M = 100.0


@record
class Uniform(Checked):
    """What missions of the family `uniform` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=5)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=20)
    side_m: float = spec(Number(above=0), "side of the square", default=SIDE_M)
    objective: str = spec(Choice(OBJECTIVES), "what is minimised", default="total+max")
    return_to_start: bool = spec(Flag(), "robots go back to their start", default=False)


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


def _make(given: Uniform, seed: int) -> Mission:
    made = uniform_mission(Random(seed), robots=given.robots, tasks=given.tasks, side_m=given.side_m)
    return replace(made, rules=Rules(objective=given.objective, return_to_start=given.return_to_start))


UNIFORM = Generator(
    name="uniform",
    summary="robots and tasks at random places of a square; nothing limits them",
    source="the missions of `muster bench scale` and of the table `large` of `muster bench peers`, with side 1000 m",
    parameters=Uniform,
    make=_make,
)
