"""The identity of one robot process: robot id, incarnation, message number, and other processes with the same id."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster_team.knowledge.messages import Heartbeat


@dataclass
class Identity:
    """The identity of one process of a robot.

    Parameters
    ----------
    robot, incarnation
        the robot's id, and the number of this start of the robot; later starts have higher numbers.
    number
        the number of the last message that was sent.
    rivals
        incarnations of other processes that use this robot's id.
    superseded
        whether one of them is later. A superseded process sends nothing and owns nothing.
    may_renumber
        whether this process may take a higher incarnation when it hears of a later one: once before others have
        accepted it, and whenever the others tell that the later one is silent.
    """

    robot: str
    incarnation: int
    number: int = 0
    rivals: set[int] = field(default_factory=set)
    superseded: bool = False
    may_renumber: bool = True

    @property
    def heartbeat(self) -> Heartbeat:
        return Heartbeat(self.robot, self.incarnation, self.number)

    def renumber_above(self, heartbeat: Heartbeat) -> bool:
        """Take an incarnation above one that others have heard of; return whether that was allowed and necessary.

        The process that started last keeps the id. Its incarnation is lower than that of an earlier process if it has
        no memory and its clock was set back.
        """
        if not self.may_renumber or heartbeat.incarnation <= self.incarnation:
            return False
        self.may_renumber, self.incarnation = False, heartbeat.incarnation + 1
        return True

    def hear(self, heartbeat: Heartbeat) -> bool:
        """Note a heartbeat under this robot's id; return whether it shows another process that was not known yet."""
        mine = self.incarnation, self.number
        if (heartbeat.incarnation, heartbeat.number) <= mine or heartbeat.incarnation in self.rivals:
            return False
        self.rivals.add(heartbeat.incarnation)
        self.superseded |= heartbeat.incarnation > self.incarnation
        return True
