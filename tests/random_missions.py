"""Random missions with every rule that a plan can break, by seed; and the same with travel tables."""

import math
from dataclasses import replace
from random import Random

from muster.generation.mixed import KINDS, SKILLS, TYPES
from muster.generation.mixed import mixed_mission as random_mission
from muster.mission.model import TravelTable

__all__ = ["KINDS", "SKILLS", "TYPES", "random_mission", "with_travel_tables"]


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
