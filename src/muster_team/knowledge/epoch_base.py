"""The base of an epoch: who owns what when its auction begins, computed from the declarations of all members.

It is a pure function of the declarations: members with the same declarations find the same base and drop the same
claims.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from graphlib import CycleError, TopologicalSorter
from hashlib import blake2b

from muster_team.knowledge.facts import deeds, holders, in_order
from muster_team.knowledge.messages import Claim, Declaration, Fact, Reach
from muster_team.knowledge.orders import orders_among
from muster_team.knowledge.rules import Rules

Routes = dict[str, list[Claim]]

MOST_ROUNDS = 2**48
"""Rounds are counted up to this number, so that there is always room for those of the next epoch."""


@dataclass(frozen=True)
class Base:
    """Who owns what.

    Parameters
    ----------
    routes
        claims of each member, in the order of its route; tasks that were begun come first.
    facts
        all facts that any member knows.
    done, added
        of these the tasks done, in order, and those that add a task, in tie order, or move one.
    closed
        tasks that are not for sale, whoever owns them.
    held
        tasks that nobody may begin on this base: at-most-once tasks, if the members that remember are no majority, and
        tasks that wait for these.
    dropped
        (robot, task) that were declared and are not kept.
    twice
        tasks begun by several members, with these. All of them continue: work under way is never broken off.
    rounds
        the number of rounds seen in all.
    seen
        the pieces of the map that all members have.
    digest
        eight bytes; members with equal digests have the same base.
    """

    routes: Mapping[str, tuple[Claim, ...]]
    facts: frozenset[Fact]
    done: tuple[Fact, ...]
    added: tuple[Fact, ...]
    closed: frozenset[str]
    held: frozenset[str]
    dropped: tuple[tuple[str, str], ...]
    twice: Mapping[str, tuple[str, ...]]
    rounds: int
    seen: tuple[Reach, ...]
    digest: bytes

    def keeping(self, kept: Mapping[str, Sequence[str]]) -> Base:
        """The base that keeps of tasks not begun only these; the others no longer fit into their robots' routes."""
        lost = {
            (robot, claim.task)
            for robot, claims in self.routes.items()
            for claim in claims
            if not claim.begun and claim.task not in kept.get(robot, ())
        }
        if not lost:
            return self
        routes = {r: tuple(c for c in claims if (r, c.task) not in lost) for r, claims in self.routes.items()}
        return replace(self, routes=routes, dropped=(*self.dropped, *sorted(lost)))


def agreed(declarations: Sequence[Declaration], rules: Rules) -> Base:
    """The base that follows from the declarations of all members, in any order.

    A task that several robots claim stays with the one that has begun it; if nobody has, with the lowest price, then
    with the first in tie order. A robot that claims a task without knowing that it has moved loses it, unless it has
    begun it. A team keeps its task as one robot does; of several teams the one with more robots. Tasks that wait for a
    task that nobody owns or has done are dropped. Where routes wait for each other in a
    cycle the tasks that come last in tie order are dropped. Tasks that were begun are never dropped.
    """
    declarations = sorted(declarations, key=lambda declaration: rules.robots[declaration.robot])
    facts = frozenset(fact for declaration in declarations for fact in declaration.facts)
    added = orders_among(facts, rules).taken
    rules = rules.with_added(added)
    # Of a task it may be heard that it was done before it is heard that there is such a task.
    known = frozenset(fact for fact in facts if fact.task in rules.tasks)
    finished = in_order(fact for times in deeds(known).values() for found in times for fact in found)
    done = {fact.task for fact in finished}
    gone = done.union(fact.task for fact in known if fact.kind == "cancelled")
    reserved = _reserved(declarations, known)
    routes: Routes = {}
    for declaration in declarations:
        robot = declaration.robot
        stale = {fact.task for fact in added if fact.kind == "moved" and fact not in declaration.facts}
        there = [c for c in declaration.route if c.task in rules.tasks]  # an order may be refused that counted before
        kept = [c for c in there if c.task not in gone | stale and reserved.get(c.task, robot) == robot]
        routes[robot] = [*(c for c in there if c.begun), *(c for c in kept if not c.begun)]
    twice = _one_owner_each(routes, rules)
    _drop_orphans(routes, done, rules)
    while (last := _last_of_a_cycle(routes, rules)) is not None:
        for claims in routes.values():
            claims[:] = [c for c in claims if c.begun or c.task != last]
        _drop_orphans(routes, done, rules)
    still = {robot: {claim.task for claim in claims} for robot, claims in routes.items()}
    few = sum(declaration.knows for declaration in declarations) < rules.majority
    return Base(
        routes={robot: tuple(claims) for robot, claims in routes.items()},
        facts=facts,
        done=finished,
        added=added,
        closed=frozenset(gone.union(reserved, rules.once if few else ())),
        held=_with_followers(rules.once - done, routes, rules) if few else frozenset(),
        dropped=tuple((d.robot, c.task) for d in declarations for c in d.route if c.task not in still[d.robot]),
        twice=twice,
        rounds=min(max(declaration.rounds for declaration in declarations), MOST_ROUNDS),
        seen=_seen_by_all(declarations),
        digest=_digest(declarations),
    )


