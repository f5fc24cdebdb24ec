"""Robots of several types that suit types of tasks to different degrees, with limited work capacity.

The form of the missions of [tcf-thesis], section 3.3: a table of suitability, tasks that cost something once there.
"""

from __future__ import annotations

from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_place, rounded
from muster.mission.model import OBJECTIVES, Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Choice, Number, Whole

_MOST_TYPES = 100


@record
class Heterogeneous(Checked):
    """What missions of the family `heterogeneous` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=6)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=30)
    robot_types: int = spec(Whole(minimum=1, maximum=_MOST_TYPES), "how many types of robots", default=3)
    task_types: int = spec(Whole(minimum=1, maximum=_MOST_TYPES), "how many types of tasks", default=4)
    skilled: float = spec(Number(minimum=0, maximum=1), "share of tasks that need a skill as well", default=0.2)
    most_cost_m: float = spec(Number(minimum=0), "actuation costs are from 0 to this", default=15.0)
    work_capacity_m: float = spec(Number(above=0), "most usage of a robot", default=300.0)
    side_m: float = spec(Number(above=0), "side of the square", default=100.0)
    objective: str = spec(Choice(OBJECTIVES), "what is minimised", default="total+max")


def heterogeneous_mission(given: Heterogeneous, seed: int) -> Mission:
    """The mission of a seed: each type of tasks suits one type of robots that the team has, at least."""
    draw = Random(seed)
    types = [f"R{k}" for k in range(min(given.robot_types, given.robots))]
    robots = tuple(
        Robot(
            id=f"r_{k}",
            type=types[k % len(types)],
            position=rounded(*random_place(draw, given.side_m)),
            work_capacity=given.work_capacity_m,
            skills=("gripper",) if k < len(types) or draw.random() < 0.5 else (),
        )
        for k in range(given.robots)
    )
    tasks = tuple(
        Task(
            id=str(k),
            type=f"T{draw.randrange(given.task_types)}",
            position=rounded(*random_place(draw, given.side_m)),
            actuation_cost=round(draw.uniform(0, given.most_cost_m), 3),
            requires=("gripper",) if draw.random() < given.skilled else (),
        )
        for k in range(given.tasks)
    )
    return Mission(
        rules=Rules(objective=given.objective),
        robots=robots,
        tasks=tasks,
        suitability=_suitability(given, types, draw),
    )


def _suitability(given: Heterogeneous, types: list[str], draw: Random) -> dict[str, dict[str, float]]:
    """Scores to the hundredth; for each type of tasks one at least with which it is assigned."""
    least = Rules().min_suitability
    table = {kind: {f"T{k}": round(draw.uniform(0.2, 1), 2) for k in range(given.task_types)} for kind in types}
    for task in range(given.task_types):
        able = draw.choice(types)
        if all(row[f"T{task}"] < least for row in table.values()):
            table[able][f"T{task}"] = round(draw.uniform(least, 1), 2)
    return table


HETEROGENEOUS = Generator(
    name="heterogeneous",
    summary="types of robots that suit types of tasks to different degrees, skills, limited work capacity",
    source="the form of the missions of [tcf-thesis], section 3.3",
    parameters=Heterogeneous,
    make=heterogeneous_mission,
)
