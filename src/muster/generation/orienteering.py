"""More tasks than the team can do, each worth something: team orienteering in the manner of [chao1996]."""

from __future__ import annotations

from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_place, rounded
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Number, Whole


@record
class Orienteering(Checked):
    """What missions of the family `orienteering` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=3)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=40)
    limit_m: float = spec(Number(above=0), "work capacity of a robot: the longest route", default=180.0)
    most_priority: int = spec(Whole(minimum=1, maximum=1_000_000), "priorities are from 1 to this", default=10)
    side_m: float = spec(Number(above=0), "side of the square", default=100.0)


def orienteering_mission(given: Orienteering, seed: int) -> Mission:
    """The mission of a seed: robots go from the middle of the western side to that of the eastern."""
    draw, middle = Random(seed), given.side_m / 2
    return Mission(
        rules=Rules(objective="total"),
        robots=tuple(
            Robot(
                id=f"r_{k}",
                position=(0.0, middle),
                end_position=(given.side_m, middle),
                work_capacity=given.limit_m,
            )
            for k in range(given.robots)
        ),
        tasks=tuple(
            Task(
                id=str(k),
                position=rounded(*random_place(draw, given.side_m)),
                priority=draw.randint(1, given.most_priority),
            )
            for k in range(given.tasks)
        ),
    )


ORIENTEERING = Generator(
    name="orienteering",
    summary="more tasks than the robots can do, with priorities; a limit on each route",
    source="team orienteering [chao1996], at random places",
    parameters=Orienteering,
    make=orienteering_mission,
)
