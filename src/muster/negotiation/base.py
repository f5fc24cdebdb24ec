"""The base of an epoch: who owns what when its auction begins, by what all members declared.

A pure function of the declarations: members that have the same ones find the same base, and drop the same claims.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from graphlib import CycleError, TopologicalSorter
from hashlib import blake2b

from muster.negotiation.messages import Claim, Declaration, Fact


@dataclass(frozen=True)
class Rules:
    """What a base must hold.

    Parameters
    ----------
    robots, tasks
        all ids, in tie order: robots and tasks that come first win ties.
    prerequisites
        of each task; empty where they are ignored.
    once
        tasks that must not be begun twice, whatever happens to the network.
    """

    robots: Mapping[str, int]
    tasks: Mapping[str, int]
    prerequisites: Mapping[str, Sequence[str]]
    once: frozenset[str] = frozenset()


@dataclass(frozen=True)
class Base:
    """Who owns what.

    Parameters
    ----------
    routes
        claims of each member, in the order of its route.
    facts
        what has been done, and begun for good, as far as any member knows.
    dropped
        (robot, task) that were declared, and are not kept.
    twice
        tasks begun by several members, with these: both go on, as work under way is never broken off.
    rounds
        rounds seen in all.
    digest
        eight bytes; members whose digests are equal have the same base.
    """

    routes: Mapping[str, tuple[Claim, ...]]
    facts: frozenset[Fact]
    dropped: tuple[tuple[str, str], ...]
    twice: Mapping[str, tuple[str, ...]]
    rounds: int
    digest: bytes


def agreed(declarations: Sequence[Declaration], rules: Rules) -> Base:
    """The base that follows from the declarations of all members, in tie order.

    A task that several claim stays with the one that has begun it; if nobody has, with the lowest price, then with the
    first in tie order. What waits for a task that nobody owns or has done is dropped, and of routes that wait for each
    other for ever the tasks that come last in tie order; work that was begun never.
    """
    facts = frozenset(fact for declaration in declarations for fact in declaration.facts)
    done = {fact.task for fact in facts if fact.done}
    taken = {fact.task: fact.robot for fact in facts if not fact.done and fact.task not in done}
    routes = {declaration.robot: list(declaration.route) for declaration in declarations}
    before = {robot: list(claims) for robot, claims in routes.items()}
    for robot, claims in routes.items():
        claims[:] = [c for c in claims if c.begun or (c.task not in done and taken.get(c.task, robot) == robot)]
    twice = _one_owner_each(routes, rules)
    _drop_orphans(routes, done, rules)
    while (last := _last_of_a_cycle(routes, rules)) is not None:
        for claims in routes.values():
            claims[:] = [c for c in claims if c.begun or c.task != last]
        _drop_orphans(routes, done, rules)
    kept = {robot: tuple(claims) for robot, claims in routes.items()}
    still = {robot: {claim.task for claim in claims} for robot, claims in kept.items()}
    dropped = tuple((robot, c.task) for robot, claims in before.items() for c in claims if c.task not in still[robot])
    rounds = max(declaration.rounds for declaration in declarations)
    return Base(kept, facts, dropped, twice, rounds, _digest(declarations, kept))


def _one_owner_each(routes: Mapping[str, list[Claim]], rules: Rules) -> dict[str, tuple[str, ...]]:
    """Leave each task to one robot, or to all that have begun it; these tasks, and their robots."""
    owners: dict[str, list[tuple[bool, float, int, str]]] = {}
    for robot, claims in routes.items():
        for claim in claims:
            owners.setdefault(claim.task, []).append((not claim.begun, claim.price, rules.robots[robot], robot))
    twice = {}
    for task, claimants in owners.items():
        if len(claimants) > 1:
            begun = tuple(robot for waits, _, _, robot in sorted(claimants) if not waits)
            keep = begun or (min(claimants)[3],)
            if len(begun) > 1:
                twice[task] = begun
            for *_, robot in claimants:
                if robot not in keep:
                    routes[robot][:] = [claim for claim in routes[robot] if claim.task != task]
    return twice


def _drop_orphans(routes: Mapping[str, list[Claim]], done: set[str], rules: Rules) -> None:
    """Drop tasks that wait for one that nobody owns or has done."""
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


def _last_of_a_cycle(routes: Mapping[str, list[Claim]], rules: Rules) -> str | None:
    """A task that waits for itself, by routes and prerequisites; None if there is none that has not been begun."""
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


def _digest(declarations: Sequence[Declaration], routes: Mapping[str, tuple[Claim, ...]]) -> bytes:
    first = declarations[0]
    said = [(d.robot, d.incarnation, d.route, sorted((f.task, f.robot, f.done) for f in d.facts)) for d in declarations]
    return blake2b(repr((first.epoch, first.members, said)).encode(), digest_size=8).digest()


def with_begun(claims: Sequence[Claim], task: str) -> tuple[Claim, ...]:
    """The claims, one of them begun."""
    return tuple(replace(claim, begun=True) if claim.task == task else claim for claim in claims)
