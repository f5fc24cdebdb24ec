"""The failure detector: which robots take part, by direct and relayed heartbeats and by their answers in time."""

from __future__ import annotations

from collections.abc import Collection, Iterable
from dataclasses import dataclass, field
from math import inf

from muster_team.knowledge.messages import Birth, Heartbeat, Message


@dataclass(frozen=True, kw_only=True)
class Timeouts:
    """The time limits of the protocol, seconds.

    Parameters
    ----------
    heartbeat_s
        the longest time between two messages of a robot.
    retry_s
        the same while the robot lacks something; longer in large teams, see `repairs.CROWD`.
    suspect_s
        a robot of which nothing was heard for this long is considered lost. It is also the lease on what the robot
        owns: others respect that for this long, and each heartbeat renews it.
    bid_s
        a robot that is heard but does not bid, or declares other members, for this long is excluded. It is more than
        `suspect_s`, so that all robots have noticed by then who is lost.
    exclusion_s
        the first exclusion of a robot takes this long, each further one twice as long (at most eight times) until
        something was agreed with that robot. An exclusion because of other members ends when the robot declares again.
    """

    heartbeat_s: float = 0.2
    retry_s: float = 0.15
    suspect_s: float = 4.0
    bid_s: float = 6.0
    exclusion_s: float = 5.0


FAR = 2.0
"""The factor on waiting times for robots that are heard through other robots only."""


@dataclass
class _Peer:
    incarnation: int = -1
    number: int = -1
    heard_s: float = 0.0
    excluded_until_s: float = 0.0
    exclusions: int = 0
    may_return: bool = False
    spoke_s: float = -inf
    born_s: float = inf  # when this incarnation was heard of first
    outdated_s: float = -inf  # when others were last known to accept an earlier incarnation
    unheard: tuple[str, ...] = ()
    birth: Birth | None = None  # the proof of its last start, where robots have keys
    revoked: bool = False

    def is_far(self, suspect_s: float) -> bool:
        """Whether the last news of this robot were relayed by others for a while."""
        return self.heard_s - max(self.spoke_s, self.born_s) >= suspect_s / 2

    def hear(self, incarnation: int, number: int, now: float) -> bool:
        """Note a sign of life; return whether the robot has restarted."""
        if incarnation < self.incarnation or (incarnation == self.incarnation and number <= self.number):
            return False
        restarted = -1 < self.incarnation < incarnation
        self.born_s = now if incarnation > self.incarnation else self.born_s
        self.incarnation, self.number, self.heard_s = incarnation, number, now if number else self.heard_s
        return restarted


