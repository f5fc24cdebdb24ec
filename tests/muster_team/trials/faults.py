"""Incidents at random times: starts, crashes, restarts, partitions and orders."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from random import Random

from tests.muster_team.trials.random_missions import random_task

from muster.mission.model import Mission, Task

Links = frozenset[tuple[str, str]]
"""The direct links: (sender, receiver)."""


@dataclass(frozen=True)
class Incident:
    """An incident at a time, seconds.

    Parameters
    ----------
    kind
        "start", "crash", "restart", "forget" (restart without memory), "cut", "block", "heal", "announce", "cancel",
        "release", "withdraw".
    robot
        the robot concerned; "" for none.
    groups
        of "cut": the groups within which robots still hear each other.
    links
        of "block": the links on which all messages are lost.
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
    """Crashes of a robot; after one it may restart, with or without memory, and crash again."""
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
    """Tasks that are announced and cancelled, and robots that release tasks."""
    for k in range(random.choice((0, 0, 1, 3))):
        task = random_task(random, f"n{k}", before=[], skilled=False, once=random.random() < 0.2)
        yield Incident(random.uniform(0, until_s), "announce", random.choice(names), task=task)
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), "cancel", random.choice(names), task=random.choice(mission.tasks))
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), random.choice(("release", "withdraw")), random.choice(names))
