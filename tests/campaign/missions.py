"""The missions of the campaign, by seed: `random_mission` with more rules and more shapes."""

from dataclasses import dataclass, replace
from random import Random

from muster import Mission
from tests.action_missions import able, acting, walled
from tests.random_missions import random_mission, with_travel_tables

SMALL = 5  # tasks, up to which every plan is looked at


@dataclass(frozen=True)
class Case:
    """A mission, and whether it is small enough for all plans to be looked at."""

    mission: Mission
    small: bool

    @property
    def rounding(self):
        """By how much, relative, judge and planner may differ."""
        if self.mission.travel_rule != "map":
            return 1e-9
        return 1e-6 if self.mission.dimensions == 2 else 1e-2


def case(seed):
    """The mission of a seed."""
    random = Random(f"campaign {seed}")
    small = random.random() < 0.4
    tasks = random.randint(1, SMALL) if small else random.choice((random.randint(6, 12), random.randint(13, 30)))
    robots = random.randint(1, 2 if tasks == SMALL else 3) if small else random.randint(1, 6)
    mission = random_mission(seed, tasks=tasks, robots=robots, min_suitability=random.choice((0.4, 0.65, 1.0)))
    if random.random() < 0.6:
        mission = forgiving(mission)
    if random.random() < 0.3:
        mission = with_chain(mission, random)
    if random.random() < 0.3:
        mission = with_own_ends(mission, random)
    if random.random() < 0.3:
        return Case(with_travel_tables(mission, seed), small)
    if random.random() < 0.5:
        mission = with_actions(mission, random)
    if random.random() < 0.3:
        mission = walled(mission, random)
    return Case(mission, small)


def forgiving(mission):
    """The mission without suitability and skills, so that all tasks can often be done."""
    tasks = tuple(replace(task, requires=()) for task in mission.tasks)
    return replace(mission, suitability=None, tasks=tasks)


def with_chain(mission, random):
    """The mission with tasks that wait for each other in a row, most of them locked to one robot after the other."""
    order = sorted(mission.tasks, key=lambda task: int(task.id))  # as prerequisites go, so that there is no circle
    chain = sorted(random.sample(range(len(order)), random.randint(1, min(6, len(order)))))
    for number, k in enumerate(chain):
        before = (order[chain[number - 1]].id,) if number else ()
        robot = mission.robots[number % len(mission.robots)].id
        order[k] = replace(
            order[k],
            prerequisites=tuple(dict.fromkeys((*order[k].prerequisites, *before))),
            only_robots=(robot,) if random.random() < 0.7 else order[k].only_robots,
        )
    by_id = {task.id: task for task in order}
    return replace(mission, tasks=tuple(by_id[task.id] for task in mission.tasks))


def with_actions(mission, random):
    """The mission with an action in two of three tasks, and robots that can do some of them."""

    def place():
        return tuple(round(random.uniform(-10, 10), 2) for _ in range(mission.dimensions))

    robots = tuple(able(robot, random) for robot in mission.robots)
    return replace(mission, robots=robots, tasks=tuple(acting(task, random, place) for task in mission.tasks))


def with_own_ends(mission, random):
    """The mission in which robots go back to their start, or not, whatever its rule says."""
    robots = tuple(replace(robot, return_to_start=random.choice((None, True, False))) for robot in mission.robots)
    return replace(mission, robots=robots)