@dataclass
class Members:
    """The failure detector of one robot.

    At first every robot of the team counts as alive. Relayed heartbeats count: one with a number above the highest
    known proves that its robot was alive when it sent that. They are sent where they are needed. Each robot names the
    robots that it has not heard directly for half of `suspect_s`; a robot that hears these relays their heartbeats. A
    robot with such a list relays the heartbeats of all, since the others may in turn not hear those that it hears.
    Where all robots hear each other nothing is relayed. Only recent heartbeats are relayed, so that a lost robot does
    not appear alive through old ones.

    Messages of robots that are heard only through others take longer; these robots have FAR times as long.
    """

    me: str
    timeouts: Timeouts
    _peers: dict[str, _Peer] = field(default_factory=dict)

    def expect(self, robots: Iterable[str], now: float, absent: Collection[str] = ()) -> None:
        """Count robots as alive that have not been heard yet, except those that are known to join later."""
        for robot in robots:
            self._peers.setdefault(robot, _Peer(heard_s=inf if robot == self.me else -inf if robot in absent else now))

    def hear(self, heartbeat: Heartbeat, now: float) -> bool:
        """Note a relayed heartbeat; return whether its robot has restarted."""
        peer = self._peers.get(heartbeat.robot)
        if peer is None or heartbeat.robot == self.me:
            return False
        if heartbeat.incarnation < peer.incarnation:
            peer.outdated_s = now
        return peer.hear(heartbeat.incarnation, heartbeat.number, now)

    def accepts(self, message: Message) -> bool:
        """Whether a message is to be processed: its sender belongs to the team, and its incarnation is not outdated."""
        peer = self._peers.get(message.sender)
        return peer is not None and not peer.revoked and peer.incarnation <= message.incarnation

    def hear_from(self, message: Message, now: float) -> bool:
        """Note a message received directly; return whether its sender has restarted."""
        peer = self._peers[message.sender]
        peer.spoke_s = now
        if message.incarnation == peer.incarnation:
            peer.heard_s = max(peer.heard_s, now)  # whatever others have told of its number
        if message.heartbeats:
            peer.unheard = message.unheard
        return peer.hear(message.incarnation, message.number, now)

    def hear_birth(self, birth: Birth) -> None:
        """Note the proof that a robot has started, which was checked."""
        peer = self._peers.get(birth.robot)
        if peer is not None and (peer.birth is None or peer.birth.incarnation < birth.incarnation):
            peer.birth = birth

    def birth_of(self, heartbeat: Heartbeat) -> Birth | None:
        """The proof of the start that a heartbeat names, if it is known."""
        birth = self._peers[heartbeat.robot].birth
        return birth if birth is not None and birth.incarnation == heartbeat.incarnation else None

    def is_born(self, heartbeat: Heartbeat) -> bool:
        """Whether a heartbeat names a start that is proven, or none later than the one that was heard."""
        peer = self._peers.get(heartbeat.robot)
        return peer is not None and (heartbeat.incarnation <= peer.incarnation or self.birth_of(heartbeat) is not None)

    def revoke(self, robot: str) -> None:
        """Exclude a robot for good."""
        self._peers[robot].revoked = True

    def correction(self, robot: str, now: float) -> Heartbeat | None:
        """The known incarnation of a robot, for those that accept an earlier one; None while it is heard."""
        is_silent = self.silent_s(robot, now) >= self.timeouts.suspect_s / 2
        return Heartbeat(robot, self._peers[robot].incarnation, 0) if is_silent else None

    def incarnation(self, robot: str) -> int:
        """The highest incarnation heard of; -1: none."""
        peer = self._peers.get(robot)
        return -1 if peer is None else peer.incarnation

    def exclude(self, robot: str, now: float, *, bids: bool) -> None:
        """Exclude a robot for a while: it does not bid, or it declares other members."""
        peer = self._peers[robot]
        peer.excluded_until_s = now + self.timeouts.exclusion_s * 2.0 ** min(peer.exclusions, 3)
        peer.exclusions += 1
        peer.may_return = not bids

    def reset_exclusions(self, robots: Iterable[str]) -> None:
        """Something was agreed with these robots: their next exclusion is a short one."""
        for robot in robots:
            if robot in self._peers:
                self._peers[robot].exclusions = 0

    def readmit(self, robot: str) -> None:
        """A robot counts this one as a member: end an exclusion that was due to other members."""
        peer = self._peers.get(robot)
        if peer is not None and peer.may_return:
            peer.excluded_until_s, peer.may_return = 0.0, False

    def present(self, now: float) -> tuple[str, ...]:
        """The robots that take part, this one included, in the order in which they are expected."""
        lease_s = self.timeouts.suspect_s
        near, far = now - lease_s, now - FAR * lease_s
        there = [(r, p) for r, p in self._peers.items() if not p.revoked and p.excluded_until_s <= now]
        return tuple([r for r, p in there if p.heard_s > near or (p.heard_s > far and p.is_far(lease_s))])

    def is_far(self, robot: str) -> bool:
        """Whether a robot is heard through other robots only."""
        return robot != self.me and self._peers[robot].is_far(self.timeouts.suspect_s)

    def is_excluded(self, robot: str, now: float) -> bool:
        return self._peers[robot].excluded_until_s > now

    def silent_s(self, robot: str, now: float) -> float:
        """The time since the last sign of life of a robot, seconds."""
        return now - self._peers[robot].heard_s

    def unheard(self, now: float) -> tuple[str, ...]:
        """Robots that were not heard directly for a while, or never."""
        since = now - self.timeouts.suspect_s / 2
        return tuple([r for r, p in self._peers.items() if p.spoke_s <= since and r != self.me])

    def heartbeats(self, own: Heartbeat, now: float) -> tuple[Heartbeat, ...]:
        """The heartbeats to send: its own, those of robots that others do not hear, and one other in turn.

        It relays those of all robots if it does not hear some of them. The one in turn lets a robot learn of another
        process under its id, which it may not hear directly.
        """
        robots, since = list(self._peers), now - self.timeouts.suspect_s
        told = set(robots) if self.unheard(now) else {robots[own.number % len(robots)]}
        told.update(*(peer.unheard for peer in self._peers.values() if peer.unheard and peer.spoke_s > since))
        news = ((r, p) for r, p in self._peers.items() if r in told and now - p.heard_s < self.timeouts.suspect_s / 8)
        relayed = [Heartbeat(r, p.incarnation, p.number) for r, p in news if p.number >= 0]
        outdated = [r for r, p in self._peers.items() if now - p.outdated_s < self.timeouts.suspect_s / 8]
        return (own, *relayed, *(correction for r in outdated if (correction := self.correction(r, now)) is not None))
