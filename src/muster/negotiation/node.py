"""A robot's process: its negotiator, what carries its messages, and a clock."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable
from dataclasses import dataclass

from muster.mission.clock import Clock
from muster.negotiation.codec import Codec
from muster.negotiation.messages import RoundBids, Sold
from muster.negotiation.negotiator import Negotiator
from muster.negotiation.seal import Seal
from muster.negotiation.transport import Transport


@dataclass(frozen=True, kw_only=True)
class NodeStatus:
    """What a robot knows at a moment, for a table of the team.

    Parameters
    ----------
    robot, members, silent
        its id; with whom it holds the auction; who does not take part.
    epoch, round
        how far it is: number of the epoch, rounds resolved in it.
    bid
        what it bids in this round; None where it has not yet.
    last_sale
        what came of the last round.
    settled
        whether all members are known to agree, and nobody bids any more.
    sent, sent_bytes, received
        messages sent by kind (`news`, `repairs`, `beats`), their bytes as they travel, messages taken in.
    refused
        what was not taken in, by why: foreign, replayed, other_mission, other_version, garbled.
    lost_here
        as `Transport.lost_here`.
    rivals
        incarnations of other processes that run under this robot's name.
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
    lost_here: int
    rivals: tuple[int, ...]


class Node:
    """Drives a negotiator. A context manager: leaving it closes the transport."""

    def __init__(
        self, negotiator: Negotiator, transport: Transport, codec: Codec, seal: Seal | None, clock: Clock | None = None
    ) -> None:
        raise NotImplementedError

    def start(self) -> None:
        """Send what the negotiator says at first."""
        raise NotImplementedError

    def step(self, wait_s: float) -> None:
        """Wait until something comes, the negotiator is due, or so long; take in all that came, then let time go by."""
        raise NotImplementedError

    def run(self, until: Callable[[Node], bool], at_most_s: float | None = None) -> bool:
        """Step until something is true; whether it came true in time."""
        raise NotImplementedError

    def status(self) -> NodeStatus:
        raise NotImplementedError
