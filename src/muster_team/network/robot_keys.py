"""Keys of robots, beside the team's: Ed25519 (RFC 8032). Each robot has one of its own; all know the public ones."""

from __future__ import annotations

import json
from collections.abc import Collection, Mapping
from dataclasses import replace
from hashlib import blake2b
from pathlib import Path
from typing import TYPE_CHECKING

from muster.mission.errors import Finding, InputError
from muster_team.knowledge.messages import AUTHORITY, Fact
from muster_team.knowledge.signatures import S, Signatures, Signed, statement_bytes
from muster_team.network.keys import KEY_BYTES
from muster_team.network.optional_parts import require_net

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PublicKey

PROOF_BYTES = 64

_KEPT = 100_000  # proofs that were checked before


class RobotKeys(Signatures):
    """The key of one robot, and the public keys of all.

    Parameters
    ----------
    key
        of the robot: 32 bytes, which nobody else knows.
    roster
        for each robot of the team its public key, 32 bytes.
    context
        what robots must have in common: `mission_digest`. A proof holds in no other mission.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    """

    has_keys = True

    def __init__(self, key: bytes, roster: Mapping[str, bytes], context: bytes) -> None:
        require_net("cryptography")
        from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey, Ed25519PublicKey

        self._key, self._context = Ed25519PrivateKey.from_private_bytes(key), context
        self._roster: dict[str, Ed25519PublicKey] = {
            robot: Ed25519PublicKey.from_public_bytes(public) for robot, public in roster.items()
        }
        self.team = blake2b(json.dumps({r: key.hex() for r, key in sorted(roster.items())}).encode()).digest()
        self._held: set[bytes] = set()

    def sign(self, statement: S, context: bytes = b"") -> S:
        return replace(statement, proof=self.proof_of(statement_bytes(statement, context)))

    def holds(self, statement: Signed, context: bytes = b"") -> bool:
        return self.proves(statement.robot, statement.proof, statement_bytes(statement, context))

    def proof_of(self, data: bytes) -> bytes:
        return self._key.sign(self._context + data)

    def proves(self, robot: str, proof: bytes, data: bytes) -> bool:
        from cryptography.exceptions import InvalidSignature

        if robot not in self._roster or len(proof) != PROOF_BYTES:
            return False
        name = blake2b(proof + data, digest_size=16, key=robot.encode()[:64]).digest()
        if name in self._held:
            return True
        try:
            self._roster[robot].verify(proof, self._context + data)
        except InvalidSignature:
            return False
        if len(self._held) >= _KEPT:
            self._held.clear()
        self._held.add(name)
        return True


def public_key(key: bytes) -> bytes:
    """The public key that belongs to a robot's key."""
    require_net("cryptography")
    from cryptography.hazmat.primitives.asymmetric.ed25519 import Ed25519PrivateKey

    return Ed25519PrivateKey.from_private_bytes(key).public_key().public_bytes_raw()


def revocation(robot: str, key: bytes, context: bytes) -> Fact:
    """The order that revokes a robot's key in a mission, signed by the key of the authority.

    Parameters
    ----------
    robot
        the robot that no longer takes part.
    key
        of the authority: 32 bytes, whose public key stands under AUTHORITY in the roster.
    context
        as of `RobotKeys`. The order holds in no other mission.
    """
    return RobotKeys(key, {}, context).sign(Fact(robot, AUTHORITY, "revoked"))


def order_line(order: Fact) -> str:
    """A revocation as a line of text."""
    return json.dumps({"revoked": order.task, "proof": order.proof.hex()})


def order_of(line: str) -> Fact | None:
    """The revocation in a line of text; None if there is none in it. Whether it counts is for `Negotiator.revoke`."""
    try:
        data = json.loads(line)
        order = Fact(data["revoked"], AUTHORITY, "revoked", proof=bytes.fromhex(data["proof"]))
    except (ValueError, KeyError, TypeError, RecursionError):
        return None
    return order if type(order.task) is str else None


def read_roster(path: Path, robots: Collection[str]) -> dict[str, bytes]:
    """The public keys of a team: a JSON object from robots, and AUTHORITY, to 64 hexadecimal digits.

    Raises
    ------
    InputError
        if the file cannot be read, or does not hold a key of each robot.
    """
    try:
        data = json.loads(path.read_text(encoding="utf-8"))
        roster = {str(robot): bytes.fromhex(digits) for robot, digits in data.items()}
    except OSError as error:
        raise _error(path, "", str(error.strerror)) from None
    except (UnicodeError, ValueError, AttributeError, TypeError):
        raise _error(path, "", "other content") from None
    if AUTHORITY in robots:
        raise _error(path, AUTHORITY, "a robot of this name")
    for robot in [*robots, *(name for name in roster if name == AUTHORITY)]:
        if len(roster.get(robot, b"")) != KEY_BYTES:
            raise _error(path, robot, "no key" if robot not in roster else "a key of another length")
    return roster


def _error(path: Path, robot: str, value: str) -> InputError:
    expected = f"for each robot its public key, {2 * KEY_BYTES} hexadecimal digits"
    return InputError([Finding(str(path), None, robot or "roster", value, expected)])
