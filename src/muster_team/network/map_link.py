"""How robots share the pieces of their maps: told once, and again to those that lack them. Sans-I/O.

A robot numbers its pieces, for each of its lives. Each piece goes to all; regularly each robot tells how many it has of
every robot's, without a gap, and whoever has more sends what is lacking: its author at once, others if it goes on
lacking, as over links that do not reach all. What arrives twice, or is no piece, changes nothing.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field

from muster_team.knowledge.messages import Reach
from muster_team.network.optional_parts import require_net
from muster_team.network.plain_values import COUNT, DATA, FLAG, MalformedError, array, many, name_of, record, rows

PIECE_BYTES = 900
"""Bytes of a piece, so that its message fits into a datagram."""
AT_ONCE = 16
"""Pieces that are sent to a robot at once."""
BEATS = 2.0
"""Heartbeats between two statements of what a robot has."""
PATIENCE = 4.0
"""Statements of a robot after which others than the author send what it goes on lacking."""
MOST_LIVES = 1000
"""Lives of robots of which pieces are kept."""
MOST_EARLY = 500
"""Pieces of a life that are kept before those before them have come."""

Track = tuple[str, int]
"""Whose pieces: the robot, and the number of its life."""
Outgoing = tuple[bytes, str | None]
"""A message, and the robot that it is for; None: all."""


@dataclass(frozen=True, slots=True)
class _Piece:
    """A piece: whose, its number, what it is."""

    robot: str
    life: int
    number: int
    content: bytes


@dataclass
class _Peer:
    """What another robot has said of what it has."""

    counts: dict[Track, int] = field(default_factory=dict)
    since_s: dict[Track, float] = field(default_factory=dict)  # when it said so first


class MapLink:
    """The pieces that one robot knows, and its messages about them.

    Parameters
    ----------
    robot, life : str, int
        The robot, and the number of its start.
    robots : sequence of str
        All robots of the team, in the order that all know.
    beat_s : float
        The time between two heartbeats of the team, seconds.

    Raises
    ------
    MissingExtraError
        If the extra `net` is not installed.
    """

    def __init__(self, robot: str, life: int, robots: Sequence[str], beat_s: float) -> None:
        require_net("msgpack")
        import msgpack

        self._packb, self._unpackb = msgpack.packb, msgpack.unpackb
        self._robot, self._own = robot, (robot, life)
        self._robots, self._beat_s = frozenset(robots), BEATS * beat_s
        name = name_of(robots)
        self._name = name
        self._reaches = rows(record(Reach, robot=name, life=COUNT, pieces=COUNT), 3)
        self._pieces = many(record(_Piece, robot=name, life=COUNT, number=COUNT, content=DATA))
        self._known: dict[Track, list[bytes]] = {}
        self._early: dict[Track, dict[int, bytes]] = {}
        self._new: list[tuple[Track, bytes]] = []
        self._untold: list[_Piece] = []
        self._peers: dict[str, _Peer] = {}
        self._due_s = -math.inf

    @property
    def reach(self) -> tuple[Reach, ...]:
        """How many pieces the robot has of each life of a robot, without a gap."""
        return tuple(Reach(*track, len(self._known[track])) for track in sorted(self._known))

    def add(self, contents: Iterable[bytes]) -> None:
        """Tell the others these pieces of the robot's own map."""
        for content in contents:
            number = len(self._known.get(self._own, ()))
            self._untold.append(_Piece(*self._own, number, content))
            self._take(self._untold[-1])

    def take_new(self) -> list[tuple[Track, bytes]]:
        """Return the pieces that have come since the last call, its own included, those of each life in order."""
        new, self._new = self._new, []
        return new

    def handle(self, data: bytes, now: float) -> list[Outgoing]:
        """Process a message; return those to send.

        Raises
        ------
        MalformedError
            If it is none, or of a robot that there is not. Nothing has changed then.
        """
        sender, states, reaches, pieces = self._read(data)
        for piece in pieces:
            self._take(piece)
        return self._answer(sender, reaches, now) if states else []

    def tick(self, now: float) -> list[Outgoing]:
        """Let time pass; return the messages to send."""
        out: list[Outgoing] = [(self._message(None, [piece]), None) for piece in self._untold]
        self._untold.clear()
        if now >= self._due_s:
            self._due_s = now + self._beat_s
            out.append((self._message(self.reach, ()), None))
        return out

    def _message(self, reaches: Sequence[Reach] | None, pieces: Sequence[_Piece]) -> bytes:
        states = reaches is not None
        plain = [self._name.pack(self._robot), states, self._reaches.pack(reaches or ()), self._pieces.pack(pieces)]
        packed: bytes = self._packb(plain)
        return packed

    def _read(self, data: bytes) -> tuple[str, bool, tuple[Reach, ...], tuple[_Piece, ...]]:
        try:
            plain = self._unpackb(data, raw=False)
        except (ValueError, TypeError) as error:
            raise MalformedError(str(error)) from None
        if len(array(plain)) != 4:
            raise MalformedError("not a message of maps")
        sender, states = self._name.unpack(plain[0]), FLAG.unpack(plain[1])
        reaches, pieces = self._reaches.unpack(plain[2]), self._pieces.unpack(plain[3])
        if not self._robots.issuperset({sender, *(one.robot for one in (*reaches, *pieces))}):
            raise MalformedError("a robot that there is not")
        return sender, states, reaches, pieces

    def _take(self, piece: _Piece) -> None:
        """Keep a piece that is new; those that follow it and have come before it are no longer early."""
        track = (piece.robot, piece.life)
        if track not in self._known and len(self._known) >= MOST_LIVES:
            return
        known, early = self._known.setdefault(track, []), self._early.setdefault(track, {})
        if piece.number > len(known) and len(early) < MOST_EARLY:
            early.setdefault(piece.number, piece.content)
        elif piece.number == len(known):
            early[piece.number] = piece.content
        while (content := early.pop(len(known), None)) is not None:
            known.append(content)
            self._new.append((track, content))

    def _answer(self, sender: str, reaches: Sequence[Reach], now: float) -> list[Outgoing]:
        """Return what a robot lacks that has just stated what it has."""
        peer, out = self._peers.setdefault(sender, _Peer()), list[Outgoing]()
        stated = {(one.robot, one.life): one.pieces for one in reaches}
        for track, known in self._known.items():
            count = stated.get(track, 0)
            if count != peer.counts.get(track):
                peer.counts[track], peer.since_s[track] = count, now
            waits_s = 0.0 if track == self._own else PATIENCE * self._beat_s
            lacking = known[count : count + AT_ONCE] if now >= peer.since_s[track] + waits_s else []
            pieces = [_Piece(*track, number, content) for number, content in enumerate(lacking, count)]
            out += [(self._message(None, [piece]), sender) for piece in pieces]
        return out
