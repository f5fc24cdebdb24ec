"""Who has stated what: a proof by the key of each robot, where robots have keys of their own.

Statements are passed on by others. The team's key shows that a member has sent them, not who has stated them.
"""

from __future__ import annotations

from typing import TypeVar

from muster_team.knowledge.messages import AUTHORITY, Birth, Declaration, Evidence, Fact, Message, RoundBids

Signed = Declaration | Fact | RoundBids | Birth
S = TypeVar("S", Declaration, Fact, RoundBids, Birth)


class Signatures:
    """The proofs of one robot's statements, and those of others. These are of a team whose robots have no keys.

    Then any member is believed what it says that others have stated.
    """

    has_keys = False
    team = b""
    """A digest of the robots' public keys, which all that take part have in common."""

    def sign(self, statement: S, context: bytes = b"") -> S:
        """The robot's own statement with its proof; `context` is what it belongs to, such as the base of bids."""
        return statement

    def holds(self, statement: Signed, context: bytes = b"") -> bool:
        """Whether the robot, or the authority, that a statement names has made it; without keys there is none."""
        return statement.robot != AUTHORITY

    def proof_of(self, data: bytes) -> bytes:
        """The robot's own proof of bytes."""
        return b""

    def proves(self, robot: str, proof: bytes, data: bytes) -> bool:
        """Whether a robot has made this proof of bytes."""
        return True


NO_KEYS = Signatures()


def statement_bytes(statement: Signed, context: bytes) -> bytes:
    """What is signed: the statement without its proof, which is its last field, and what it belongs to."""
    stated = repr(statement).removesuffix(f"{statement.proof!r})")
    return f"({type(statement).__name__!r}, {context!r}, {stated}b''))".encode()


def forged_in(message: Message, signatures: Signatures) -> str:
    """The robot that has not stated what a message says that it has; empty if there is none."""
    signed: list[tuple[Signed, bytes]] = []
    signed += [(said, b"") for said in message.declarations]
    signed += [(said, b"") for said in message.births]
    signed += [(fact, b"") for fact in message.facts]
    signed += [(fact, b"") for said in message.declarations for fact in said.facts]
    signed += [(bids, message.stage.base) for bids in message.bids]
    return next((said.robot for said, context in signed if not signatures.holds(said, context)), "")


def convicts(evidence: Evidence, signatures: Signatures) -> bool:
    """Whether a robot has made both statements of the evidence, of which it may make one."""
    if not signatures.has_keys:
        return False
    first, second = evidence.first, evidence.second
    return (
        first != second
        and _occasion(first) == _occasion(second)
        and signatures.holds(first, evidence.context)
        and signatures.holds(second, evidence.context)
    )


def _occasion(said: Declaration | RoundBids) -> tuple[object, ...]:
    """What a robot states once."""
    if isinstance(said, Declaration):
        return Declaration, said.robot, said.incarnation, said.epoch
    return RoundBids, said.robot, said.round
