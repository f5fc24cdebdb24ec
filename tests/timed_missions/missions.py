"""Random small missions with every key of time and teams, by seed."""

import contextlib
import math
from dataclasses import replace
from random import Random

from muster import Mission, MissionError, Robot, Rules, Task
from muster.mission.model import Lag, TeamPart
from tests.random_missions import with_travel_tables

OBJECTIVES = ("total", "max", "total+max", "average", "makespan", "lateness")
TYPES, KINDS, SKILLS = ("alpha", "beta"), ("D", "E"), ("camera", "gripper")
IGNORED = (
    "window",
    "deadline",
    "shift",
    "team",
    "relation",
    "min-tasks",
    "prerequisite",
    "capacity",
    "skill",
    "lock",
    "suitability",
)
RULES = ("window", "deadline", "due", "shift", "lag", "team", "needs", "relation", "starts-with", "capacity", "skills")
FURTHER = ("shifts", "duty", "either-or", "aboard")


def timed_mission(seed, *, tasks=None, robots=None):
    """A mission of two to six tasks that has some of the rules."""
    random = Random(f"timed {seed}")
    tasks = random.choice((2, 3, 4, 4, 5, 5, 6)) if tasks is None else tasks
    robots = (
        random.choice((1, 2, 2) if tasks == 6 else (1, 2, 2, 3) if tasks == 5 else (1, 2, 3, 3))
        if robots is None
        else robots
    )
    share = random.choice((0.15, 0.3, 0.5))
    has = {rule for rule in RULES if random.random() < share}
    made_robots = tuple(_robot(random, k, has) for k in range(robots))
    made_tasks = [_task(random, k, tasks, made_robots, has) for k in range(tasks)]
    _relate(random, made_tasks, has, robots)
    random.shuffle(made_tasks)
    made_robots = _with_least(Random(f"least {seed}"), made_robots)
    suitability = {kind: {task: random.choice((0.4, 0.7, 1.0, 1.0)) for task in KINDS} for kind in TYPES}
    mission = Mission(
        name=f"timed-{seed}",
        rules=Rules(
            objective=random.choice(OBJECTIVES),
            usage=random.choice(("distance", "distance", "time")),
            return_to_start=random.random() < 0.4,
            capacity_reserve=random.choice((0, 0.1)),
            timing="constant",
            makespan_includes_return=random.random() < 0.4,
        ),
        robots=made_robots,
        tasks=tuple(made_tasks),
        suitability=suitability if "skills" in has and random.random() < 0.5 else None,
    )
    return with_travel_tables(mission, seed) if random.random() < 0.1 else mission


def ignored_in(seed):
    """The rules that are ignored in the trial of a seed: mostly none."""
    random = Random(f"ignored {seed}")
    return tuple(sorted(random.sample(IGNORED, random.choice((0, 0, 0, 0, 1, 2)))))


def with_further_rules(mission, seed):
    """The mission, in which some robots have several shifts and longest duties, and tasks alternatives and deliveries.

    Planning does not know these rules yet: they are for the judge.
    """
    random = Random(f"further {seed}")
    has = {rule for rule in FURTHER if random.random() < 0.5}
    robots = tuple(_with_rests(random, robot, has) for robot in mission.robots)
    tasks = _carrying(random, list(mission.tasks)) if "aboard" in has else list(mission.tasks)
    for k in range(len(tasks) if "either-or" in has else 0):
        j = random.randrange(len(tasks))
        if j != k and random.random() < 0.4:
            tied = [replace(one, either_or=(tasks[j].id,)) if one is tasks[k] else one for one in tasks]
            with contextlib.suppress(MissionError):  # some task needs both
                tasks = list(replace(mission, tasks=tuple(tied)).tasks)
    return replace(mission, robots=robots, tasks=tuple(tasks))


def further_ignored_in(seed):
    """The rules that are ignored where the further rules are judged: mostly none."""
    random = Random(f"further ignored {seed}")
    more = random.sample(("shift", "duty", "aboard", "either-or", "load"), random.choice((0, 0, 0, 0, 1, 2)))
    return tuple(sorted({*ignored_in(seed), *more}))


