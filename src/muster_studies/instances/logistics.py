"""Transports, teams, time windows and prerequisites in one mission, of any size.

The square grows with the number of tasks and the day with the tasks of a robot, so that a task of a large mission costs
what one of a small mission does.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from random import Random

from muster.generation.generator import MOST_ROBOTS, MOST_TASKS, Generator
from muster.generation.places import random_place, rounded
from muster.mission.model import Mission, Robot, Rules, Task
from muster.mission.records import Checked, record, spec
from muster.mission.value_types import Number, Whole

_SIDE_OF_TASK_M = 10.0
"""Each task has a square of this side for itself."""
_LONGEST_TRANSPORT_M = 60.0
_WORK_S = (10, 40)
_DAY_OF_TASK_S = 90.0
"""The day lasts so long for each task of a robot, which is about twice what the task takes."""
_LEAST_DAY_S = 600.0
_WINDOW_OF_DAY = (0.1, 0.3)
_REACH = 30
"""A job waits for one of so many jobs before it."""
_CAPACITY, _MOST_LOAD = 4, 3


@record
class Logistics(Checked):
    """What missions of the family `logistics` share."""

    robots: int = spec(Whole(minimum=1, maximum=MOST_ROBOTS), "how many robots", default=6)
    tasks: int = spec(Whole(minimum=1, maximum=MOST_TASKS), "how many tasks", default=60)
    transports: float = spec(
        Number(minimum=0, maximum=1), "share of jobs that are a pickup and a delivery", default=0.4
    )
    teams: float = spec(Number(minimum=0, maximum=1), "share of jobs that need two robots at once", default=0.1)
    ordered: float = spec(Number(minimum=0, maximum=1), "share of jobs that wait for a job before them", default=0.2)
    windows: float = spec(Number(minimum=0, maximum=1), "share of the other jobs with a time window", default=0.3)


@dataclass(frozen=True)
class _Site:
    side_m: float
    day_s: float


def logistics_mission(given: Logistics, seed: int) -> Mission:
    """Jobs of one task, or of a pickup and its delivery, for robots that are there for a day."""
    draw = Random(f"logistics {seed}")
    day_s = max(_LEAST_DAY_S, _DAY_OF_TASK_S * given.tasks / given.robots)
    site = _Site(_SIDE_OF_TASK_M * math.sqrt(given.tasks), float(math.ceil(day_s)))
    team = tuple(
        Robot(
            id=f"r{k}",
            position=rounded(*random_place(draw, site.side_m)),
            load_capacity=_CAPACITY,
            available_until_s=site.day_s,
        )
        for k in range(given.robots)
    )
    work, lasts = list[Task](), list[str]()  # the last task of each job
    while len(work) < given.tasks:
        job = _job(given, site, draw, len(work), lasts)
        work += job
        lasts.append(job[-1].id)
    return Mission(name="logistics", rules=Rules(objective="makespan"), robots=team, tasks=tuple(work))


def _job(given: Logistics, site: _Site, draw: Random, number: int, lasts: list[str]) -> list[Task]:
    place = random_place(draw, site.side_m)
    waits = bool(lasts) and draw.random() < given.ordered
    window = _window(site, draw) if not waits and draw.random() < given.windows else ()
    before = (draw.choice(lasts[-_REACH:]),) if waits else ()
    kind, first = draw.random(), f"t{number}"
    has_room = number + 1 < given.tasks
    carries = kind < given.transports and has_room
    in_team = not carries and kind < given.transports + given.teams and given.robots > 1
    task = Task(
        id=first,
        position=rounded(*place),
        duration_s=draw.randint(*_WORK_S),
        window_s=window,
        prerequisites=before,
        load=draw.randint(1, _MOST_LOAD) if carries else None,
        robots_needed=2 if in_team else None,
    )
    if not carries:
        return [task]
    there = (min(site.side_m, max(0.0, x + draw.uniform(-1, 1) * _LONGEST_TRANSPORT_M)) for x in place)
    delivery = Task(id=f"t{number + 1}", position=rounded(*there), duration_s=draw.randint(*_WORK_S), delivers=first)
    return [task, delivery]


def _window(site: _Site, draw: Random) -> tuple[tuple[float, float], ...]:
    length = draw.uniform(*_WINDOW_OF_DAY) * site.day_s
    opens = draw.uniform(0.0, 0.8 * (site.day_s - length))
    return ((float(round(opens)), float(round(opens + length))),)


LOGISTICS = Generator(
    name="logistics",
    summary="transports with loads, teams, time windows and prerequisites together; the makespan counts",
    source="Muster's own tests of large missions",
    parameters=Logistics,
    make=logistics_mission,
)
