"""Who a robot is to the others: its name and incarnation, the numbers of its messages, and who else has its name."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster.negotiation.messages import Pulse


@dataclass
class Identity:
    """Of one robot, in one life.

    Parameters
    ----------
    robot, incarnation
        its id, and how often it has started.
    number
        of its last message.
    rivals
        incarnations of others under this robot's name.
    """

    robot: str
    incarnation: int
    number: int = 0
    rivals: set[int] = field(default_factory=set)

    @property
    def pulse(self) -> Pulse:
        return Pulse(self.robot, self.incarnation, self.number)

    @property
    def superseded(self) -> bool:
        """Whether a later process has this robot's name."""
        return bool(self.rivals) and max(self.rivals) > self.incarnation

    def is_rival(self, pulse: Pulse) -> bool:
        """Whether what was heard of this name is of another life than this one, and not one long past."""
        number = self.number if pulse.incarnation == self.incarnation else -1
        later = pulse.incarnation > self.incarnation
        return later or (pulse.incarnation == self.incarnation and pulse.number > number)
