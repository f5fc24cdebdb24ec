"""Moving partitions: cuts that change while tasks are carried out, so that one majority after another may go on.

At-most-once tasks rest on the fact that any two majorities have a robot in common that remembers. So here consecutive
majorities have only one robot in common, and it crashes, and may lose its memory, at critical moments; links work in
one direction only; cuts heal when a robot is about to begin a task.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

from tests.muster_team.trials.faults import Incident, Links, orders
from tests.muster_team.trials.random_missions import random_task

from muster.mission.model import Mission

_MOVING = ("next majority",) * 3 + ("ambush",)
_MIXED = ("next majority", "any cut", "block", "block", "heal", "ambush")


def moving_partitions(
    mission: Mission, names: Sequence[str], until_s: float, suspect_s: float, random: Random
) -> Iterator[Incident]:
    """The incidents of a team whose robots suspect a robot after `suspect_s` without a message from it."""
    late_s = random.choice((0.0, 0.0, until_s))
    starts = [Incident(random.choice((0.0, 0.0, random.uniform(0, late_s))), "start", robot) for robot in names]
    usual = orders(mission, names, until_s, random) if random.random() < 0.3 else ()
    waves = _Waves(names, suspect_s, random).until(until_s)
    return (incident for incident in (*starts, *usual, *waves) if incident.at_s < until_s)


class _Waves:
    """Partitions, one after the other."""

    def __init__(self, names: Sequence[str], suspect_s: float, random: Random) -> None:
        self._names, self._suspect_s, self._random = names, suspect_s, random
        self._danger = random.choice((0.0, 0.3, 0.6))
        self._group = list(names)
        self._now = random.uniform(0, suspect_s)
        self._tasks = 0

    def until(self, until_s: float) -> Iterator[Incident]:
        random, kinds = self._random, self._random.choice((_MOVING, _MIXED))
        while self._now < until_s:
            kind = random.choice(kinds)
            if kind == "ambush":
                yield from self._ambush()
            elif kind == "next majority":
                yield from self._next_majority(self._danger)
            elif kind == "any cut":
                yield Incident(self._now, "cut", groups=_apart(self._names, random))
            elif kind == "block":
                yield Incident(self._now, "block", links=_one_way(self._names, random))
            else:
                yield Incident(self._now, "heal")
            if random.random() < 0.5:
                yield self._task()
            if random.random() < 0.2:
                yield Incident(self._now, "release", random.choice(self._names))
            self._now += self._suspect_s * random.choice((random.uniform(0, 0.5), *[random.uniform(1.2, 4)] * 3))

    def _ambush(self) -> Iterator[Incident]:
        """Some robots are cut off; the others begin tasks; a robot that changes sides has lost its memory."""
        yield Incident(self._now, "heal")
        yield from (self._task() for _ in range(len(self._names) + 1))
        self._now += self._suspect_s * self._random.uniform(0.3, 1)
        self._group = list(self._names)
        yield from self._next_majority(0.0)
        self._now += self._suspect_s * self._random.uniform(1.5, 3.5)
        yield from self._next_majority(0.8)
        self._now += self._suspect_s * self._random.uniform(1, 3)

    def _next_majority(self, danger: float) -> Iterator[Incident]:
        bridge = self._random.choice(self._group)
        self._group = _majority_with(bridge, self._group, self._names, self._random)
        others = [robot for robot in self._names if robot not in self._group]
        yield Incident(self._now, "cut", groups=(tuple(self._group), *_apart(others, self._random)))
        if self._random.random() < danger:
            yield from _struck(bridge, self._now, self._random)

    def _task(self) -> Incident:
        """Announce a new task."""
        self._tasks += 1
        task = random_task(self._random, f"w{self._tasks}", before=[], skilled=False, once=True)
        return Incident(self._now, "announce", self._random.choice(self._names), task=task)


def _majority_with(bridge: str, before: Sequence[str], names: Sequence[str], random: Random) -> list[str]:
    """A majority, or half of one, that has few robots besides this one in common with the previous one."""
    fresh = [robot for robot in names if robot not in before]
    others = [robot for robot in before if robot != bridge]
    random.shuffle(fresh)
    random.shuffle(others)
    return [bridge, *fresh, *others][: (len(names) + 1) // 2 + random.choice((0, 1 - len(names) % 2))]


def _struck(robot: str, now: float, random: Random) -> Iterator[Incident]:
    """The common robot crashes, mostly before it joins the others, and restarts there, or not at all."""
    crash_s = now + random.choice((random.uniform(-1, 0), random.uniform(-1, 0), random.uniform(0, 4)))
    yield Incident(max(0.0, crash_s), "crash", robot)
    if random.random() < 0.9:
        again_s = max(now, crash_s) + random.choice((random.uniform(0.05, 0.5), random.uniform(0.05, 5)))
        yield Incident(again_s, random.choice(("restart", "forget", "forget", "forget")), robot)


def _apart(names: Sequence[str], random: Random) -> tuple[tuple[str, ...], ...]:
    """A random partition of all robots into groups."""
    sides: list[list[str]] = [[] for _ in range(random.choice((1, 2, 3)))]
    for robot in names:
        random.choice(sides).append(robot)
    return tuple(tuple(side) for side in sides if side)


def _one_way(names: Sequence[str], random: Random) -> Links:
    """Links without messages: all links to some robots, all links from some robots, and other links at random."""
    deaf, dumb = ({robot for robot in names if random.random() < 0.25} for _ in range(2))
    odd = random.choice((0.0, 0.2))
    links = ((a, b) for a in names for b in names if a != b)
    return frozenset((a, b) for a, b in links if a in dumb or b in deaf or random.random() < odd)
