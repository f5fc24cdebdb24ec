"""The faults of drones by name, and the reaction to each: the table of docs/mavlink.md."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum

_TEXTS_WITHIN_S = 0.5


class Reaction(Enum):
    """The command that a drone with a fault gets."""

    NOTHING = "nothing"  # it cannot hear, lies on the ground, or somebody else flies it
    HOLD = "hold"
    RETURN = "return"


class Kind(Enum):
    """A kind of fault, and the reaction to it. The drone takes no part any more."""

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

    @property
    def is_refusal(self) -> bool:
        """Whether the autopilot refused a command; its status texts may give the reason."""
        return self in (Kind.ITEM_REJECTED, Kind.ARM_REFUSED, Kind.COMMAND_REFUSED, Kind.NO_ANSWER)


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
        what was said or telemetry, in words.
    texts
        status texts of the autopilot that belong to a refusal.
    """

    at_s: float
    robot: str
    kind: Kind
    detail: str
    texts: tuple[str, ...] = ()

    def awaits_texts(self, now: float) -> bool:
        """Whether a status text that arrives now may give the reason of a refusal."""
        return self.kind.is_refusal and now <= self.at_s + _TEXTS_WITHIN_S

    @property
    def reason(self) -> str:
        """Kind and detail of the fault, with the status texts of the autopilot."""
        texts = f" ({'; '.join(self.texts)})" if self.texts else ""
        return f"{self.kind.words}: {self.detail}{texts}"

    def __str__(self) -> str:
        return f"{self.robot}: {self.reason}"


class FaultError(Exception):
    """Ends what a session is doing; never leaves the session."""

    def __init__(self, kind: Kind, detail: str) -> None:
        self.kind, self.detail = kind, detail
        super().__init__(detail)
