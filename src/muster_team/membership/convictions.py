"""Robots that have stated two different things, with the evidence: they are excluded for good."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster_team.knowledge.messages import Evidence, Message
from muster_team.knowledge.signatures import Signatures, convicts


@dataclass
class Convictions:
    """The convictions that one robot knows of."""

    signatures: Signatures
    evidence: dict[str, Evidence] = field(default_factory=dict)
    _unsent: list[Evidence] = field(default_factory=list)

    def convict(self, evidence: Evidence) -> bool:
        """Note evidence; return whether it convicts a robot that was not convicted before."""
        if evidence.robot in self.evidence or not convicts(evidence, self.signatures):
            return False
        self.evidence[evidence.robot] = evidence
        self._unsent.append(evidence)
        return True

    def take_unsent(self) -> tuple[Evidence, ...]:
        """The evidence that was not sent to all yet."""
        unsent, self._unsent = tuple(self._unsent), []
        return unsent

    def unknown_to(self, message: Message) -> tuple[Evidence, ...]:
        """The evidence against robots that the sender of a message still counts as members."""
        if not self.evidence:
            return ()
        members = {robot for said in message.declarations for robot in said.members if said.robot == message.sender}
        return tuple(self.evidence[robot] for robot in sorted(members & self.evidence.keys()))
