"""Runs a negotiator: connects it with codec, seal, transport and clock. No threads."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from types import TracebackType
from typing import Protocol, Self

from muster.mission.system.clock import Clock, SystemClock
from muster_team.knowledge.effects import Outgoing
from muster_team.knowledge.messages import RoundBids, Sold
from muster_team.negotiators.negotiator import Negotiator
from muster_team.network.codec import Codec, OtherVersionError
from muster_team.network.encryption import OVERHEAD, Seal
from muster_team.network.peer_sessions import PeerSessions
from muster_team.network.plain_values import MalformedError
from muster_team.network.robot_keys import PROOF_BYTES
from muster_team.network.transport import Transport

BESIDE = b"\xff"
"""The first byte of messages beside the negotiation, which is that of no version of the protocol."""

_LOOK_S = 0.25
"""The longest time between two evaluations of the end condition of `run`."""


@dataclass(frozen=True, kw_only=True)
class NodeStatus:
    """The state of a robot's negotiation at one moment, for tables.

    Parameters
    ----------
    robot, members, silent
        its id; the members of its epoch; robots of the team that do not take part.
    epoch, round
        the number of the epoch, and of the rounds resolved in it.
    bid
        its bid in this round, or else in the last one; None before that.
    last_sale
        the result of the last round; None before that.
    settled
        whether all members are known to agree, and nobody bids any more.
    sent, sent_bytes, received
        messages sent by kind (`news`, `repairs`, `heartbeats`, `greetings`, `beside`), their bytes on the network,
        messages received.
    refused
        messages that were not accepted, by reason: as `PeerSessions.counts`, `malformed`, `unsigned` (not by the key of
        the robot that they name), and `not_admitted` (see `admission`).
    not_admitted
        of these the statements that were not admitted, by the sender and the reason.
    lost_here
        as `Transport.lost_here`.
    rivals, superseded
        incarnations of other processes under this robot's id; whether one is later, so that this one is silent.
    """

    robot: str
    members: tuple[str, ...]
    silent: tuple[str, ...]
    epoch: int
    round: int
    bid: RoundBids | None
    last_sale: Sold | None
    settled: bool
    sent: Counter[str]
    sent_bytes: Counter[str]
    received: int
    refused: Counter[str]
    not_admitted: Counter[tuple[str, str]]
    lost_here: int
    rivals: tuple[int, ...]
    superseded: bool


class BesideChannel(Protocol):
    """What robots send each other beside the negotiation, by the same transport, such as maps."""

    def handle(self, data: bytes, now: float) -> Iterable[tuple[bytes, str | None]]:
        """Process a message; return those to send, each with the robot that it is for, or None for all.

        Raises
        ------
        MalformedError
            if it is none.
        """
        ...

    def tick(self, now: float) -> Iterable[tuple[bytes, str | None]]:
        """Let time pass; return the messages to send."""
        ...


class Node:
    """Runs a negotiator. A context manager: entering it starts the negotiation, leaving it closes the transport.

    Parameters
    ----------
    negotiator
        not started yet: the node starts it.
    transport, codec, seal
        what carries, encodes and encrypts messages. Without a seal messages are not encrypted: for tests only.
    clock
        by default that of the machine.

    Attributes
    ----------
    in_reach
        whether messages come through, in both directions; False while the radio of a simulated robot is off.
    keep
        stores what the robot needs after a restart; by default it does nothing. The node calls it before it sends
        anything; a caller that carries tasks out calls it before work begins.
    beside
        what goes over the same transport beside the negotiation; it is not signed, so not where robots have keys.
    """

    def __init__(
        self, negotiator: Negotiator, transport: Transport, codec: Codec, seal: Seal | None, clock: Clock | None = None
    ) -> None:
        self.negotiator, self.transport = negotiator, transport
        self.in_reach = True
        self.keep: Callable[[], None] = lambda: None
        self.beside: BesideChannel | None = None
        self.sent: Counter[str] = Counter()
        self.sent_bytes: Counter[str] = Counter()
        self.received = 0
        self._codec, self._met = codec, None if seal is None else PeerSessions(seal)
        self._clock = clock or SystemClock()
        self._garbled: Counter[str] = Counter()
        self._signatures = negotiator.signatures
        self._proof_bytes = PROOF_BYTES if self._signatures.has_keys else 0
        self._room = transport.room - (0 if seal is None else OVERHEAD + 1) - self._proof_bytes

    def __enter__(self) -> Self:
        self.start()
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, at: TracebackType | None) -> None:
        self.transport.close()

    def start(self) -> None:
        """Send the first messages of the negotiator; to be called before anything else."""
        self._send(self.negotiator.start(self._clock.now()))

    def step(self, wait_s: float) -> None:
        """Wait for a message, until the negotiator is due, or for `wait_s`; process all messages, then let time pass.

        Messages that arrived while the robot was busy are processed before time passes: no robot counts as silent whose
        messages wait in the queue.
        """
        if not self.negotiator.superseded:  # or it is never due again
            wait_s = max(0.0, min(wait_s, self.negotiator.due_s - self._clock.now()))
        came = self.transport.receive(wait_s)
        for data in came if self.in_reach else ():
            for said in [data] if self._met is None else self._met.open(data):
                self._take_in(said)
        self._greet()
        self._send(self.negotiator.tick(self._clock.now()))
        if self.beside is not None:
            self._send_beside(self.beside.tick(self._clock.now()))

    def run(self, until: Callable[[Node], bool], at_most_s: float | None = None) -> bool:
        """Step until a condition holds; return whether it did in time."""
        end_s = None if at_most_s is None else self._clock.now() + at_most_s
        while not until(self):
            left_s = _LOOK_S if end_s is None else end_s - self._clock.now()
            if left_s <= 0:
                return False
            self.step(min(_LOOK_S, left_s))
        return True

    def status(self) -> NodeStatus:
        """The current state."""
        negotiator, epoch = self.negotiator, self.negotiator.epoch
        stage, members = epoch.stage, epoch.own.members
        bids = (epoch.bids_of(negotiator.robot, number) for number in (stage.round, stage.round - 1))
        return NodeStatus(
            robot=negotiator.robot,
            members=members,
            silent=tuple(robot for robot in negotiator.rules.robots if robot not in members),
            epoch=stage.epoch,
            round=stage.round,
            bid=next((bid for bid in bids if bid is not None), None),
            last_sale=epoch.sales[-1] if epoch.sales else None,
            settled=negotiator.settled,
            sent=self.sent.copy(),
            sent_bytes=self.sent_bytes.copy(),
            received=self.received,
            refused=self._refused(),
            not_admitted=negotiator.counts.refused.copy(),
            lost_here=self.transport.lost_here,
            rivals=tuple(sorted(negotiator.rivals)),
            superseded=negotiator.superseded,
        )

    def _refused(self) -> Counter[str]:
        not_admitted = Counter(not_admitted=self.negotiator.counts.refused.total())
        return self._garbled + not_admitted + (Counter() if self._met is None else self._met.counts)

    def _take_in(self, said: bytes) -> None:
        proof, data = said[: self._proof_bytes], said[self._proof_bytes :]
        if self.beside is not None and data[:1] == BESIDE:
            self._take_in_beside(self.beside, data[1:])
            return
        try:
            message = self._codec.decode(data)
        except OtherVersionError:
            self._garbled["other_version"] += 1
        except MalformedError:
            self._garbled["malformed"] += 1
        else:
            if not self._signatures.proves(message.sender, proof, data):
                self._garbled["unsigned"] += 1
                return
            self.received += 1
            self._send(self.negotiator.handle(message, self._clock.now()))

    def _take_in_beside(self, channel: BesideChannel, data: bytes) -> None:
        try:
            answers = channel.handle(data, self._clock.now())
        except MalformedError:
            self._garbled["malformed"] += 1
        else:
            self.received += 1
            self._send_beside(answers)

    def _send_beside(self, out: Iterable[tuple[bytes, str | None]]) -> None:
        for data, to in out:
            piece = BESIDE + data
            self._transmit("beside", [piece if self._met is None else self._met.close(piece)], to)

    def _greet(self) -> None:
        """Ask unknown processes for a proof, and answer those that ask."""
        for greeting in [] if self._met is None else self._met.greetings(self._clock.now(), self.transport.room):
            self._transmit("greetings", [greeting], None)

    def _send(self, out: Iterable[Outgoing]) -> None:
        for outgoing in out:
            kind = "repairs" if outgoing.to is not None else "heartbeats" if outgoing.message.is_idle else "news"
            parts = self._codec.parts(outgoing.message, self._room)
            pieces = [self._signatures.proof_of(part) + part for part in parts]
            self._transmit(kind, pieces if self._met is None else map(self._met.close, pieces), outgoing.to)

    def _transmit(self, kind: str, pieces: Iterable[bytes], to: str | None) -> None:
        """Send a message, and count it."""
        self.keep()
        self.sent[kind] += 1
        before = self.transport.bytes_sent
        for piece in pieces:
            if self.in_reach:
                self.transport.send(piece, to)
        self.sent_bytes[kind] += self.transport.bytes_sent - before
