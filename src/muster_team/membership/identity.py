"""The identity of one robot process: robot id, incarnation, message number, and other processes with the same id."""

from __future__ import annotations

from dataclasses import dataclass, field

from muster_team.knowledge.messages import Heartbeat

REFUTATIONS = 3
"""How often a process raises its incarnation above one that others tell of, in its life."""

LEAP = 2**45
"""The most by which an incarnation that others tell of is above the one known: 1,000 years, as they are milliseconds.

So no number that arrives uses up all that there are.
"""


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
    refutations
        how often it may still raise its incarnation above a later one that others tell of.
    """

    robot: str
    incarnation: int
    number: int = 0
    rivals: set[int] = field(default_factory=set)
    superseded: bool = False
    may_renumber: bool = True
    refutations: int = REFUTATIONS
    _refuted: tuple[int, float] | None = None  # the incarnation before, and since when others have not accepted it

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

    def refute(self, heartbeat: Heartbeat, now: float) -> bool:
        """Take an incarnation above one that others tell of without proof; return whether that was allowed.

        What they tell may not be so. If it is, the process that started later refutes this one in turn. As it has
        refuted less before, it keeps the id.
        """
        if not self.refutations or heartbeat.incarnation <= self.incarnation:
            return False
        self._refuted = self.incarnation, now
        self.refutations, self.incarnation = self.refutations - 1, heartbeat.incarnation + 1
        return True

    def gives_way(self, heartbeat: Heartbeat, before_s: float) -> bool:
        """Fall silent if others still tell of a later process, which this one refuted before this time in vain."""
        if self._refuted is None or heartbeat.incarnation >= self.incarnation:
            self._refuted = None
            return False
        original, since_s = self._refuted
        if since_s >= before_s or heartbeat.incarnation <= original:
            return False
        self.rivals.add(heartbeat.incarnation)
        self.superseded = True
        return True

    def hear(self, heartbeat: Heartbeat) -> bool:
        """Note a heartbeat under this robot's id; return whether it shows another process that was not known yet."""
        mine = self.incarnation, self.number
        if (heartbeat.incarnation, heartbeat.number) <= mine or heartbeat.incarnation in self.rivals:
            return False
        self.rivals.add(heartbeat.incarnation)
        self.superseded |= heartbeat.incarnation > self.incarnation
        return True
