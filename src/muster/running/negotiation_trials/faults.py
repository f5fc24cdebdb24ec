"""What happens to a team while it agrees and works: starts, crashes, restarts, cuts, orders, at random times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random

from muster.mission.model import Mission, Task
from muster.running.negotiation_trials.random_missions import random_task

Links = frozenset[tuple[str, str]]
"""Who hears whom directly: (speaker, listener)."""


@dataclass(frozen=True)
class Incident:
    """Something that happens to the team at a time, seconds.

    Parameters
    ----------
    kind
        "start", "crash", "restart", "forget" (restart without memory), "cut", "block", "heal", "announce", "cancel",
        "release", "withdraw".
    robot
        to which robot, or by which; "" to none.
    groups
        of "cut": who still hears each other.
    links
        of "block": on which nothing is heard.
    task
        of "announce": the task; of "cancel" its id.
    """

    at_s: float
    kind: str
    robot: str = ""
    groups: tuple[tuple[str, ...], ...] = ()
    links: Links = frozenset()
    task: Task | None = None


def incidents(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    late = set(random.sample(names, random.randint(0, len(names) - 1)) if random.random() < 0.3 else ())
    for robot in names:
        yield Incident(random.uniform(0, until_s) if robot in late else 0.0, "start", robot)
    for robot in random.sample(names, random.choice((0, random.randint(0, len(names) - 1)))):
        yield from _crashes(robot, until_s, random)
    if random.random() < 0.5:
        yield from _cuts(names, until_s, random)
    yield from orders(mission, names, until_s, random)


def _crashes(robot: str, until_s: float, random: Random) -> Iterator[Incident]:
    """A robot is gone; perhaps it starts again, with or without memory, and perhaps is gone again."""
    now = random.uniform(0, until_s)
    yield Incident(now, "crash", robot)
    while random.random() < 0.6:
        now = random.uniform(now, until_s)
        yield Incident(now, random.choice(("restart", "forget")), robot)
        if random.random() < 0.7:
            return
        now = random.uniform(now, until_s)
        yield Incident(now, "crash", robot)


def _cuts(names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    for _ in range(random.randint(1, 2)):
        sides: Mapping[int, list[str]] = {0: [], 1: [], 2: []}
        for robot in names:
            sides[random.randrange(random.choice((2, 3)))].append(robot)
        begin = random.uniform(0, until_s)
        yield Incident(begin, "cut", groups=tuple(tuple(side) for side in sides.values() if side))
        yield Incident(random.uniform(begin, until_s), "heal")


def orders(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    """Tasks that are added and cancelled, and robots that give tasks back."""
    for k in range(random.choice((0, 0, 1, 3))):
        task = random_task(random, f"n{k}", before=[], skilled=False, once=random.random() < 0.2)
        yield Incident(random.uniform(0, until_s), "announce", random.choice(names), task=task)
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), "cancel", random.choice(names), task=random.choice(mission.tasks))
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), random.choice(("release", "withdraw")), random.choice(names))
