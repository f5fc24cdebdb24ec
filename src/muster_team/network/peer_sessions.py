"""Replay protection across runs: messages count only from processes that have proved that they hear this one.

An attacker who has recorded messages of an earlier run under the same key could replay them to a process that has just
started, and so pretend that robots are present. Therefore a message of a process is held back until that process has
sent something that names this process's session, 96 random bits that nobody could know before (see `encryption`).
Processes exchange these proofs in greetings:

    asks: sessions that are heard and have not proved themselves | answers: sessions that have asked for a proof

Each entry names the session for which it is a proof. Two processes that hear each other know each other after one
message in each direction; after a loss, an unproven process is asked again whenever it sends something.

Sans-I/O. A process that hears another but is not heard by it does not process its messages.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, field

from muster_team.network.encryption import OVERHEAD, SESSION, Seal

KEPT = 32
"""The number of messages kept of a process that has not proved itself; of more the oldest are dropped."""
STRANGERS = 256
"""The number of unproven processes of which messages are kept; of more the first ones are dropped."""
REST_S = 0.05
"""The shortest time between two requests for a proof to the same process, seconds."""

_MESSAGE, _GREETING = b"\0", b"\1"


@dataclass
class _UnprovenPeer:
    kept: deque[bytes] = field(default_factory=lambda: deque(maxlen=KEPT))
    asked_s: float = float("-inf")
    speaks: bool = True  # since it was asked


class PeerSessions:
    """Seals and opens messages, and tells which greetings to send to all.

    Attributes
    ----------
    counts
        as `Seal.counts`, and `unproven`: messages held back because their sender has not proved itself.
    """

    def __init__(self, seal: Seal) -> None:
        self._seal = seal
        self._known: set[bytes] = set()
        self._strangers: dict[bytes, _UnprovenPeer] = {}
        self._owed: dict[bytes, None] = {}  # answers
        self._unproven = 0

    @property
    def counts(self) -> Counter[str]:
        return self._seal.counts + Counter(unproven=self._unproven)

    def close(self, data: bytes) -> bytes:
        """The bytes to send for a message."""
        return self._seal.close(_MESSAGE + data)

    def open(self, data: bytes) -> list[bytes]:
        """The messages that may be read now: this one, and earlier ones of its sender if it has just proved itself."""
        opened = self._seal.open_from(data)
        if opened is None:
            return []
        session, said = opened
        kind, said = said[:1], said[1:]
        if kind == _GREETING:
            return self._take_greeting(session, said)
        if session in self._known:
            return [said]
        stranger = self._stranger(session)
        stranger.speaks = True
        stranger.kept.append(said)
        self._unproven += 1
        return []

    def greetings(self, now: float, room: int) -> list[bytes]:
        """The greetings to send to all now; each fits into `room` bytes once it is sealed."""
        asks = [session for session, one in self._strangers.items() if one.speaks and now >= one.asked_s + REST_S]
        for session in asks:
            self._strangers[session].asked_s, self._strangers[session].speaks = now, False
        names = [b"\1" + session for session in asks] + [b"\0" + session for session in self._owed]
        self._owed.clear()
        most = max(1, (room - OVERHEAD - 1) // (SESSION + 1))
        return [self._seal.close(_GREETING + b"".join(names[k : k + most])) for k in range(0, len(names), most)]

    def _take_greeting(self, session: bytes, said: bytes) -> list[bytes]:
        size = SESSION + 1
        for asks, named in ((said[k : k + 1], said[k + 1 : k + size]) for k in range(0, len(said), size)):
            if named == self._seal.session:
                if asks == b"\1":
                    self._owed[session] = None
                return self._meet(session)
        if session not in self._known:
            self._stranger(session).speaks = True
        return []

    def _meet(self, session: bytes) -> list[bytes]:
        """A process has proved itself; return the messages that were held back."""
        self._known.add(session)
        stranger = self._strangers.pop(session, None)
        kept = [] if stranger is None else list(stranger.kept)
        self._unproven -= len(kept)
        return kept

    def _stranger(self, session: bytes) -> _UnprovenPeer:
        if session not in self._strangers and len(self._strangers) >= STRANGERS:
            del self._strangers[next(iter(self._strangers))]
        return self._strangers.setdefault(session, _UnprovenPeer())
