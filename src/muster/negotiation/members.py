"""Who takes part: those that were heard of lately, first hand or second hand, and do not keep silent when asked."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from math import inf

from muster.negotiation.messages import Pulse


@dataclass(frozen=True, kw_only=True)
class Patience:
    """How long robots wait for one another, seconds.

    Parameters
    ----------
    beat_s
        at most so long from one message of a robot to its next.
    retry_s
        the same while it lacks something.
    suspect_s
        a robot of which nothing was heard for so long is taken for lost. This is the lease on what it owns, too: others
        honour that for so long, and every beat renews it.
    bid_s
        a robot that is heard, but does not bid, or takes others for members, for so long is left out; more than
        `suspect_s`, so that all have noticed by then who is lost,
    mute_s
        for so long, twice as long each further time that nothing was agreed with it in between, at most eight times;
        one that takes others for members at most until it declares anew.
    """

    beat_s: float = 0.2
    retry_s: float = 0.15
    suspect_s: float = 4.0
    bid_s: float = 6.0
    mute_s: float = 5.0


@dataclass
class _Peer:
    incarnation: int = -1
    number: int = -1
    heard_s: float = 0.0
    muted_until_s: float = 0.0
    mutings: int = 0
    may_return: bool = False


@dataclass
class Members:
    """The failure detector of one robot.

    Every robot of the team is taken for alive at first. Second-hand news count: a pulse with a number above the highest
    known is proof that its robot was alive when it sent that.
    """

    me: str
    patience: Patience
    _peers: dict[str, _Peer] = field(default_factory=dict)

    def expect(self, robots: Iterable[str], now: float) -> None:
        """Take robots for alive that have not been heard of."""
        for robot in robots:
            self._peers.setdefault(robot, _Peer(heard_s=inf if robot == self.me else now))

    def hear(self, pulse: Pulse, now: float) -> bool:
        """Take in that a robot lived; whether it has started anew since it was heard last."""
        peer = self._peers.get(pulse.robot)
        if peer is None or pulse.robot == self.me:
            return False
        if (pulse.incarnation, pulse.number) <= (peer.incarnation, peer.number):
            return False
        anew = -1 < peer.incarnation < pulse.incarnation
        peer.incarnation, peer.number, peer.heard_s = pulse.incarnation, pulse.number, now
        return anew

    def incarnation(self, robot: str) -> int:
        """The last incarnation heard of; -1: none."""
        peer = self._peers.get(robot)
        return -1 if peer is None else peer.incarnation

    def mute(self, robot: str, now: float, *, bids: bool) -> None:
        """Leave a robot out for a while: one that does not bid, or one with other members."""
        peer = self._peers[robot]
        peer.muted_until_s = now + self.patience.mute_s * 2.0 ** min(peer.mutings, 3)
        peer.mutings += 1
        peer.may_return = not bids

    def forgive(self, robots: Iterable[str]) -> None:
        """Something was agreed with these robots."""
        for robot in robots:
            if robot in self._peers:
                self._peers[robot].mutings = 0

    def welcome(self, robot: str) -> None:
        """A robot takes this one for a member: if it was left out since it did not, it is back."""
        peer = self._peers.get(robot)
        if peer is not None and peer.may_return:
            peer.muted_until_s, peer.may_return = 0.0, False

    def present(self, now: float) -> tuple[str, ...]:
        """Those that take part, this robot included, in the order in which they are expected."""
        since = now - self.patience.suspect_s
        return tuple([r for r, p in self._peers.items() if p.heard_s > since and p.muted_until_s <= now])

    def is_muted(self, robot: str, now: float) -> bool:
        return self._peers[robot].muted_until_s > now

    def silent_s(self, robot: str, now: float) -> float:
        """For how long nothing was heard of a robot."""
        return now - self._peers[robot].heard_s

    def pulses(self, own: Pulse, of: Sequence[str]) -> tuple[Pulse, ...]:
        """What this robot knows of others."""
        known = ((robot, self._peers[robot]) for robot in of if robot in self._peers)
        return (own, *(Pulse(r, p.incarnation, p.number) for r, p in known if p.number >= 0))
