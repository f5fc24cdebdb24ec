"""The faults of drones by name, and the reaction to each: the table of docs/mavlink.md."""

from __future__ import annotations

from dataclasses import dataclass, replace
from enum import Enum

from muster_robots.custody import Standing

TEXTS_BEFORE_S, _TEXTS_AFTER_S = 5.0, 0.5
"""Seconds before and after a fault in which status texts of the autopilot may give its cause."""
_TOLD = 3
"""So many status texts are told with a fault."""


class Reaction(Enum):
    """The command that a drone with a fault gets."""

    NOTHING = "nothing"  # it cannot hear, lies on the ground, or somebody else flies it
    HOLD = "hold"
    RETURN = "return"


class Costs(Enum):
    """What a fault ends."""

    ROBOT = "out"  # the drone takes no part any more
    TASK = "its task"  # the drone goes on with others
    PAUSE = "pauses"  # the drone takes part again when it does what Muster wants


class Kind(Enum):
    """A kind of fault, the reaction to it, and what it ends."""

    LINK_LOST = "link lost", Reaction.HOLD, Costs.ROBOT
    ITEM_REJECTED = "item rejected", Reaction.HOLD, Costs.TASK
    START_REFUSED = "start refused", Reaction.HOLD, Costs.TASK
    ARM_REFUSED = "arm refused", Reaction.HOLD, Costs.ROBOT
    COMMAND_REFUSED = "command refused", Reaction.HOLD, Costs.ROBOT
    NO_ANSWER = "no answer", Reaction.HOLD, Costs.ROBOT
    LOW_BATTERY = "low battery", Reaction.RETURN, Costs.ROBOT
    FENCE_BREACHED = "fence breached", Reaction.HOLD, Costs.TASK
    OUTSIDE_FENCE = "outside the fence", Reaction.HOLD, Costs.TASK
    PILOT = "pilot", Reaction.NOTHING, Costs.PAUSE
    FAILSAFE = "failsafe", Reaction.NOTHING, Costs.PAUSE
    STATION = "another station", Reaction.NOTHING, Costs.PAUSE
    NO_POSITION = "no position", Reaction.NOTHING, Costs.PAUSE
    NOT_UNDERSTOOD = "not understood", Reaction.HOLD, Costs.ROBOT
    LANDED = "landed", Reaction.NOTHING, Costs.ROBOT
    DISARMED = "disarmed in flight", Reaction.NOTHING, Costs.ROBOT

    def __init__(self, words: str, reaction: Reaction, costs: Costs) -> None:
        self.words = words
        self.reaction = reaction
        self.costs = costs

    @property
    def is_refusal(self) -> bool:
        """Whether the autopilot refused a command: all status texts since the command may give the reason."""
        return self in (
            Kind.ITEM_REJECTED,
            Kind.START_REFUSED,
            Kind.ARM_REFUSED,
            Kind.COMMAND_REFUSED,
            Kind.NO_ANSWER,
        )


KIND_UNDER = {Standing.PILOT: Kind.PILOT, Standing.FAILSAFE: Kind.FAILSAFE, Standing.STATION: Kind.STATION}
"""The fault of a drone that somebody else has, by its standing."""


@dataclass(frozen=True)
class StatusText:
    """A status text of an autopilot: when it arrived, its MAV_SEVERITY (0 is the worst), and its words."""

    at_s: float
    severity: int
    text: str


@dataclass(frozen=True)
class Fault:
    """A fault of a drone.

    Parameters
    ----------
    at_s
        seconds of the mission's clock.
    robot, kind
        who, and what.
    detail
        what was said or telemetry, in words.
    texts
        status texts of the autopilot that may give the cause.
    """

    at_s: float
    robot: str
    kind: Kind
    detail: str
    texts: tuple[StatusText, ...] = ()

    def awaits_texts(self, now: float) -> bool:
        """Whether a status text that arrives now may give the cause."""
        return now <= self.at_s + _TEXTS_AFTER_S

    def with_text(self, new: StatusText) -> Fault:
        """Return the fault with one more text; a text that has grown by a piece takes the place of what it was."""
        known = (text for text in self.texts if text.at_s != new.at_s or not new.text.startswith(text.text))
        return replace(self, texts=(*known, new))

    @property
    def reason(self) -> str:
        """Kind and detail of the fault, with the gravest status texts of the autopilot, in order of time."""
        gravest = sorted(self.texts, key=lambda text: text.severity)[:_TOLD]
        words = list(dict.fromkeys(text.text for text in self.texts if text in gravest and text.text != self.detail))
        detail = f"{self.kind.words}: {self.detail}" if self.detail else self.kind.words
        return f"{detail} ({'; '.join(words)})" if words else detail

    def __str__(self) -> str:
        return f"{self.robot}: {self.reason}"


class FaultError(Exception):
    """Ends what a session is doing; never leaves the session."""

    def __init__(self, kind: Kind, detail: str) -> None:
        self.kind, self.detail = kind, detail
        super().__init__(detail)
