"""Random small missions in which every rule that a plan can break binds now and then."""

from __future__ import annotations

from collections.abc import Callable
from random import Random
from typing import Any, TypeVar

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Whole

T = TypeVar("T")
TYPES = ("alpha", "beta")
KINDS = ("D", "E")
SKILLS = ("camera", "gripper")


@record
class Mixed(Checked):
    """What missions of the family `mixed` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=3)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=8)


class _Draw:
    """Random values: places in a square of 20 m, sometimes in space, and values that are sometimes not there."""

    def __init__(self, seed: int) -> None:
        self.random = Random(seed)
        self._spatial = self.random.random() < 0.2

    def point(self) -> tuple[float, ...]:
        return tuple(round(self.random.uniform(-10, 10), 2) for _ in range(3 if self._spatial else 2))

    def sometimes(self, share: float, value: Callable[[], T]) -> T | None:
        return value() if self.random.random() < share else None


def mixed_mission(seed: int, *, tasks: int = 8, robots: int = 3, **rules: Any) -> Mission:
    """A mission in which some of the tasks can usually be done, seldom all; `rules` replace those drawn.

    The tests of allocators and judge are of these: they depend on the order in which numbers are drawn.
    """
    draw = _Draw(seed)
    random = draw.random
    mission_robots = [_robot(draw, k) for k in range(robots)]
    mission_tasks = [_task(draw, k, tasks, robots) for k in range(tasks)]
    suitability = {kind: {task: random.choice((0.4, 0.7, 1.0)) for task in KINDS} for kind in TYPES}
    values = {
        "objective": random.choice(("total", "max", "total+max", "average", "makespan")),
        "usage": random.choice(("distance", "distance", "time")),
        "return_to_start": random.random() < 0.4,
        "capacity_reserve": random.choice((0, 0.1)),
    }
    random.shuffle(mission_tasks)
    return Mission(
        name=f"random-{seed}",
        rules=Rules(**(values | rules)),
        robots=tuple(mission_robots),
        tasks=tuple(mission_tasks),
        suitability=draw.sometimes(0.6, lambda: suitability),
    )


def _robot(draw: _Draw, k: int) -> Robot:
    random = draw.random
    return Robot(
        id=f"r_{k}",
        position=draw.point(),
        type=random.choice(TYPES),
        skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
        work_capacity=draw.sometimes(0.6, lambda: round(random.uniform(10, 60), 1)),
        speed_mps=random.choice((0.5, 1, 2)),
        efficiency=random.choice((0.8, 1)),
        end_position=draw.sometimes(0.2, draw.point),
        available_from_s=random.choice((0, 0, 7)),
    )


def _task(draw: _Draw, k: int, tasks: int, robots: int) -> Task:
    random = draw.random
    return Task(
        id=str(k),
        position=draw.point(),
        type=random.choice(KINDS),
        actuation_cost=random.choice((0, 0, 4.5)),
        duration_s=draw.sometimes(0.3, lambda: random.choice((0, 3.0))),
        prerequisites=tuple(str(j) for j in range(k) if random.random() < 1.2 / tasks),
        requires=tuple(skill for skill in SKILLS if random.random() < 0.2),
        priority=random.choice((1, 1, 1, 2.5)),
        only_robots=draw.sometimes(0.1, lambda: (f"r_{random.randrange(robots)}",)),
        entry=draw.sometimes(0.15, draw.point),
        exit=draw.sometimes(0.15, draw.point),
    )


MIXED = Generator(
    name="mixed",
    summary="small missions in which every rule binds now and then: skills, capacity, order, priorities, ends",
    source="the missions of Muster's own tests",
    parameters=Mixed,
    make=lambda given, seed: mixed_mission(seed, tasks=given.tasks, robots=given.robots),
)
