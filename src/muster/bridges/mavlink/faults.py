"""What can go wrong with a drone, by name, and what becomes of it: the table of docs/mavlink.md."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum


class Reaction(Enum):
    """What Muster tells a drone that fails."""

    NOTHING = "nothing"  # it cannot hear, lies on the ground, or somebody else flies it
    HOLD = "hold"
    RETURN = "return"


class Kind(Enum):
    """A failure by its name: why the drone takes no part any more, and what it is told."""

    LINK_LOST = "link lost", Reaction.NOTHING
    ITEM_REJECTED = "item rejected", Reaction.HOLD
    ARM_REFUSED = "arm refused", Reaction.HOLD
    COMMAND_REFUSED = "command refused", Reaction.HOLD
    NO_ANSWER = "no answer", Reaction.HOLD
    LOW_BATTERY = "low battery", Reaction.RETURN
    FENCE_BREACHED = "fence breached", Reaction.HOLD
    OUTSIDE_FENCE = "outside the fence", Reaction.HOLD
    TAKEN_OVER = "taken over", Reaction.NOTHING
    NOT_UNDERSTOOD = "not understood", Reaction.HOLD
    DISARMED = "disarmed in flight", Reaction.NOTHING

    def __init__(self, words: str, reaction: Reaction) -> None:
        self.words = words
        self.reaction = reaction


@dataclass(frozen=True)
class Fault:
    """A drone cannot go on.

    Parameters
    ----------
    at_s
        seconds of the mission's clock.
    robot, kind
        who, and what.
    detail
        what was said or seen, in words.
    """

    at_s: float
    robot: str
    kind: Kind
    detail: str

    def __str__(self) -> str:
        return f"{self.robot}: {self.kind.words}: {self.detail}"


class FaultError(Exception):
    """Ends what a session is doing; never leaves the session."""

    def __init__(self, kind: Kind, detail: str) -> None:
        self.kind, self.detail = kind, detail
        super().__init__(detail)
