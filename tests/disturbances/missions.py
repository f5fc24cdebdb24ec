"""Random missions with a random script of what goes wrong and what is new, by seed."""

from dataclasses import replace
from random import Random

from muster.mission.model import DelayedTask, Event, MovedTask, Robot, Task
from tests.action_missions import able, acting, walled
from tests.random_missions import KINDS, SKILLS, TYPES, random_mission


def disturbed_mission(seed):
    """A mission of 3 to 12 tasks and 2 to 5 robots, with up to 8 events; every third one asks little of its robots.

    In half of them robots have actions to do, with cameras or without, in a quarter over a map.
    """
    random = Random(f"disturbances {seed}")
    stability = random.choice((None, None, 0, 1, 3))
    mission = random_mission(seed, tasks=random.randint(3, 12), robots=random.randint(2, 5), stability=stability)
    if seed % 3 == 0:
        mission = replace(
            mission,
            suitability=None,
            robots=tuple(replace(robot, skills=SKILLS, work_capacity=None) for robot in mission.robots),
        )
    events = tuple(_script(random, mission))
    if random.random() < 0.5:
        mission, events = _with_actions(random, mission, events)
    mission = replace(mission, events=events)
    return walled(mission, random) if random.random() < 0.25 else mission


def _with_actions(random, mission, events):
    """Actions in most tasks, those that appear too, and robots that can do some of them."""
    point = _place(random, mission)

    def changed(event):
        if event.new_task is not None:
            return replace(event, new_task=acting(event.new_task, random, point))
        if event.robot_joins is not None:
            return replace(event, robot_joins=able(event.robot_joins, random))
        return event

    robots = tuple(able(robot, random) for robot in mission.robots)
    tasks = tuple(acting(task, random, point) for task in mission.tasks)
    return replace(mission, robots=robots, tasks=tasks), tuple(map(changed, events))


def _place(random, mission):
    return lambda: tuple(round(random.uniform(-10, 10), 2) for _ in range(mission.dimensions))


def _script(random, mission):
    robots, tasks = [r.id for r in mission.robots], [t.id for t in mission.tasks]
    point = _place(random, mission)

    for at_s in sorted(round(random.uniform(0, 60), 1) for _ in range(random.randint(0, 8))):
        kind = random.choice(("fails", "silent", "returns", "joins", "new", "new", "cancel", "move", "delay"))
        robot, task = random.choice(robots), random.choice(tasks)
        if kind == "fails":
            yield Event(at_s=at_s, robot_fails=robot)
        elif kind == "silent":
            yield Event(at_s=at_s, robot_silent=robot)
            if random.random() < 0.5:  # and it is heard again, soon or late
                yield Event(at_s=at_s + random.choice((1.0, 12.0)), robot_returns=robot)
        elif kind == "returns":
            yield Event(at_s=at_s, robot_returns=robot)
        elif kind == "joins":
            robots.append(f"r_{len(robots)}")
            capacity = random.choice((None, 30.0))
            yield Event(
                at_s=at_s,
                robot_joins=Robot(
                    id=robots[-1],
                    position=point(),
                    type=random.choice(TYPES),
                    skills=SKILLS,
                    work_capacity=capacity,
                    speed_mps=random.choice((0.5, 1, 2)),
                    available_from_s=random.choice((0, at_s + 5)),
                ),
            )
        elif kind == "new":
            before = tuple(random.sample(tasks, 1)) if random.random() < 0.3 else ()
            tasks.append(str(len(tasks)))
            cost = random.choice((0, 3.0))
            new = Task(
                id=tasks[-1], position=point(), type=random.choice(KINDS), actuation_cost=cost, prerequisites=before
            )
            yield Event(at_s=at_s, new_task=new)
        elif kind == "cancel":
            yield Event(at_s=at_s, cancel_task=task)
        elif kind == "move":
            yield Event(at_s=at_s, move_task=MovedTask(task=task, position=point()))
        else:
            yield Event(at_s=at_s, delay_task=DelayedTask(task=task, by_s=random.choice((0.5, 5.0, 20.0))))
