"""Everything that happens in one run, by a seed: mission, terms, weather, links, and faults with their times."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import permutations
from random import Random

from muster.allocation.auction import Parameters
from muster.allocation.terms import BIDS, PLACEMENTS, WINNERS
from muster.mission.model import Mission, Task
from muster.negotiation.memory_network import Weather
from muster.studies.negotiation.missions import random_mission, random_task

Links = frozenset[tuple[str, str]]
"""Who hears whom directly: (speaker, listener)."""


@dataclass(frozen=True)
class Incident:
    """Something that happens to the team at a time, seconds.

    Parameters
    ----------
    kind
        "start", "crash", "restart", "forget" (restart without memory), "cut", "heal", "announce", "cancel", "release",
        "withdraw".
    robot
        to which robot, or by which; "" to none.
    groups
        of "cut": who still hears each other.
    task
        of "announce": the task; of "cancel" its id.
    """

    at_s: float
    kind: str
    robot: str = ""
    groups: tuple[tuple[str, ...], ...] = ()
    task: Task | None = None


@dataclass(frozen=True)
class Scene:
    """One run.

    Parameters
    ----------
    links
        None: everybody hears everybody.
    work_s
        how long robots take for a task; None: they only agree.
    incidents
        in no order.
    quiet_s
        from when on nothing happens any more but what the weather does.
    """

    seed: int
    mission: Mission
    terms: Parameters
    weather: Weather
    links: Links | None
    work_s: float | None
    incidents: tuple[Incident, ...]
    quiet_s: float

    @property
    def forgets(self) -> bool:
        return any(incident.kind == "forget" for incident in self.incidents)

    def described(self) -> Iterator[str]:
        """Lines for people."""
        weather = self.weather
        terms = f"{self.terms.bid}, {self.terms.placement}, {self.terms.winner}"
        mission = self.mission
        yield f"seed {self.seed}: {len(mission.robots)} robots, {len(mission.tasks)} tasks, {terms}"
        yield f"loss {weather.loss:.0%}, delay {weather.delay_s:.3f} s and up to {weather.jitter_s:g} s"
        yield f"duplication {weather.duplication:.0%}; work {self.work_s or 0:g} s; quiet at {self.quiet_s:.2f} s"
        if self.links is not None:
            yield "links " + ", ".join(f"{a} > {b}" for a, b in sorted(self.links))
        for what in sorted(self.incidents, key=lambda incident: incident.at_s):
            groups = " | ".join(" ".join(group) for group in what.groups)
            task = "" if what.task is None else what.task.id
            yield f"{what.at_s:8.3f} s {what.kind} {what.robot}{groups} {task}".rstrip()


def scene(seed: int) -> Scene:
    """The scene of a seed."""
    random = Random(f"negotiation {seed}")
    robots = random.choice((2, 3, 4, 5, 6, 7, random.randint(8, 12)))
    mission = random_mission(random, robots=robots, tasks=random.randint(1, 14))
    names = [robot.id for robot in mission.robots]
    quiet_s = random.uniform(5, 30) if random.random() < 0.2 else random.uniform(1, 8)
    return Scene(
        seed=seed,
        mission=mission,
        terms=Parameters(bid=random.choice(BIDS), placement=random.choice(PLACEMENTS), winner=random.choice(WINNERS)),
        weather=Weather(
            loss=random.choice((0.0, random.uniform(0, 0.5))),
            delay_s=random.uniform(0.001, 0.1),
            jitter_s=random.choice((0.0, 0.05, 0.3)),
            duplication=random.choice((0.0, 0.2)),
        ),
        links=_links(names, random) if random.random() < 0.25 else None,
        work_s=random.choice((None, random.uniform(0.3, 3.0))),
        incidents=tuple(_incidents(mission, names, quiet_s, random)),
        quiet_s=quiet_s,
    )


def _links(names: Sequence[str], random: Random) -> Links:
    """A random tree with some more links; sometimes these go one way."""
    links, both_ways = set[tuple[str, str]](), random.random() < 0.8
    for k in range(1, len(names)):
        links |= _link(names[k], names[random.randrange(k)])
    for a, b in permutations(names, 2):
        if random.random() < 0.1:
            links |= _link(a, b) if both_ways else {(a, b)}
    return frozenset(links)


def _link(a: str, b: str) -> set[tuple[str, str]]:
    return {(a, b), (b, a)}


def _incidents(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    late = set(random.sample(names, random.randint(0, len(names) - 1)) if random.random() < 0.3 else ())
    for robot in names:
        yield Incident(random.uniform(0, until_s) if robot in late else 0.0, "start", robot)
    for robot in random.sample(names, random.choice((0, random.randint(0, len(names) - 1)))):
        yield from _crashes(robot, until_s, random)
    if random.random() < 0.5:
        yield from _cuts(names, until_s, random)
    yield from _orders(mission, names, until_s, random)


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


def _orders(mission: Mission, names: Sequence[str], until_s: float, random: Random) -> Iterator[Incident]:
    """Tasks that are added and cancelled, and robots that give tasks back."""
    for k in range(random.choice((0, 0, 1, 3))):
        task = random_task(random, f"n{k}", before=[], skilled=False, once=random.random() < 0.2)
        yield Incident(random.uniform(0, until_s), "announce", random.choice(names), task=task)
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), "cancel", random.choice(names), task=random.choice(mission.tasks))
    if random.random() < 0.2:
        yield Incident(random.uniform(0, until_s), random.choice(("release", "withdraw")), random.choice(names))
