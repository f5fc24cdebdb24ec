"""What a robot knows of how far the others are: which members have found its base, and have ended with it."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, field

from muster.negotiation.messages import Message, Stage


@dataclass
class Agreement:
    """What one robot knows of that.

    Parameters
    ----------
    robot
        its id.
    shown
        members that have shown the base of its epoch, itself included.
    agreed
        members of which it knows that they are at the stage at which it ended.
    """

    robot: str
    shown: set[str] = field(default_factory=set)
    agreed: set[str] = field(default_factory=set)
    _on: Stage = field(default_factory=lambda: Stage(0))

    def enter(self) -> None:
        """The robot goes into another epoch."""
        self.shown = set()

    def find_base(self) -> None:
        """The robot has found the base of its epoch."""
        self.shown = {self.robot}

    def end(self, stage: Stage) -> bool:
        """The robot is at a stage that has ended; whether it was not before."""
        if self._on == stage:
            return False
        self.agreed, self._on = {self.robot}, stage
        return True

    def hear(self, message: Message, stage: Stage) -> None:
        """Take in how far others are; `stage` is the robot's own."""
        if stage.base and message.stage.base == stage.base:
            self.shown.add(message.sender)
            self.shown.update(message.agreed)
        if stage.ended and message.stage == stage:
            self.agreed.update(message.agreed)

    def holds(self, stage: Stage, members: Collection[str]) -> bool:
        """Whether all members are known to be at this stage, and nobody bids any more."""
        return stage.ended and self._on == stage and self.agreed.issuperset(members)