def _seen_by_all(declarations: Sequence[Declaration]) -> tuple[Reach, ...]:
    """The pieces of the map that all have declared to have: of each life of a robot the first ones."""
    counts = [{(one.robot, one.life): one.pieces for one in declared.seen} for declared in declarations]
    shared = set(counts[0]).intersection(*counts[1:])
    return tuple(Reach(*track, min(count[track] for count in counts)) for track in sorted(shared))


def _reserved(declarations: Sequence[Declaration], facts: frozenset[Fact]) -> dict[str, str]:
    """For each at-most-once task that may have been begun the robot that may continue; "" where that is unknown.

    Of several robots it is known if all of them are members: then it is the one that has begun, else the first to
    announce.
    """
    claims = {(d.robot, claim.task): claim for d in declarations for claim in d.route}
    reserved = {}
    for task, robots in holders(facts).items():
        claimed = [claims.get((robot, task)) for robot in robots]
        if len(robots) > 1 and None in claimed:
            reserved[task] = ""
        else:
            begun = [robot for robot, claim in zip(robots, claimed, strict=True) if claim is not None and claim.begun]
            reserved[task] = (begun or robots)[0]
    return reserved


def _one_owner_each(routes: Routes, rules: Rules) -> dict[str, tuple[str, ...]]:
    """Leave each task to one robot, or to all that have begun it; return the latter tasks with their robots."""
    owners: dict[str, list[tuple[bool, float, int, str]]] = {}
    for robot, claims in routes.items():
        for claim in claims:
            owners.setdefault(claim.task, []).append((not claim.begun, claim.price, rules.robots[robot], robot))
    twice = {}
    for task, claimants in owners.items():
        if task in rules.teams:
            _leave_to_one_team(task, routes, rules)
        elif len(claimants) > 1:
            begun = tuple(robot for waits, _, _, robot in sorted(claimants) if not waits)
            keep = begun or (min(claimants)[3],)
            if len(begun) > 1:
                twice[task] = begun
            for *_, robot in claimants:
                if robot not in keep:
                    routes[robot][:] = [claim for claim in routes[robot] if claim.task != task]
    return twice


def _leave_to_one_team(task: str, routes: Routes, rules: Rules) -> None:
    """Leave a team's task to those that won it in one sale. A team that lacks robots loses it with its schedule."""
    teams: dict[tuple[float, int], list[str]] = {}
    for robot, claims in routes.items():
        for claim in claims:
            if claim.task == task:
                teams.setdefault((claim.price, claim.round), []).append(robot)
    kept = min(teams, key=lambda sale: (-len(teams[sale]), sale, min(rules.robots[robot] for robot in teams[sale])))
    for claims in routes.values():
        claims[:] = [claim for claim in claims if claim.task != task or (claim.price, claim.round) == kept]


def _drop_orphans(routes: Routes, done: set[str], rules: Rules) -> None:
    """Drop tasks that wait for a task that nobody owns or has done."""
    while True:
        there = done.union(claim.task for claims in routes.values() for claim in claims)
        orphans = {
            claim.task
            for claims in routes.values()
            for claim in claims
            if not claim.begun and not there.issuperset(rules.prerequisites.get(claim.task, ()))
        }
        if not orphans:
            return
        for claims in routes.values():
            claims[:] = [claim for claim in claims if claim.begun or claim.task not in orphans]


def _last_of_a_cycle(routes: Routes, rules: Rules) -> str | None:
    """A task not begun that waits for itself, by routes and prerequisites; None if there is none."""
    graph: dict[str, set[str]] = {}
    begun = {claim.task for claims in routes.values() for claim in claims if claim.begun}
    for claims in routes.values():
        for k, claim in enumerate(claims):
            waits = graph.setdefault(claim.task, set())
            waits.update(rules.prerequisites.get(claim.task, ()))
            waits.update(other.task for other in claims[max(k - 1, 0) : k])
    for task in begun:
        graph[task] = set()
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        cycle: list[str] = error.args[1]
        return max((task for task in cycle if task not in begun), key=lambda task: rules.tasks[task])
    return None


def _with_followers(tasks: frozenset[str], routes: Routes, rules: Rules) -> frozenset[str]:
    """These tasks and those that wait for them, except for those that were begun."""
    begun = {claim.task for claims in routes.values() for claim in claims if claim.begun}
    found = tasks - begun
    while more := {t for t, needs in rules.prerequisites.items() if found.intersection(needs)} - begun - found:
        found |= more
    return found


def _digest(declarations: Sequence[Declaration]) -> bytes:
    return blake2b(repr([replace(d, facts=in_order(d.facts)) for d in declarations]).encode(), digest_size=8).digest()
