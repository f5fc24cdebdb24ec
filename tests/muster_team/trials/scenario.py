"""Random scenarios of trials, by a seed: mission, terms, conditions, links, and incidents with their times."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import asdict, dataclass, field, replace
from itertools import permutations
from random import Random
from typing import Any

from tests.muster_team.trials.faults import Incident, Links, incidents
from tests.muster_team.trials.moving_partitions import moving_partitions
from tests.muster_team.trials.random_missions import random_mission, with_times

from muster.allocation.auctions import consensus_bundle
from muster.allocation.auctions.auction import Parameters
from muster.allocation.auctions.auction_terms import BIDS, PLACEMENTS, WINNERS
from muster.mission.model import Mission
from muster_team.membership.members import Timeouts
from muster_team.network.memory_network import LinkConditions

MOVING_PARTITIONS = 0.3
"""The share of scenarios with moving partitions."""

BUNDLES = 0.25
"""The share of scenarios in which robots agree by consensus-bundle."""


@dataclass(frozen=True)
class Scenario:
    """The scenario of one trial.

    Parameters
    ----------
    method, terms
        a name of METHODS, and its parameters.
    links
        the direct links; None: between all robots.
    work_s
        the time that a robot needs for a task; None: robots agree only.
    begin_probability
        the probability with which an idle robot begins one of its tasks in the next tenth of a second.
    timeouts
        of the robots.
    incidents
        in no order.
    quiet_s
        the time of the last incident; after it there are network errors only.
    """

    seed: int
    mission: Mission
    method: str
    terms: Any
    conditions: LinkConditions
    links: Links | None
    work_s: float | None
    incidents: tuple[Incident, ...]
    quiet_s: float
    begin_probability: float = 1.0
    timeouts: Timeouts = field(default_factory=Timeouts)

    def described(self) -> Iterator[str]:
        """Lines for people."""
        conditions = self.conditions
        terms = ", ".join(f"{name} {value}" for name, value in asdict(self.terms).items())
        mission = self.mission
        yield f"seed {self.seed}: {len(mission.robots)} robots, {len(mission.tasks)} tasks; {self.method}, {terms}"
        yield f"loss {conditions.loss:.0%}, delay {conditions.delay_s:.3f} s and up to {conditions.jitter_s:g} s"
        yield f"suspected after {self.timeouts.suspect_s:g} s; begin probability {self.begin_probability:g}"
        yield f"duplication {conditions.duplication:.0%}; work {self.work_s or 0:g} s; quiet at {self.quiet_s:.2f} s"
        if self.links is not None:
            yield "links " + ", ".join(f"{a} > {b}" for a, b in sorted(self.links))
        for what in sorted(self.incidents, key=lambda incident: incident.at_s):
            groups = " | ".join(" ".join(group) for group in what.groups)
            links = ", ".join(f"{a} > {b}" for a, b in sorted(what.links))
            task = "" if what.task is None else what.task.id
            yield f"{what.at_s:8.3f} s {what.kind} {what.robot}{groups}{links} {task}".rstrip()


def scenario_of(seed: int, *, timed: bool = False) -> Scenario:
    """The scenario of a seed; `timed`: the same faults, of a mission whose tasks are bound to times."""
    random = Random(f"negotiation {seed}")
    make = _with_moving_partitions if random.random() < MOVING_PARTITIONS else _with_random_faults
    scenario = make(seed, random)
    return _timed(scenario, Random(f"times {seed}")) if timed else scenario


def _timed(scenario: Scenario, random: Random) -> Scenario:
    """The same, of a mission on which robots agree by the auction alone."""
    terms = Parameters(
        bid=random.choice((None, *(bid for bid in BIDS if bid != "average-as-printed"))),
        placement=random.choice(PLACEMENTS),
        winner=random.choice(WINNERS),
    )
    return replace(scenario, mission=with_times(scenario.mission, random), method="auction", terms=terms)


def _with_random_faults(seed: int, random: Random) -> Scenario:
    """A team with faults of all kinds while it agrees."""
    robots = random.choice((2, 3, 4, 5, 6, 7, random.randint(8, 12)))
    once = random.choice((0.0, 0.0, 0.2, 0.5))
    mission = random_mission(random, robots=robots, tasks=random.randint(1, 14), once=once)
    names = [robot.id for robot in mission.robots]
    quiet_s = random.uniform(5, 30) if random.random() < 0.2 else random.uniform(1, 8)
    return Scenario(
        seed,
        mission,
        *_terms(random),
        conditions=_conditions(random),
        links=_links(names, random) if random.random() < 0.25 else None,
        work_s=random.choice((None, random.uniform(0.3, 3.0))),
        incidents=tuple(incidents(mission, names, quiet_s, random)),
        quiet_s=quiet_s,
    )


def _with_moving_partitions(seed: int, random: Random) -> Scenario:
    """A small team that carries out tasks, most of them at-most-once, under moving partitions."""
    robots, tasks = random.choice((2, 3, 3, 3, 4, 5)), random.randint(1, 9)
    once, free = random.choice((0.6, 1.0, 1.0)), random.random() < 0.8
    mission = random_mission(random, robots=robots, tasks=tasks, once=once, free=free)
    names, conditions, timeouts = [robot.id for robot in mission.robots], _conditions(random), Timeouts()
    if random.random() < 0.7:  # robots with short timeouts can be lost more often, but must hear most heartbeats
        timeouts = Timeouts(suspect_s=1.2, bid_s=1.8, exclusion_s=1.5)
        conditions = LinkConditions(
            loss=0.3 * conditions.loss, delay_s=0.3 * conditions.delay_s, jitter_s=0.1 * conditions.jitter_s
        )
    quiet_s = timeouts.suspect_s * random.uniform(5, 20)
    return Scenario(
        seed,
        mission,
        *_terms(random),
        conditions=conditions,
        links=None,
        work_s=timeouts.suspect_s * random.choice((random.uniform(0.1, 0.4), random.uniform(0.4, 1.5))),
        incidents=tuple(moving_partitions(mission, names, quiet_s, timeouts.suspect_s, random)),
        quiet_s=quiet_s,
        begin_probability=random.choice((0.1, 0.3, 0.6)),
        timeouts=timeouts,
    )


def _terms(random: Random) -> tuple[str, Any]:
    """The name and the parameters of the method by which robots agree."""
    if random.random() < BUNDLES:
        return "consensus-bundle", consensus_bundle.Parameters()
    terms = Parameters(bid=random.choice(BIDS), placement=random.choice(PLACEMENTS), winner=random.choice(WINNERS))
    return "auction", terms


def _conditions(random: Random) -> LinkConditions:
    return LinkConditions(
        loss=random.choice((0.0, random.uniform(0, 0.5))),
        delay_s=random.uniform(0.001, 0.1),
        jitter_s=random.choice((0.0, 0.05, 0.3)),
        duplication=random.choice((0.0, 0.2)),
    )


def _links(names: Sequence[str], random: Random) -> Links:
    """A random tree with additional links; sometimes these, and some of the tree, are one-way."""
    links, one_way, broken = set[tuple[str, str]](), random.random() < 0.3, random.choice((0.0, 0.2))
    for k in range(1, len(names)):
        a, b = names[k], names[random.randrange(k)]
        links |= _link(a, b) if not one_way or random.random() >= broken else {random.choice(((a, b), (b, a)))}
    for a, b in permutations(names, 2):
        if random.random() < 0.1:
            links |= {(a, b)} if one_way else _link(a, b)
    return frozenset(links)


def _link(a: str, b: str) -> set[tuple[str, str]]:
    return {(a, b), (b, a)}
