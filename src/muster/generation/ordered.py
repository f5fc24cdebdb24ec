"""Tasks that wait for some of those before them: a random acyclic graph of prerequisites."""

from __future__ import annotations

from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_ground
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole

_SIDE_M = 100.0


@record
class Ordered(Checked):
    """What missions of the family `ordered` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=5)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=40)
    most: int = spec(Whole(maximum=100), "a task waits for none to so many others", default=2)
    reach: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "which are among so many before it", default=100)


def ordered_mission(tasks: int, robots: int, seed: int, most: int = 2, reach: int = 100) -> Mission:
    """Tasks that each wait for at most so many of as many before them as `reach` says."""
    draw = Random(seed)
    team = tuple(Robot(id=f"r{k}", position=random_ground(draw, _SIDE_M)) for k in range(robots))
    work = tuple(
        Task(
            id=f"t{k}",
            position=random_ground(draw, _SIDE_M),
            actuation_cost=draw.choice((0.0, 2.0, 8.0, 20.0)),
            prerequisites=_before(draw, k, most, reach),
        )
        for k in range(tasks)
    )
    return Mission(name=f"ordered-{tasks}", rules=Rules(objective="makespan"), robots=team, tasks=work)


def _before(draw: Random, task: int, most: int, reach: int) -> tuple[str, ...]:
    count = min(task, reach, draw.randint(0, most))
    return tuple(f"t{j}" for j in draw.sample(range(max(0, task - reach), task), count))


ORDERED = Generator(
    name="ordered",
    summary="each task waits for some of those before it: a random acyclic graph; the makespan counts",
    source="the missions of the bench `schedules` of `muster bench`",
    parameters=Ordered,
    make=lambda given, seed: ordered_mission(given.tasks, given.robots, seed, given.most, given.reach),
)
