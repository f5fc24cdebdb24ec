"""Random missions with rules about time and teams, and what happens in them, by seed."""

from random import Random

from muster import Mission, Robot, Task
from muster.mission.model import DelayedTask, Event, Lag, TeamPart

SKILLS = ("gripper", "camera")


def mission_of(seed):
    """A mission of 2 to 5 robots and 3 to 9 tasks with up to six events; its tasks are in an order that can be kept."""
    random = Random(f"timed {seed}")
    robots = tuple(_robot(k, random) for k in range(random.randint(2, 5)))
    tasks = []
    for k in range(random.randint(3, 9)):
        tasks.append(_task(str(k), tasks, random))
    names = [robot.id for robot in robots]
    events = tuple(_event(k, names, [task.id for task in tasks], random) for k in range(random.randint(1, 6)))
    return Mission(robots=robots, tasks=tuple(tasks), events=events)


def _place(random):
    return random.uniform(-15, 15), random.uniform(-15, 15)


def _robot(k, random):
    return Robot(
        id=f"r_{k}",
        type=random.choice(("rover", "drone")),
        position=_place(random),
        skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
        abilities={"lift_kg": random.choice((10.0, 20.0))},
        efficiency=random.choice((0.5, 1.0, 1.0)),
        return_to_start=random.random() < 0.3,
        available_until_s=random.uniform(80, 300) if random.random() < 0.2 else None,
    )


def _task(name, before, random):
    keys = {"position": _place(random), "duration_s": random.uniform(1, 20)}
    if random.random() < 0.4:
        first = random.uniform(0, 80)
        keys["window_s"] = ((first, first + random.uniform(5, 60)),)
        if random.random() < 0.5:
            again = keys["window_s"][0][1] + random.uniform(5, 60)
            keys["window_s"] += ((again, random.choice((None, again + 40))),)
    if random.random() < 0.2:
        keys["deadline_s"] = random.uniform(40, 200)
    if random.random() < 0.2:
        keys["due_s"] = random.uniform(10, 100)
    if before and random.random() < 0.4:
        other = random.choice(before).id
        lag = Lag(after_s=random.choice((0.0, 8.0)), within_s=random.choice((None, 10.0, 40.0)))
        keys |= {"prerequisites": (other,), "lags": {other: lag} if lag != Lag() else {}}
    keys |= random.choice(({}, {}, _team(random)))
    keys |= random.choice(({}, {}, {}, _relation([] if "prerequisites" in keys else before, random)))
    return Task(id=name, **keys)


def _team(random):
    part = TeamPart(count=1, requires=(random.choice(SKILLS),))
    needs = {"lift_kg": random.choice((15.0, 30.0, 45.0))}
    several = {"robots_needed": random.randint(2, 3)}
    return random.choice((several, {"team": (TeamPart(count=1), part)}, {"needs": needs}))


def _relation(before, random):
    free = [task.id for task in before if not (task.starts_with or task.prerequisites)]
    if not free:
        return {}
    return {random.choice(("same_robot_as", "other_robot_than", "starts_with")): (random.choice(free),)}


def _event(k, robots, tasks, random):
    at_s, robot, task = random.uniform(1, 90), random.choice(robots), random.choice(tasks)
    happens = random.choice(
        (
            {"robot_fails": robot},
            {"robot_fails": robot},
            {"robot_silent": robot},
            {"robot_returns": robot},
            {"cancel_task": task},
            {"delay_task": DelayedTask(task=task, by_s=random.uniform(1, 30))},
            {"new_task": Task(id=f"new {k}", position=_place(random), **random.choice(({}, _team(random))))},
        )
    )
    return Event(at_s=at_s, **happens)
