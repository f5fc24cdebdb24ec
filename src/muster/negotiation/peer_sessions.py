"""Whose messages are of this run: those of processes that have proved that they hear this one.

Who has recorded what robots said in an earlier run under the same key could play it back to one that has just started,
and make robots appear that are not there. So a message of a process is kept until that process has said something that
names this one's session, which nobody could know before: 96 random bits (see `seal`). Processes that meet ask each
other for that by greetings:

    asks: sessions that are heard, and have not proved themselves | answers: sessions that have asked for a proof

each of which names the session for which it is a proof. Two processes that hear each other have met after one message
each way, or when one that was lost is repeated: who is not known yet is asked again whenever it speaks.

Sans-I/O. A process that hears another, but is not heard by it, does not take in its words.
"""

from __future__ import annotations

from collections import Counter, deque
from dataclasses import dataclass, field

from muster.negotiation.encryption import OVERHEAD, SESSION, Seal

KEPT = 32
"""Messages of one process that are kept until it has proved itself; of more the oldest go."""
STRANGERS = 256
"""Processes of which messages are kept; of more those that have come first go."""
REST_S = 0.05
"""Nobody is asked twice within so long, seconds."""

_MESSAGE, _GREETING = b"\0", b"\1"


@dataclass
class _Stranger:
    kept: deque[bytes] = field(default_factory=lambda: deque(maxlen=KEPT))
    asked_s: float = float("-inf")
    speaks: bool = True  # since it was asked


class Acquaintance:
    """Closes and opens messages, and tells which greetings are to be sent to all.

    Attributes
    ----------
    counts
        as `Seal.counts`, and `unproven`: messages that were not taken in, or not yet, as their sender has not proved
        that it hears this process.
    """

    def __init__(self, seal: Seal) -> None:
        self._seal = seal
        self._known: set[bytes] = set()
        self._strangers: dict[bytes, _Stranger] = {}
        self._owed: dict[bytes, None] = {}  # answers
        self._unproven = 0

    @property
    def counts(self) -> Counter[str]:
        return self._seal.counts + Counter(unproven=self._unproven)

    def close(self, data: bytes) -> bytes:
        """What is to be sent of this."""
        return self._seal.close(_MESSAGE + data)

    def open(self, data: bytes) -> list[bytes]:
        """The messages that may be read now: this one, and those that its sender sent before it had proved itself."""
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
        """What is to be sent to all now; each fits into `room` bytes once it is closed."""
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
        """A process has proved itself; what it has said before."""
        self._known.add(session)
        stranger = self._strangers.pop(session, None)
        kept = [] if stranger is None else list(stranger.kept)
        self._unproven -= len(kept)
        return kept

    def _stranger(self, session: bytes) -> _Stranger:
        if session not in self._strangers and len(self._strangers) >= STRANGERS:
            del self._strangers[next(iter(self._strangers))]
        return self._strangers.setdefault(session, _Stranger())
