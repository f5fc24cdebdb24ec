"""Excludes members whose messages arrive but which delay the others for too long."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass, field

from muster_team.auctions.epoch import Epoch
from muster_team.knowledge.messages import Message, Stage
from muster_team.membership.members import FAR, Members


@dataclass
class StalledMembers:
    """Measures how long one robot waits for its members."""

    members: Members
    _stage: Stage = field(default_factory=lambda: Stage(0))
    _since_s: float = 0.0

    def enter(self, stage: Stage, now: float) -> None:
        """The robot enters an epoch."""
        self._stage, self._since_s = stage, now

    def reach(self, stage: Stage, now: float) -> None:
        """The robot has reached a stage."""
        if stage != self._stage:
            self.enter(stage, now)

    def too_long(self, epoch: Epoch, now: float) -> list[str]:
        """Exclude members for which the robot has waited for `bid_s`; return them."""
        if now - self._since_s < self._bid_s(epoch):
            return []
        self._since_s = now
        return self._leave_out(epoch.lacks, epoch, now)

    def too_long_for(self, message: Message, epoch: Epoch, now: float) -> list[str]:
        """Exclude members that the sender of a message excludes, if this robot has waited half as long; return them."""
        if now - self._since_s < self._bid_s(epoch) / 2 or not message.declarations:
            return []
        waited = sorted(set(epoch.lacks).difference([message.sender]))
        return self._leave_out(
            [r for r in waited if all(r not in said.members for said in message.declarations)], epoch, now
        )

    def _bid_s(self, epoch: Epoch) -> float:
        """The time limit for bids: longer where members are heard through others, as their bids take longer."""
        far = any(map(self.members.is_far, epoch.own.members))
        return self.members.timeouts.bid_s * (FAR if far else 1.0)

    def _leave_out(self, robots: Iterable[str], epoch: Epoch, now: float) -> list[str]:
        """Exclude those of these robots that are heard; a silent robot is lost soon anyway."""
        out = [r for r in robots if r != self.members.me and self._is_heard(r, now)]
        for robot in out:
            self.members.exclude(robot, now, bids=epoch.base is not None)
        return out

    def _is_heard(self, robot: str, now: float) -> bool:
        return self.members.silent_s(robot, now) < self.members.timeouts.suspect_s / 2
