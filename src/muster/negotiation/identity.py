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
    superseded
        whether one of them is later: this one is silent, and owns nothing.
    may_rise
        whether this process may still take a higher incarnation, once, when it hears of a later one.
    """

    robot: str
    incarnation: int
    number: int = 0
    rivals: set[int] = field(default_factory=set)
    superseded: bool = False
    may_rise: bool = True

    @property
    def pulse(self) -> Pulse:
        return Pulse(self.robot, self.incarnation, self.number)

    def rise_above(self, pulse: Pulse) -> bool:
        """Take an incarnation above one that others have heard of; whether this process may, and has to.

        The process that started last has the name. Its incarnation is lower than that of its past life if it has no
        memory and its clock was set back.
        """
        if not self.may_rise or pulse.incarnation <= self.incarnation:
            return False
        self.may_rise, self.incarnation = False, pulse.incarnation + 1
        return True

    def hear(self, pulse: Pulse) -> bool:
        """Take in what was heard of this name; whether it is new, and of another life that is not long past."""
        mine = self.incarnation, self.number
        if (pulse.incarnation, pulse.number) <= mine or pulse.incarnation in self.rivals:
            return False
        self.rivals.add(pulse.incarnation)
        self.superseded |= pulse.incarnation > self.incarnation
        return True
