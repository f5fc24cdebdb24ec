"""Random missions of teams, and what goes wrong while robots carry them out by themselves."""

from dataclasses import dataclass, field, replace
from random import Random

from muster.mission.model import Event, Lag, Mission, MovedTask, Robot, Task, TeamPart

SIDE_M = 30.0
GRIP, LIFT = "grip", "kg"
LAST_FAULT_S = 60.0


@dataclass(frozen=True)
class Fault:
    """What happens at a time, in seconds.

    "strike" (the first robot to be at work with others crashes), "crash", "restart", "forget", "cut", "block", "heal"
    or "told" (an event).
    """

    at_s: float
    kind: str
    robots: tuple[str, ...] = ()
    links: frozenset = frozenset()
    event: Event | None = None


@dataclass(frozen=True)
class TeamScene:
    """A mission, what the network does to messages, and what goes wrong."""

    mission: Mission
    conditions: dict
    faults: tuple[Fault, ...] = field(default_factory=tuple)


def team_scene(seed):
    """The scene of a seed."""
    random = Random(f"teams {seed}")
    mission = _mission(random)
    conditions = {
        "loss": random.choice((0.0, 0.2, random.uniform(0, 0.5))),
        "delay_s": random.uniform(0.001, 0.1),
        "jitter_s": random.choice((0.0, 0.05, 0.3)),
        "duplication": random.choice((0.0, 0.2)),
    }
    return TeamScene(mission, conditions, tuple(sorted(_faults(mission, random), key=lambda fault: fault.at_s)))


def calm_scene(seed):
    """A scene in which nothing goes wrong, of robots of which some are slow at work."""
    random = Random(f"calm {seed}")
    mission = _mission(random)
    robots = tuple(replace(robot, efficiency=random.choice((1.0, 1.0, 0.5))) for robot in mission.robots)
    conditions = {"delay_s": random.uniform(0.001, 0.05), "jitter_s": random.choice((0.0, 0.05))}
    return TeamScene(replace(mission, robots=robots), conditions)


def _mission(random):
    robots = random.choice((2, 3, 4, 5, 6))
    timed = random.random() < 0.5
    made = []
    for k in range(random.randint(2, 7)):
        made.append(_task(str(k), made, random, timed=timed))
    return Mission(robots=tuple(_robot(k, random, timed=timed) for k in range(robots)), tasks=tuple(made))


def _robot(k, random, *, timed):
    return Robot(
        id=f"r_{k}",
        position=_place(random),
        speed_mps=random.choice((1.0, 2.0)),
        skills=(GRIP,) if random.random() < 0.7 else (),
        abilities={LIFT: random.choice((1.0, 2.0))},
        available_until_s=random.uniform(60, 200) if timed and random.random() < 0.2 else None,
    )


def _task(name, others, random, *, timed):
    """A task for one or several robots, now and then bound to others, and to times."""
    sort = random.choice(
        (
            {},
            {"requires": (GRIP,)},
            {"robots_needed": random.choice((2, 3))},
            {"team": (TeamPart(), TeamPart(requires=(GRIP,)))},
            {"needs": {LIFT: random.choice((2.0, 3.0))}},
        )
    )
    return Task(
        id=name,
        position=_place(random),
        duration_s=random.choice((0.0, 3.0, random.uniform(4, 12), random.uniform(15, 40))),
        **sort,
        **_ties(others, random, timed=timed),
        **(_times(random) if timed else {}),
    )


def _ties(others, random, *, timed):
    """The task waits for another, or begins with it; those tied may not wait for each other by others."""
    free = [other.id for other in others if not other.prerequisites and not other.starts_with]
    if free and random.random() < 0.2:
        return {"starts_with": (random.choice(free),)}
    if not others or random.random() > 0.25:
        return {}
    before = random.choice(others).id
    if not timed or random.random() < 0.5:
        return {"prerequisites": (before,)}
    lag = Lag(after_s=random.choice((2.0, 10.0)), within_s=random.choice((None, random.uniform(30, 90))))
    return {"prerequisites": (before,), "lags": {before: lag}}


def _times(random):
    opens = random.uniform(0, 80)
    window = (opens, random.choice((None, opens + random.uniform(20, 80))))
    return {
        "window_s": (window,) if random.random() < 0.3 else (),
        "deadline_s": random.uniform(60, 200) if random.random() < 0.2 else None,
    }


def _faults(mission, random):
    names = [robot.id for robot in mission.robots]
    if random.random() < 0.3:
        yield Fault(0.0, "strike")
    for robot in random.sample(names, random.choice((0, 0, 1, random.randint(0, len(names) - 1)))):
        yield from _crashes(robot, random)
    for _ in range(random.choice((0, 0, 1, 2))):
        begin = random.uniform(1, LAST_FAULT_S - 1)
        if random.random() < 0.7:
            yield Fault(begin, "cut", robots=tuple(random.sample(names, random.randint(1, len(names) - 1))))
        else:
            links = ((one, other) for one in names for other in names if random.random() < 0.2)
            yield Fault(begin, "block", links=frozenset(links))
        yield Fault(random.uniform(begin, LAST_FAULT_S), "heal")
    for k in range(random.choice((0, 0, 1, 2))):
        yield Fault(random.uniform(1, 50), "told", (random.choice(names),), event=_order(k, mission, random))


def _crashes(robot, random):
    now = random.uniform(1, LAST_FAULT_S)
    yield Fault(now, "crash", (robot,))
    while random.random() < 0.6:
        now = random.uniform(now, LAST_FAULT_S)
        yield Fault(now, random.choice(("restart", "restart", "forget")), (robot,))
        if random.random() < 0.6:
            return
        now = random.uniform(now, LAST_FAULT_S)
        yield Fault(now, "crash", (robot,))


def _order(k, mission, random):
    """What an operator tells one robot for all."""
    task = random.choice(mission.tasks).id
    return random.choice(
        (
            Event(at_s=0.0, new_task=_task(f"n{k}", (), random, timed=False)),
            Event(at_s=0.0, cancel_task=task),
            Event(at_s=0.0, move_task=MovedTask(task=task, position=_place(random))),
        )
    )


def _place(random):
    return random.uniform(0, SIDE_M), random.uniform(0, SIDE_M)
