"""A siege: cuts that move while tasks are carried out, so that one majority after the other may go on.

At-most-once rests on any two majorities having a robot in common that remembers. So here they have one alone, most of
the time, and it crashes, and may forget, at bad moments; links go one way; cuts heal when somebody is about to begin.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from random import Random

from muster.mission.model import Mission
from muster.studies.negotiation.incidents import Incident, Links, orders
from muster.studies.negotiation.missions import random_task


def siege(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    """What happens to a team under siege."""
    return (incident for incident in _waves(mission, names, until_s, random) if incident.at_s < until_s)


def _waves(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    for robot in names:
        yield Incident(random.choice((0.0, 0.0, 0.0, random.uniform(0, until_s))), "start", robot)
    yield from orders(mission, names, until_s, random)
    group, now, wave = list(names), random.uniform(0, 6), 0
    while now < until_s:
        lasts_s = random.choice((random.uniform(0.05, 2), random.uniform(4, 9), random.uniform(4, 9)))
        kind = random.choice(("next majority",) * 5 + ("any cut", "deafen", "deafen", "heal"))
        if kind == "next majority":
            bridge = random.choice(group)
            group = _majority_with(bridge, group, names, random)
            yield Incident(now, "cut", groups=(tuple(group), *_apart([r for r in names if r not in group], random)))
            yield from _struck(bridge, now, lasts_s, random)
        elif kind == "any cut":
            yield Incident(now, "cut", groups=_apart(names, random))
        elif kind == "deafen":
            yield Incident(now, "deafen", links=_one_way(names, random))
        else:
            yield Incident(now, "heal")
        if random.random() < 0.3:
            task = random_task(random, f"w{wave}", before=[], skilled=False, once=True)
            yield Incident(random.uniform(now, now + lasts_s), "announce", random.choice(names), task=task)
        if random.random() < 0.2:
            yield Incident(random.uniform(now, now + lasts_s), "release", random.choice(names))
        now, wave = now + lasts_s, wave + 1


def _majority_with(bridge: str, before: Sequence[str], names: Sequence[str], random: Random) -> list[str]:
    """A majority that has few robots but this one in common with the one before."""
    fresh = [robot for robot in names if robot not in before]
    others = [robot for robot in before if robot != bridge]
    random.shuffle(fresh)
    random.shuffle(others)
    return [bridge, *fresh, *others][: len(names) // 2 + 1]


def _struck(robot: str, now: float, within_s: float, random: Random) -> Iterator[Incident]:
    """Sometimes the robot in common crashes, before or after it was cut off, and starts again or not."""
    if random.random() < 0.5:
        return
    crash = max(0.0, now + random.uniform(-1, within_s))
    yield Incident(crash, "crash", robot)
    if random.random() < 0.8:
        yield Incident(crash + random.uniform(0.05, 5), random.choice(("restart", "forget")), robot)


def _apart(names: Sequence[str], random: Random) -> tuple[tuple[str, ...], ...]:
    """Some groups of all of them, at random."""
    sides: list[list[str]] = [[] for _ in range(random.choice((1, 2, 3)))]
    for robot in names:
        random.choice(sides).append(robot)
    return tuple(tuple(side) for side in sides if side)


def _one_way(names: Sequence[str], random: Random) -> Links:
    """Links on which nothing is heard: some robots hear nobody, some nobody hears, some other links at random."""
    deaf, dumb = ({robot for robot in names if random.random() < 0.25} for _ in range(2))
    odd = random.choice((0.0, 0.2))
    links = ((a, b) for a in names for b in names if a != b)
    return frozenset((a, b) for a, b in links if a in dumb or b in deaf or random.random() < odd)