def _with_rests(random, robot, has):
    changes = {}
    if "shifts" in has and random.random() < 0.7:
        at, shifts = random.choice((0.0, robot.available_from_s)), []
        for _ in range(random.choice((1, 2, 2, 3))):
            end = at + random.uniform(4, 25)
            shifts.append((round(at, 3), round(end, 3)))
            at = end + random.choice((0, 3, random.uniform(1, 20)))
        if random.random() < 0.3:
            shifts[-1] = (shifts[-1][0], None)
        changes = {"shifts_s": tuple(shifts), "available_from_s": 0.0, "available_until_s": None}
    if "duty" in has and random.random() < 0.7:
        changes["longest_duty_s"] = round(random.uniform(3, 40), 3)
    return replace(robot, **changes)


def _carrying(random, tasks):
    """Some tasks deliver what others take on board, most of them within some time."""
    free = [k for k, task in enumerate(tasks) if not (task.robots_needed or task.team or task.needs)]
    random.shuffle(free)
    for j, k in zip(free[::2], free[1::2], strict=False):
        longest = random.choice((None, 0.0, round(random.uniform(0.5, 8), 3), round(random.uniform(1, 25), 3)))
        longer = list(tasks)
        longer[j] = replace(tasks[j], load=1)
        longer[k] = replace(tasks[k], delivers=tasks[j].id, longest_aboard_s=longest)
        with contextlib.suppress(MissionError):  # waits for what waits for it
            Mission(
                robots=(Robot(id="r", position=(0, 0)),), tasks=tuple(replace(one, only_robots=None) for one in longer)
            )
            tasks = longer
    return tasks


def _place(random):
    return (round(random.uniform(-10, 10), 3), round(random.uniform(-10, 10), 3))


def _robot(random, k, has):
    begin = random.choice((0, 0, 0, 7.25))
    return Robot(
        id=f"r_{k}",
        position=random.choice(((0.0, 0.0), _place(random))),
        type=random.choice(TYPES),
        kind=random.choice(("ground", "ground", "air")),
        skills=tuple(skill for skill in SKILLS if random.random() < 0.7),
        work_capacity=round(random.uniform(15, 70), 3) if "capacity" in has and random.random() < 0.6 else None,
        speed_mps=random.choice((0.5, 1.0, 1.0, 2.0)),
        efficiency=random.choice((0.8, 1.0, 1.0)),
        end_position=_place(random) if random.random() < 0.15 else None,
        return_to_start=random.choice((None, None, None, True, False)),
        available_from_s=begin,
        available_until_s=round(begin + random.uniform(15, 80), 3)
        if "shift" in has and random.random() < 0.7
        else None,
        abilities={"lift": round(random.uniform(1, 5), 2)} if "needs" in has and random.random() < 0.85 else None,
    )


def _with_least(random, robots):
    """In some missions robots do a least number of tasks, or none."""
    if random.random() > 0.35:
        return robots
    return tuple(replace(robot, min_tasks=random.choice((0, 1, 2, 2, 3))) for robot in robots)


def _task(random, k, tasks, robots, has):
    before = tuple(str(j) for j in range(k) if random.random() < 1.2 / tasks)
    return Task(
        id=str(k),
        position=_place(random),
        type=random.choice(KINDS),
        actuation_cost=random.choice((0, 0, 4.5)),
        duration_s=random.choice((None, None, 0, 3.1, 8.3)),
        prerequisites=before,
        lags={name: _lag(random) for name in before if "lag" in has and random.random() < 0.8},
        requires=tuple(skill for skill in SKILLS if "skills" in has and random.random() < 0.2),
        priority=random.choice((1, 1, 1, 2.5)),
        only_robots=(random.choice(robots).id,) if random.random() < 0.06 else None,
        entry=_place(random) if random.random() < 0.08 else None,
        exit=_place(random) if random.random() < 0.08 else None,
        window_s=_windows(random) if "window" in has and random.random() < 0.6 else (),
        deadline_s=round(random.uniform(8, 60), 3) if "deadline" in has and random.random() < 0.4 else None,
        due_s=round(random.uniform(0, 40), 3) if "due" in has and random.random() < 0.6 else None,
        **_team(random, len(robots), has),
    )


