"""Who takes part: those that were heard of lately, first hand or second hand, and do not keep silent when asked."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from math import inf

from muster.negotiation.messages import Message, Pulse


@dataclass(frozen=True, kw_only=True)
class Patience:
    """How long robots wait for one another, seconds.

    Parameters
    ----------
    beat_s
        at most so long from one message of a robot to its next.
    retry_s
        the same while it lacks something; in large teams for some longer, see `repairs.CROWD`.
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


FAR = 2.0
"""By how many times longer robots wait for those that they do not hear themselves."""


@dataclass
class _Peer:
    incarnation: int = -1
    number: int = -1
    heard_s: float = 0.0
    muted_until_s: float = 0.0
    mutings: int = 0
    may_return: bool = False
    spoke_s: float = -inf
    born_s: float = inf  # when this incarnation was heard of first
    misses: tuple[str, ...] = ()

    def is_far(self, suspect_s: float) -> bool:
        """Whether the last that was heard of it had been passed on by others for a while."""
        return self.heard_s - max(self.spoke_s, self.born_s) >= suspect_s / 2

    def hear(self, incarnation: int, number: int, now: float) -> bool:
        """Whether the robot has started anew."""
        if incarnation < self.incarnation or (incarnation == self.incarnation and number <= self.number):
            return False
        anew = -1 < self.incarnation < incarnation
        self.born_s = now if incarnation > self.incarnation else self.born_s
        self.incarnation, self.number, self.heard_s = incarnation, number, now
        return anew


@dataclass
class Members:
    """The failure detector of one robot.

    Every robot of the team is taken for alive at first. Second-hand news count: a pulse with a number above the highest
    known is proof that its robot was alive when it sent that. They are told where they are needed: each robot tells
    whom it misses, those that it has not heard themselves for half of `suspect_s`, or never; and who hears it passes
    on what it hears of these. Who misses somebody tells all, as that one may miss those that this one hears. Where all
    hear each other nobody misses anybody. Only what is new is passed on, else the dead would live on in rumours.

    Words of robots that are heard through others alone have a long way: they have FAR times as long.
    """

    me: str
    patience: Patience
    _peers: dict[str, _Peer] = field(default_factory=dict)

    def expect(self, robots: Iterable[str], now: float, absent: Collection[str] = ()) -> None:
        """Take robots for alive that have not been heard of; not those of which it is known that they come later."""
        for robot in robots:
            self._peers.setdefault(robot, _Peer(heard_s=inf if robot == self.me else -inf if robot in absent else now))

    def hear(self, pulse: Pulse, now: float) -> bool:
        """Take in that a robot lived; whether it has started anew since it was heard last."""
        peer = self._peers.get(pulse.robot)
        return peer is not None and pulse.robot != self.me and peer.hear(pulse.incarnation, pulse.number, now)

    def heeds(self, message: Message) -> bool:
        """Whether a message is to be heard: not a stranger's, and not of a life past."""
        peer = self._peers.get(message.sender)
        return peer is not None and peer.incarnation <= message.incarnation

    def hear_from(self, message: Message, now: float) -> bool:
        """Take in that a robot was heard itself, and whom it misses; whether it has started anew."""
        peer = self._peers[message.sender]
        peer.spoke_s = now
        if message.pulses:
            peer.misses = message.misses
        return peer.hear(message.incarnation, message.number, now)

    def last_pulse(self, robot: str) -> Pulse | None:
        """The last that was heard of a robot; None: it does not belong to the team."""
        peer = self._peers.get(robot)
        return None if peer is None else Pulse(robot, peer.incarnation, peer.number)

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
        lease_s = self.patience.suspect_s
        near, far = now - lease_s, now - FAR * lease_s
        return tuple(
            [
                r
                for r, p in self._peers.items()
                if p.muted_until_s <= now and (p.heard_s > near or (p.heard_s > far and p.is_far(lease_s)))
            ]
        )

    def is_far(self, robot: str) -> bool:
        """Whether a robot is heard through others alone."""
        return robot != self.me and self._peers[robot].is_far(self.patience.suspect_s)

    def is_muted(self, robot: str, now: float) -> bool:
        return self._peers[robot].muted_until_s > now

    def silent_s(self, robot: str, now: float) -> float:
        """For how long nothing was heard of a robot."""
        return now - self._peers[robot].heard_s

    def misses(self, now: float) -> tuple[str, ...]:
        """Others that were not heard themselves for a while, or never."""
        since = now - self.patience.suspect_s / 2
        return tuple([r for r, p in self._peers.items() if p.spoke_s <= since and r != self.me])

    def pulses(self, own: Pulse, now: float) -> tuple[Pulse, ...]:
        """What this robot tells of others: of all if it misses any, else of those that others miss, and one in turn.

        That one may be told of another process with its name, which it need not hear.
        """
        robots, since = list(self._peers), now - self.patience.suspect_s
        told = set(robots) if self.misses(now) else {robots[own.number % len(robots)]}
        told.update(*(peer.misses for peer in self._peers.values() if peer.misses and peer.spoke_s > since))
        news = ((r, p) for r, p in self._peers.items() if r in told and now - p.heard_s < self.patience.suspect_s / 8)
        return (own, *(Pulse(r, p.incarnation, p.number) for r, p in news if p.number >= 0))
