"""The one entrance for what robots state: a statement is admitted before anything believes, keeps or passes it on.

A message that the team's key opens and the codec reads may still say what no robot can mean: a robot that there is not,
a counter without room above it, an order that is no task. A robot that follows the protocol never says such things, so
the whole message is refused. Whether an order fits into the mission depends on other orders: see `orders`.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Collection, Iterable, Iterator
from dataclasses import replace
from typing import Any

from muster.mission.errors import MissionError
from muster.mission.value_types import shown
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.joint_statements import presence_fault
from muster_team.knowledge.messages import (
    AUTHORITY,
    FACTS,
    ORDERS,
    PRESENCE,
    Claim,
    Declaration,
    Fact,
    Heartbeat,
    Message,
    RoundBids,
    Sold,
    Stage,
)
from muster_team.knowledge.new_tasks import task_of
from muster_team.knowledge.rules import Rules
from muster_team.knowledge.signatures import NO_KEYS, Signatures, forged_in
from muster_team.knowledge.verdicts import TAKEN, Refused, Taken

MOST = 2**53
"""The largest number that a counter may have arrived at. Incarnations, milliseconds since 1970, stay far below."""

LONGEST_NAME = 200
"""The longest name of a task, characters."""

LONGEST_ORDER = 2**16
"""The longest task of an order, bytes."""

_LONGEST_NUMBER = 20  # digits of an incarnation

Statement = Message | Declaration | Claim | Fact | RoundBids | Sold | Heartbeat | Stage


def admit(rules: Rules, statement: Statement, signatures: Signatures = NO_KEYS) -> Taken | Refused:
    """Whether a statement may be believed in a mission with these rules; it does not raise, whatever is in it.

    Of a message all that robots state in it is held against their `signatures`, and so is a fact that was remembered.
    """
    fault = next(_faults(rules, statement), None)
    if fault is None and isinstance(statement, Message) and (robot := forged_in(statement, signatures)):
        fault = f"a statement that {shown(robot)} has not made"
    if fault is None and isinstance(statement, Fact) and not signatures.holds(statement):
        fault = f"a fact that {shown(statement.robot)} has not stated"
    return TAKEN if fault is None else Refused(fault)


def healed(memory: Memory, rules: Rules, signatures: Signatures) -> tuple[Memory, list[str]]:
    """What was remembered, without what no robot can mean, and why that was left out.

    A robot that has lost something so does not count as one that remembers everything.
    """
    refused: list[str] = []

    def is_admitted(statement: Statement) -> bool:
        verdict = admit(rules, statement, signatures)
        refused.extend([verdict.reason] if isinstance(verdict, Refused) else [])
        return isinstance(verdict, Taken)

    kept = replace(
        memory,
        claims=tuple(filter(is_admitted, memory.claims)),
        facts=tuple(filter(is_admitted, memory.facts)),
        reserved=tuple(filter(is_admitted, memory.reserved)),
        epoch=memory.epoch if is_admitted(Stage(memory.epoch)) else 0,
    )
    return replace(kept, knows=kept.knows and not refused), refused


def _faults(rules: Rules, statement: Statement) -> Iterator[str]:
    return _FAULTS[type(statement)](rules, statement)


def _message(rules: Rules, said: Message) -> Iterator[str]:
    yield from _robots(rules, [said.sender, *said.lacks, *said.agreed, *said.unheard])
    yield from _counts("number", [said.incarnation, said.number, said.sales_from])
    parts: tuple[Statement, ...] = (said.stage, *said.declarations, *said.bids, *said.sales, *said.heartbeats)
    for part in (*parts, *said.facts):
        yield from _faults(rules, part)
    yield from _robots(rules, (birth.robot for birth in said.births))
    yield from _counts("incarnation", [birth.incarnation for birth in said.births])
    yield from _robots(rules, (evidence.robot for evidence in said.evidence))


def _stage(rules: Rules, stage: Stage) -> Iterator[str]:
    yield from _counts("epoch or round", [stage.epoch, stage.round])


def _declaration(rules: Rules, said: Declaration) -> Iterator[str]:
    yield from _robots(rules, [said.robot, *said.members])
    yield from _counts("number", [said.incarnation, said.epoch, said.rounds])
    if said.robot not in said.members or len(set(said.members)) < len(said.members):
        yield f"members {', '.join(said.members) or 'none'} of {shown(said.robot)}"
    if len(said.incarnations) != len(said.members):
        yield f"{len(said.incarnations)} incarnations of {len(said.members)} members"
    yield from _counts("incarnation", [number for number in said.incarnations if number != -1])
    yield from _robots(rules, [one.robot for one in said.seen])
    yield from _counts("number of pieces", [number for one in said.seen for number in (one.life, one.pieces)])
    known = {fact.task for fact in said.facts if fact.kind == "added"}
    claimed: set[str] = set()
    for claim in said.route:
        if claim.task in claimed or not (claim.task in rules.tasks or claim.task in known):
            yield f"a claim to {shown(claim.task)}, which there is not, or a second one"
        claimed.add(claim.task)
        yield from _claim(rules, claim)
    for fact in said.facts:
        yield from _fact(rules, fact)


def _claim(rules: Rules, claim: Claim) -> Iterator[str]:
    yield from _names([claim.task])
    yield from _prices([claim.price])
    yield from _counts("round", [claim.round])
    if type(claim.begun) is not bool:
        yield f"begun: {shown(claim.begun)}"


def _bids(rules: Rules, said: RoundBids) -> Iterator[str]:
    yield from _robots(rules, [said.robot])
    yield from _counts("round", [said.round])
    yield from _names(task for task, _ in said.bids)
    yield from _prices(price for _, price in said.bids)


def _sold(rules: Rules, sold: Sold) -> Iterator[str]:
    yield from _robots(rules, (robot for robot, _ in sold.assignments))
    yield from _names(task for _, task in sold.assignments)
    yield from _prices([sold.price])


def _heartbeat(rules: Rules, heartbeat: Heartbeat) -> Iterator[str]:
    yield from _robots(rules, [heartbeat.robot])
    yield from _counts("incarnation or number", [heartbeat.incarnation, heartbeat.number])


def _fact(rules: Rules, fact: Fact) -> Iterator[str]:
    if fact.kind == "revoked":
        yield from _robots(rules, [fact.task])
        yield from () if fact.robot == AUTHORITY else [f"a revocation by {shown(fact.robot)}"]
    else:
        yield from _robots(rules, [fact.robot])
    yield from _names([fact.task])
    yield from _counts("order", [fact.order])
    if fact.kind not in FACTS or type(fact.content) is not bytes:
        yield f"a fact of the kind {shown(fact.kind)}"
    elif fact.kind in ORDERS:
        yield from _order(fact)
    elif fact.kind in PRESENCE:
        yield from presence_fault(fact.kind, fact.content, rules.robots)
    elif fact.kind in ("begun", "waived"):
        if not (fact.content.isdigit() and len(fact.content) <= _LONGEST_NUMBER):
            yield f"{fact.kind} in the incarnation {fact.content[:_LONGEST_NUMBER]!r}"
    elif fact.content:
        yield f"{fact.kind} with {fact.content[:_LONGEST_NUMBER]!r}"


def _order(fact: Fact) -> Iterator[str]:
    if len(fact.content) > LONGEST_ORDER:
        yield f"a task of {len(fact.content)} bytes"
        return
    try:
        task = task_of(fact.content)
    except MissionError as error:
        yield f"{fact.kind}: {error}"
        return
    if task.id != fact.task:
        yield f"the task {shown(task.id)} under the name {shown(fact.task)}"


def _robots(rules: Rules, names: Iterable[Any]) -> Iterator[str]:
    strangers = (name for name in names if type(name) is not str or name not in rules.robots)
    return (f"the robot {shown(name)}, which there is not" for name in strangers)


def _names(names: Iterable[Any]) -> Iterator[str]:
    wrong = (name for name in names if type(name) is not str or not 0 < len(name) <= LONGEST_NAME)
    return (f"the task {shown(name)}" for name in wrong)


def _counts(what: str, counts: Collection[Any]) -> Iterator[str]:
    wrong = (count for count in counts if type(count) is not int or not 0 <= count <= MOST)
    return (f"the {what} {shown(count)}" for count in wrong)


def _prices(prices: Iterable[Any]) -> Iterator[str]:
    wrong = (price for price in prices if type(price) not in (int, float) or not math.isfinite(price))
    return (f"the price {shown(price)}" for price in wrong)


_FAULTS: dict[type, Callable[[Rules, Any], Iterator[str]]] = {
    Message: _message,
    Stage: _stage,
    Declaration: _declaration,
    Claim: _claim,
    RoundBids: _bids,
    Sold: _sold,
    Heartbeat: _heartbeat,
    Fact: _fact,
}
