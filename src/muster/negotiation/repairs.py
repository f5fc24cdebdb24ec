"""Anti-entropy: what the sender of a message lacks, and whether it is this robot that sends it.

A beat tells how far its sender is and what it lacks. Of all that may have that, about HELPERS send it, all at once, as
a number drawn from the beat says, so that nobody need know who else answers; where few words are lacking, those whose
they are answer, too. Who asks for the same again and again may not hear the others at all: then all that hear it help,
and pass on in their own beats what it lacks as soon as they know it. So words go on from neighbour to neighbour where
not all hear each other.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any
from zlib import crc32

from muster.negotiation.epoch import Epoch
from muster.negotiation.knowledge import Knowledge
from muster.negotiation.messages import Message, Stage

URGENT = 3
"""Who asks so often for the same is in need."""

HELPERS = 2
"""Of those that could send what somebody lacks, about so many do; so few words each author sends itself, too."""

CROWD = 20
"""In a larger team not all that lack something ask at once, so that about so many do in `retry_s`, and for each time
that it is larger so many more help. Who is helped first goes on, and its next word helps the others."""

Round = tuple[int, int]
"""A round of an epoch; later ones are greater."""


@dataclass
class Repairs:
    """What one robot does for others.

    Parameters
    ----------
    me
        its id.
    retry_s
        who lacks something asks after so long, seconds, in a large team some later; nobody is answered twice within
        half of it, unless it has got on.
    """

    me: str
    retry_s: float
    _rounds: dict[str, Round] = field(default_factory=dict)  # of those that are heard directly
    _in_round: Counter[Round] = field(default_factory=Counter)  # how many of them are there
    _asked: dict[str, tuple[Stage, tuple[str, ...], int]] = field(default_factory=dict)  # what, and how often
    _answered: dict[str, tuple[float, Stage, int]] = field(default_factory=dict)

    def hear(self, message: Message) -> None:
        """Take in how far a robot is, and what it lacks."""
        stage = message.stage
        self._note(message.sender, (stage.epoch, stage.round))
        if message.pulses:
            asked, _, times = self._asked.get(message.sender, (None, (), 0))
            self._asked[message.sender] = stage, message.lacks, times + 1 if asked == stage else 1

    def answer(self, message: Message, epoch: Epoch, known: Knowledge, now: float) -> dict[str, Any] | None:
        """What to tell the sender of a message, as fields of one to it; None: nothing."""
        if not message.pulses:  # who has news is not waiting; if it is, its next beat tells so
            return None
        what = self._lacking(message, epoch)
        if message.known != known.digest and known.facts and self._helps(message):
            what = {**(what or {}), "facts": known.some(message.number)}
        return what if what is not None and self.may_answer(message, now) else None

    def asks_s(self, number: int, members: int) -> float:
        """How long after its message of this number the robot asks for what it lacks, in a team of so many."""
        later = crc32(f"{self.me} {number}".encode()) / 2**32 * max(0.0, members / CROWD - 1)
        return self.retry_s * (1 + later)

    def passed_on(self, epoch: Epoch) -> dict[str, Any]:
        """What robots in need lack and this one knows, with its own last words, as fields of a message."""
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
        """Whether the sender has got on since it was answered last, or that is long ago; if so, it is answered now."""
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
        if behind and (epoch.valuer.told_by_sales or (own.ended and epoch.sales)):
            known = stage.round if epoch.valuer.told_by_sales else 0
            return {"sales": tuple(epoch.sales[known:]), "sales_from": known} if self._helps(message) else None
        if stage.round <= own.round:
            bids = tuple(b for robot in self._lacked(message) if (b := epoch.bids_of(robot, stage.round)) is not None)
            return {"bids": bids} if bids else None
        return None

    def _lacked(self, message: Message) -> Sequence[str]:
        """Whose words this robot sends, of those that are lacking: its own if there are few, or all."""
        if message.lacks and self._helps(message):
            return message.lacks
        return (self.me,) if len(message.lacks) <= HELPERS and self.me in message.lacks else ()

    def _helps(self, message: Message) -> bool:
        """Whether it is this robot that sends what is lacking; to one in need always."""
        if self._asked.get(message.sender, (None, (), 0))[2] >= URGENT:
            return True
        asked = (message.stage.epoch, message.stage.round)
        able = sum(robots for at, robots in self._in_round.items() if at >= asked)  # this one in place of the sender
        return crc32(f"{message.sender} {message.number} {self.me}".encode()) % able < HELPERS * max(1.0, able / CROWD)
