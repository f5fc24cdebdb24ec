"""Random missions with rules about time and teams, and what happens in them, by seed."""

from collections import Counter
from dataclasses import replace
from random import Random

from muster import Mission, Robot, Rules, Task
from muster.mission.model import DelayedTask, Event, Lag, MovedTask, TeamPart

SKILLS = ("gripper", "camera")


def mission_of(seed):
    """A mission of 2 to 5 robots and 3 to 9 tasks with up to six events; its tasks are in an order that can be kept."""
    random = Random(f"timed {seed}")
    profiles = random.random() < 0.3
    robots = tuple(_robot(f"r_{k}", random, profiles) for k in range(random.randint(2, 5)))
    tasks = []
    for k in range(random.randint(3, 9)):
        tasks.append(_task(str(k), tasks, random))
    names = [robot.id for robot in robots]
    events = tuple(_event(k, names, tasks, random) for k in range(random.randint(1, 6)))
    rules = Rules(
        objective=random.choice(("makespan", "lateness", "total")),
        stability=random.choice((None, None, None, 0, 1, 3)),
    )
    return Mission(rules=rules, robots=robots, tasks=tuple(tasks), events=events)


def with_members_failing(mission, plan, seed):
    """With more events: a robot of one task for several fails while they are at it, by the plan, and maybe returns."""
    random = Random(f"members {seed}")
    members = Counter(stop.name for route in plan.routes for stop in route.stops)
    together = [(route.robot, stop) for route in plan.routes for stop in route.stops if members[stop.name] > 1]
    if not together or random.random() < 0.3:
        return mission
    robot, stop = random.choice(together)
    at_s = random.uniform(stop.begin_s, stop.end_s)
    more = [Event(at_s=at_s, **{random.choice(("robot_fails", "robot_fails", "robot_silent")): robot})]
    if random.random() < 0.3:
        more.append(Event(at_s=at_s + random.uniform(5, 40), robot_returns=robot))
    return replace(mission, events=(*mission.events, *more))


def _place(random):
    return random.uniform(-15, 15), random.uniform(-15, 15)


def _robot(name, random, profiles):
    moves = {"acceleration_mps2": random.uniform(0.3, 2), "yaw_rate_radps": random.uniform(0.5, 3)} if profiles else {}
    return Robot(
        id=name,
        type=random.choice(("rover", "drone")),
        position=_place(random),
        skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
        abilities={"lift_kg": random.choice((10.0, 20.0))},
        efficiency=random.choice((0.5, 1.0, 1.0)),
        return_to_start=random.random() < 0.3,
        available_until_s=random.uniform(80, 300) if random.random() < 0.2 else None,
        min_tasks=random.choice((0, 0, 0, 0, 2)),
        **moves,
    )


def _task(name, before, random):
    keys = {"position": _place(random), "duration_s": random.uniform(1, 20)} | _times(random, 0)
    if before and random.random() < 0.4:
        other = random.choice(before).id
        lag = Lag(after_s=random.choice((0.0, 8.0)), within_s=random.choice((None, 10.0, 40.0)))
        keys |= {"prerequisites": (other,), "lags": {other: lag} if lag != Lag() else {}}
    keys |= random.choice(({}, {}, _team(random)))
    keys |= random.choice(({}, {}, {}, _relation([] if "prerequisites" in keys else before, random)))
    return Task(id=name, **keys)


def _times(random, now):
    """Windows, a deadline, a due time, or none of them, of a task that is known at a time."""
    keys = {}
    if random.random() < 0.4:
        first = now + random.uniform(0, 80)
        keys["window_s"] = ((first, first + random.uniform(5, 60)),)
        if random.random() < 0.5:
            again = keys["window_s"][0][1] + random.uniform(5, 60)
            keys["window_s"] += ((again, random.choice((None, again + 40))),)
    if random.random() < 0.2:
        keys["deadline_s"] = now + random.uniform(40, 200)
    if random.random() < 0.2:
        keys["due_s"] = now + random.uniform(10, 100)
    return keys


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
    at_s, robot, task = random.uniform(1, 90), random.choice(robots), random.choice(tasks).id
    keys = {"duration_s": random.uniform(1, 20)} | _times(random, at_s) | random.choice(({}, _team(random)))
    new = Task(id=f"new {k}", position=_place(random), **keys)
    happens = random.choice(
        (
            {"robot_fails": robot},
            {"robot_fails": robot},
            {"robot_silent": robot},
            {"robot_returns": robot},
            {"robot_joins": _robot(f"new {k}", random, profiles=False)},
            {"cancel_task": task},
            {"move_task": MovedTask(task=task, position=_place(random))},
            {"delay_task": DelayedTask(task=task, by_s=random.uniform(1, 30))},
            {"new_task": new},
        )
    )
    return Event(at_s=at_s, **happens)
