"""Anti-entropy: which robots send what the sender of a heartbeat lacks.

A heartbeat states its sender's progress and what it lacks. About HELPERS of the robots that have the lacking data send
it, all at once. A hash of the heartbeat selects them, so that no robot needs to know who else answers. Where little is
lacking, its authors answer too. A robot that asks for the same repeatedly may not hear the others at all. Then all
robots that hear it answer, and relay in their own heartbeats what it lacks. So data travel from neighbour to neighbour
where not all robots hear each other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any
from zlib import crc32

from muster_team.auctions.epoch import Epoch
from muster_team.knowledge.facts import Knowledge
from muster_team.knowledge.messages import Message, Stage

URGENT = 3
"""A robot that has asked for the same this often is answered by all."""

HELPERS = 2
"""About this many robots send what a robot lacks. At most this many lacking authors send their own data too."""

CROWD = 20
"""In teams larger than this, requests are spread in time so that about this many robots ask within `retry_s`, and more
robots answer in proportion. A robot that is answered first goes on, and its next message helps the others.
"""

Round = tuple[int, int]
"""A round of an epoch; later ones are greater."""


@dataclass
class Repairs:
    """The repairs that one robot sends.

    Parameters
    ----------
    me
        its id.
    retry_s
        the time, seconds, after which a robot that lacks something asks; more in large teams. No robot is answered
        twice within half of it, unless it has made progress.
    """

    me: str
    retry_s: float
    _rounds: dict[str, Round] = field(default_factory=dict)  # of those that are heard directly
    _in_round: Counter[Round] = field(default_factory=Counter)  # how many of them are there
    _asked: dict[str, tuple[Stage, tuple[str, ...], int]] = field(default_factory=dict)  # what, and how often
    _answered: dict[str, tuple[float, Stage, int]] = field(default_factory=dict)

    def hear(self, message: Message) -> None:
        """Note the progress of a robot, and what it lacks."""
        stage = message.stage
        self._note(message.sender, (stage.epoch, stage.round))
        if message.heartbeats:
            asked, _, times = self._asked.get(message.sender, (None, (), 0))
            self._asked[message.sender] = stage, message.lacks, times + 1 if asked == stage else 1

    def answer(self, message: Message, epoch: Epoch, known: Knowledge, now: float) -> dict[str, Any] | None:
        """The fields of a message that answers a heartbeat; None: no answer."""
        if not message.heartbeats:  # a sender of news does not wait, or its next heartbeat says so
            return None
        what = self._lacking(message, epoch)
        if message.known != known.digest and known.facts and self._helps(message):
            what = {**(what or {}), "facts": known.some(message.number)}
        return what if what is not None and self.may_answer(message, now) else None

    def asks_s(self, number: int, members: int) -> float:
        """The time from the message of this number until the robot asks for what it lacks, in a team of this size."""
        later = crc32(f"{self.me} {number}".encode()) / 2**32 * max(0.0, members / CROWD - 1)
        return self.retry_s * (1 + later)

    def passed_on(self, epoch: Epoch) -> dict[str, Any]:
        """Fields of a heartbeat: what robots in need lack and this one has, and its own last statements."""
        declared, bid = {self.me}, {self.me}
        for stage, lacks, times in self._asked.values():
            if times >= URGENT and stage.epoch == epoch.stage.epoch:
                (bid if stage.base else declared).update(lacks)
        at_base = epoch.base is not None
        declarations = [epoch.declaration_of(r) for r in sorted(declared if not at_base else declared - {self.me})]
        bids = [epoch.bids_of(r, epoch.round) for r in sorted(bid)] if at_base and not epoch.ended else []
        return {
            "declarations": tuple(d for d in declarations if d is not None),
            "bids": tuple(b for b in bids if b is not None),
        }

    def _note(self, robot: str, at: Round) -> None:
        """A robot is in a round."""
        before = self._rounds.get(robot)
        if before == at:
            return
        self._rounds[robot] = at
        self._in_round[at] += 1
        if before is not None:
            self._in_round[before] -= 1
            if not self._in_round[before]:
                del self._in_round[before]

    def may_answer(self, message: Message, now: float) -> bool:
        """Whether the sender has made progress since its last answer, or that was long ago; if so, note an answer."""
        to, state = message.sender, (message.stage, message.known)
        last_s, *last = self._answered.get(to, (-1.0, None, 0))
        if tuple(last) == state and now < last_s + self.retry_s / 2:
            return False
        self._answered[to] = now, *state
        return True

    def _lacking(self, message: Message, epoch: Epoch) -> dict[str, Any] | None:
        stage, own = message.stage, epoch.stage
        if stage.epoch < own.epoch:
            return {"declarations": (epoch.own,)}
        if stage.epoch > own.epoch:
            return None
        if not stage.base:
            said = tuple(d for robot in self._lacked(message) if (d := epoch.declaration_of(robot)) is not None)
            return {"declarations": said} if said else None
        if stage.base != own.base:
            return None
        behind = stage.round < own.round or (own.ended and not stage.ended)
        if behind and (epoch.valuer.sales_suffice or (own.ended and epoch.sales)):
            known = stage.round if epoch.valuer.sales_suffice else 0
            return {"sales": tuple(epoch.sales[known:]), "sales_from": known} if self._helps(message) else None
        if stage.round <= own.round:
            bids = tuple(b for robot in self._lacked(message) if (b := epoch.bids_of(robot, stage.round)) is not None)
            return {"bids": bids} if bids else None
        return None

    def _lacked(self, message: Message) -> Sequence[str]:
        """The robots whose data this robot sends: of all lacking ones, or its own if few are lacking."""
        if message.lacks and self._helps(message):
            return message.lacks
        return (self.me,) if len(message.lacks) <= HELPERS and self.me in message.lacks else ()

    def _helps(self, message: Message) -> bool:
        """Whether this robot sends what is lacking; always for a sender in need."""
        if self._asked.get(message.sender, (None, (), 0))[2] >= URGENT:
            return True
        asked = (message.stage.epoch, message.stage.round)
        able = sum(robots for at, robots in self._in_round.items() if at >= asked)  # this one in place of the sender
        return crc32(f"{message.sender} {message.number} {self.me}".encode()) % able < HELPERS * max(1.0, able / CROWD)
