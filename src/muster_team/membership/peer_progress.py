"""The progress of the other members: which of them have found this robot's base, and which have ended with it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from muster_team.knowledge.messages import Message, Stage


@dataclass
class PeerProgress:
    """The progress of the other members, as one robot knows it.

    Parameters
    ----------
    robot
        the robot's id.
    shown
        members that have shown the base of its epoch, itself included.
    agreed
        members that are known to be at the stage at which the robot ended.
    """

    robot: str
    shown: set[str] = field(default_factory=set)
    agreed: set[str] = field(default_factory=set)
    _on: Stage = field(default_factory=lambda: Stage(0))

    def enter(self) -> None:
        """The robot enters another epoch."""
        self.shown = set()

    def find_base(self) -> None:
        """The robot has found the base of its epoch."""
        self.shown = {self.robot}

    def end(self, stage: Stage) -> bool:
        """The robot is at a stage that has ended; return whether that is new."""
        if self._on == stage:
            return False
        self.agreed, self._on = {self.robot}, stage
        return True

    def hear(self, message: Message, stage: Stage) -> None:
        """Note the progress in a message; `stage` is the robot's own."""
        if stage.base and message.stage.base == stage.base:
            self.shown.add(message.sender)
            self.shown.update(message.agreed)
        if stage.ended and message.stage == stage:
            self.agreed.update(message.agreed)

    def holds(self, stage: Stage, members: Collection[str]) -> bool:
        """Whether all members are known to be at this stage, and nobody bids any more."""
        return stage.ended and self._on == stage and self.agreed.issuperset(members)