def _windows(random):
    """One to three windows, the last of them perhaps without an end."""
    at, windows = 0.0, []
    for _ in range(random.choice((1, 1, 2, 3))):
        begin = at + random.uniform(0, 20)
        at = begin + random.uniform(1, 15)
        windows.append((round(begin, 3), round(at, 3)))
    if random.random() < 0.2:
        windows[-1] = (windows[-1][0], None)
    return tuple(windows)


def _lag(random):
    after = random.choice((0.0, 0.0, 2.3, 6.1))
    return Lag(after_s=after, within_s=random.choice((None, round(after + random.uniform(0.5, 25), 3))))


def _team(random, robots, has):
    if "needs" in has and random.random() < 0.5:
        return {"needs": {"lift": round(random.uniform(0.5, 6), 2)}}
    if "team" not in has or random.random() < 0.4:
        return {}
    if random.random() < 0.6:
        return {"robots_needed": random.choice((1, 2, 2, 3 if robots > 2 else 2))}
    return {"team": tuple(_part(random) for _ in range(random.choice((1, 2, 2))))}


def _part(random):
    return TeamPart(
        count=random.choice((1, 1, 1, 2)),
        type=random.choice((None, None, *TYPES)),
        kind=random.choice((None, None, None, "ground", "air")),
        requires=random.choice(((), (), (random.choice(SKILLS),))),
    )


def _relate(random, tasks, has, robots):
    """Relations between tasks; those that begin together do not wait for each other, not by way of others either."""
    for k in range(1, len(tasks)):
        j = random.randrange(k)
        if "relation" in has and random.random() < 0.4:
            key = random.choice(("same_robot_as", "other_robot_than"))
            related = [*tasks[:k], replace(tasks[k], **{key: (str(j),)}), *tasks[k + 1 :]]
            tasks[:] = tasks if _is_contradictory(related) else related
    if "starts-with" in has and robots > 1 and len(tasks) > 1:
        k = random.randrange(1, len(tasks))
        apart = _unordered(tasks, k)
        if apart:
            tasks[k] = replace(tasks[k], starts_with=(random.choice(apart),))


def _unordered(tasks, k):
    """Ids of tasks before k that neither come before it nor after."""
    by_id = {task.id: task for task in tasks}

    def ancestors(name):
        return {name}.union(*(ancestors(other) for other in by_id[name].prerequisites))

    related = ancestors(str(k)) | _by_one_robot(tasks, str(k))
    return [str(j) for j in range(k) if str(j) not in related]


def _by_one_robot(tasks, name):
    """The tasks that the robot of a task does too, by way of others as well."""
    found, waiting = {name}, [name]
    while waiting:
        one = waiting.pop()
        tied = {task.id for task in tasks if one in task.same_robot_as}
        tied.update(*(task.same_robot_as for task in tasks if task.id == one))
        waiting += tied - found
        found |= tied
    return found


def _is_contradictory(tasks):
    """Whether the robot of a task must do it and must not."""
    return any(_by_one_robot(tasks, task.id).intersection(task.other_robot_than) for task in tasks)


def wrong_routes(mission, random):
    """Routes of tasks at random, each in some of the routes, at most once in each: seldom admissible."""
    routes = [[] for _ in mission.robots]
    for j in random.sample(range(len(mission.tasks)), random.randint(1, len(mission.tasks))):
        size = random.choice((1, 1, 1, 2, min(3, len(routes))))
        for i in random.sample(range(len(routes)), min(size, len(routes))):
            routes[i].insert(random.randint(math.floor(len(routes[i]) / 2), len(routes[i])), j)
    return tuple(tuple(route) for route in routes)
