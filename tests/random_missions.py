"""Random missions with every rule that a plan can break, by seed."""

import math
from dataclasses import replace
from random import Random

from muster import Mission, Robot, Rules, Task
from muster.mission.model import TravelTable

TYPES = ("alpha", "beta")
KINDS = ("D", "E")
SKILLS = ("camera", "gripper")


def random_mission(seed, *, tasks=8, robots=3, **rules):
    """A mission in which some of the tasks can usually be done, seldom all."""
    random = Random(seed)
    spatial = random.random() < 0.2

    def point():
        return tuple(round(random.uniform(-10, 10), 2) for _ in range(3 if spatial else 2))

    def sometimes(share, value):
        return value() if random.random() < share else None

    mission_robots = [
        Robot(
            id=f"r_{k}",
            position=point(),
            type=random.choice(TYPES),
            skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
            work_capacity=sometimes(0.6, lambda: round(random.uniform(10, 60), 1)),
            speed_mps=random.choice((0.5, 1, 2)),
            efficiency=random.choice((0.8, 1)),
            end_position=sometimes(0.2, point),
            available_from_s=random.choice((0, 0, 7)),
        )
        for k in range(robots)
    ]
    mission_tasks = [
        Task(
            id=str(k),
            position=point(),
            type=random.choice(KINDS),
            actuation_cost=random.choice((0, 0, 4.5)),
            duration_s=sometimes(0.3, lambda: random.choice((0, 3.0))),
            prerequisites=tuple(str(j) for j in range(k) if random.random() < 1.2 / tasks),
            requires=tuple(skill for skill in SKILLS if random.random() < 0.2),
            priority=random.choice((1, 1, 1, 2.5)),
            only_robots=sometimes(0.1, lambda: (f"r_{random.randrange(robots)}",)),
            entry=sometimes(0.15, point),
            exit=sometimes(0.15, point),
        )
        for k in range(tasks)
    ]
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
        suitability=sometimes(0.6, lambda: suitability),
    )


def with_travel_tables(mission, seed):
    """The mission with a travel table for each robot type: no symmetry, short cuts through tasks, some ways missing.

    In half of them a metre is the least difference, so that sums tie exactly. Tables know no entries, exits or ends.
    """
    random = Random(seed)
    robots = tuple(replace(robot, end_position=None) for robot in mission.robots)
    tasks = tuple(replace(task, entry=None, exit=None) for task in mission.tasks)
    whole = random.random() < 0.5

    def metres(a, b):
        way = math.dist(a.position, b.position) * random.choice((0.1, 1, 1, 1, 1.5))
        return 0.0 if a is b else math.inf if random.random() < 0.1 else float(round(way)) if whole else way

    def table():
        places = (*robots, *tasks)
        return TravelTable(tuple(p.id for p in places), tuple(tuple(metres(a, b) for b in places) for a in places))

    return replace(
        mission,
        rules=replace(mission.rules, travel="matrix"),
        travel={kind: f"{kind}.csv" for kind in TYPES},
        travel_tables={kind: table() for kind in TYPES},
        robots=robots,
        tasks=tasks,
    )
