"""Encryption and authentication of messages: ChaCha20-Poly1305 (RFC 8439) under the key that the team shares.

A sealed message is

    version (1) | tag of the context (8) | session (12) | counter (4) | ciphertext | authenticator (16)

All of it is authenticated, and all but the first 25 bytes are encrypted. The form of this header never changes with the
version. So a peer with the right key and another version or mission is told apart from a stranger, by proof.

Nonces. Under one key of the cipher no nonce may be used twice, or the messages could be read and forged. Each process
has a session: 96 bits, the digest of 32 random bytes with the robot's id, its incarnation and the process number. Its
messages are encrypted under a key of their own, derived from the team's key and the session by keyed BLAKE2b (RFC
7693), and the nonce is a counter that begins at 0. So two messages share key and nonce only if two processes drew the
same session. A restart draws a new one, so that nothing has to be remembered; two processes with one robot id, or of
one incarnation, draw different ones; a forked process draws its own before it seals anything; a session ends after 2^32
messages. For n sessions under one key the probability of a collision is below n^2 / 2^97: 6e-18 for a million. This
rests on the machine's random numbers alone; it does not hold for a virtual machine that is copied while it runs.

Replays. For each session a window of counters is kept: a message is accepted once, in whatever order, unless it comes
after more than WINDOW later ones of its sender. A receiver that has just started has no windows yet: `peer_sessions`
protects it from messages recorded in an earlier run under the same key.

All owners of the key trust each other: a message does not prove which robot sent it.
"""

from __future__ import annotations

import os
import secrets
from collections import Counter
from dataclasses import dataclass, field
from hashlib import blake2b
from typing import TYPE_CHECKING

from muster_team.network.codec import PROTOCOL
from muster_team.network.keys import KEY_BYTES, new_key, read_key, write_key
from muster_team.network.mission_digest import mission_digest
from muster_team.network.optional_parts import require_net

if TYPE_CHECKING:
    from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305

__all__ = ["OVERHEAD", "SESSION", "WINDOW", "Seal", "mission_digest", "new_key", "read_key", "write_key"]

WINDOW = 1024
"""The number of later messages of a sender after which a message is no longer accepted."""

SESSION = 12
"""The length of a session's name in bytes."""

_TAG, _COUNTER, _AUTHENTICATOR = 8, 4, 16
_HEADER = 1 + _TAG + SESSION + _COUNTER
_LAST = 2 ** (8 * _COUNTER) - 1

OVERHEAD = _HEADER + _AUTHENTICATOR
"""The number of bytes that sealing adds to a message."""


@dataclass
class Window:
    """The last counters of a session that have arrived: bit k of `seen` is `highest` - k."""

    highest: int = -1
    seen: int = 0

    def take(self, counter: int) -> bool:
        """Note a counter; return whether it is new and not too old."""
        ahead = counter - self.highest
        if ahead > 0:
            self.seen = self.seen << min(ahead, WINDOW) & ((1 << WINDOW) - 1) | 1
            self.highest = counter
            return True
        bit = 1 << min(-ahead, WINDOW)
        if -ahead >= WINDOW or self.seen & bit:
            return False
        self.seen |= bit
        return True


@dataclass
class _Session:
    """A process that has proved that it has the key."""

    cipher: ChaCha20Poly1305
    window: Window = field(default_factory=Window)


class Seal:
    """Seals the messages of one process, and opens those that it receives.

    Parameters
    ----------
    key
        of the team: 32 bytes.
    context
        what peers must have in common: `mission_digest`.
    robot, incarnation
        the identity of the process.

    Attributes
    ----------
    session
        of this process; replaced after a fork, and when its counter is used up.
    counts
        messages that were not opened, by reason: `foreign` (made without the key, or changed on the way), `replayed`
        (or older than WINDOW others), `other_mission`, `other_version`; and `own`, which came back from a multicast
        group.

    Raises
    ------
    MissingExtraError
        if the extra `net` is not installed.
    """

    def __init__(self, key: bytes, context: bytes, robot: str, incarnation: int) -> None:
        require_net("cryptography")
        assert len(key) == KEY_BYTES
        self.counts: Counter[str] = Counter()
        self._key, self._whose = key, f"{robot} {incarnation}"
        self._tag = blake2b(context, key=key, digest_size=_TAG, person=b"muster context").digest()
        self._peers: dict[bytes, _Session] = {}
        self._begin_session()

    def close(self, data: bytes) -> bytes:
        """The bytes to send for a message."""
        if self._counter > _LAST or os.getpid() != self._process:
            self._begin_session()
        header = bytes((PROTOCOL,)) + self._tag + self.session + self._counter.to_bytes(_COUNTER, "big")
        self._counter += 1
        return header + self._cipher.encrypt(_nonce(header), data, header)

    def open(self, data: bytes) -> bytes | None:
        """The message in sealed bytes; None if it is not for this robot (see `counts`)."""
        opened = self.open_from(data)
        return None if opened is None else opened[1]

    def open_from(self, data: bytes) -> tuple[bytes, bytes] | None:
        """The sender's session and the message in sealed bytes; None if it is not for this robot."""
        from cryptography.exceptions import InvalidTag

        header = data[:_HEADER]
        session = header[1 + _TAG : -_COUNTER]
        if session == self.session:
            return self._refused("own")
        peer = self._peers.get(session) or _Session(self._cipher_of(session))
        try:
            opened = peer.cipher.decrypt(_nonce(header), data[_HEADER:], header)
        except (InvalidTag, ValueError):
            return self._refused("foreign")
        if header[0] != PROTOCOL:
            return self._refused("other_version")
        if header[1 : 1 + _TAG] != self._tag:
            return self._refused("other_mission")
        self._peers[session] = peer
        first = peer.window.take(int.from_bytes(header[-_COUNTER:], "big"))
        return (session, opened) if first else self._refused("replayed")

    def _refused(self, why: str) -> tuple[bytes, bytes] | None:
        self.counts[why] += 1
        return None

    def _begin_session(self) -> None:
        self._process, self._counter = os.getpid(), 0
        drawn = secrets.token_bytes(32) + f"{self._process} {self._whose}".encode()
        self.session = blake2b(drawn, digest_size=SESSION).digest()
        self._cipher = self._cipher_of(self.session)

    def _cipher_of(self, session: bytes) -> ChaCha20Poly1305:
        from cryptography.hazmat.primitives.ciphers.aead import ChaCha20Poly1305

        return ChaCha20Poly1305(blake2b(session, key=self._key, digest_size=32, person=b"muster session").digest())


def _nonce(header: bytes) -> bytes:
    return header[-_COUNTER:].rjust(12, b"\0")
