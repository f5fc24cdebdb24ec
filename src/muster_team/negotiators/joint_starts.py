"""One robot's part in tasks that several robots begin at the same moment: ready, under way, its part done, or left."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field

from muster_team.knowledge.facts import Knowledge
from muster_team.knowledge.joint_statements import (
    Members,
    Presence,
    Start,
    absent,
    attempt_of,
    left_content,
    presences,
    start_of,
)

_MOST_DOUBLED = 4


@dataclass
class JointStarts:
    """The joint tasks of one robot.

    Parameters
    ----------
    robot, known
        its id, and the facts that it knows.
    say
        states a fact: the task, the kind and the content.

    Attributes
    ----------
    under_way
        tasks that it has begun with others, or is done with while others are not.
    """

    robot: str
    known: Knowledge
    say: Callable[[str, str, bytes], object]
    under_way: dict[str, Start] = field(default_factory=dict)
    _units: dict[str, Sequence[str]] = field(default_factory=dict)  # of tasks at which it has stated that it is ready
    _in_time: dict[str, Start] = field(default_factory=dict)  # starts of which it learned before the begin
    _late: Counter[str] = field(default_factory=Counter)  # how often it learned of a start too late

    def notice_s(self, task: str, lead_s: float) -> float:
        """The time before a begin in which all have to learn of it: longer each time that it was too short."""
        return lead_s * 2.0 ** min(self._late[task], _MOST_DOUBLED)

    def start(self, task: str, members: Members) -> Start | None:
        """The start in which the robot takes part: it knew of it in time, and it is not void since.

        `members` are those that own the tasks now; empty while that is not agreed.
        """
        start = self._in_time.get(task)
        return start if start is not None and self._holds(start, task, members) else None

    def absent(self, task: str, members: Members) -> Members:
        """Those of whom the robot does not know that they are ready to begin with it."""
        return absent(self.known.facts, self._units.get(task, (task,)), self._attempt(task), members)

    def state_ready(self, task: str, unit: Sequence[str], members: Members, from_s: float, lasts_s: float) -> None:
        """State once in each attempt that the robot is at a task, and with whom it is going to begin."""
        self._units[task] = unit
        attempt = self._attempt(task)
        own = presences(self.known.facts, unit).get((self.robot, attempt))
        if own is None or own != (task, Presence(attempt, own[1].from_s, own[1].lasts_s, members)):
            attempt += own is not None
            self.say(task, "ready", Presence(attempt, from_s, lasts_s, members).content)

    def learn_start(self, task: str, members: Members, now: float, begin: Callable[[float], float]) -> Start | None:
        """Take part in the start that follows from the statements of all; return None if its begin is past.

        `begin` says when tasks that could begin at a time do begin.
        """
        start = start_of(self.known.facts, self._units[task], self._attempt(task), members)
        if now > begin(start.from_s):
            self._late[task] += 1
            return None
        self._in_time[task] = start
        return start

    def state_again(self, task: str, members: Members, from_s: float, lasts_s: float) -> None:
        """State a higher attempt: the begin of this one is past."""
        self.say(task, "ready", Presence(self._attempt(task) + 1, from_s, lasts_s, members).content)

    def begin(self, task: str) -> None:
        """The robot has begun its part; those of tasks that are tied to it have to know."""
        start = self.under_way[task] = self._in_time[task]
        if len(self._units[task]) > 1:
            self.say(task, "joined", start.content)

    def end(self, task: str) -> bool:
        """State that the robot has done its part; return whether all have."""
        content = self.under_way[task].content
        self.say(task, "part", content)
        return self.known.is_done_by(task, content)

    def is_broken(self, task: str, members: Members, *, owned: bool) -> bool:
        """Whether a task under way has to be broken off: the team is another one, or another attempt counts.

        `members` as of `start`.
        """
        start = self.under_way[task]
        if self.known.is_done_by(task, start.content):
            return False
        return not owned or task in self.known.done or not self._holds(start, task, members)

    def _holds(self, start: Start, task: str, members: Members) -> bool:
        return start.attempt == self._attempt(task) and members in ((), start.members)

    def forget(self, task: str) -> None:
        """The robot is no longer at a task, as it is done or broken off."""
        self.under_way.pop(task, None)
        self._in_time.pop(task, None)

    def leave_all_but(self, task: str) -> None:
        """State that the robot has left the tasks at which it was ready, except for the one at which it is."""
        for left in [name for name in self._units if name != task]:
            self._leave(left, self._units.pop(left))

    def leave_of_last_life(self, units: Callable[[str], Sequence[str]]) -> None:
        """After a restart the robot is nowhere: it has left where an earlier incarnation was ready."""
        mine = {fact.task for fact in self.known.facts if fact.kind == "ready" and fact.robot == self.robot}
        for task in sorted(mine - self._units.keys()):
            self._leave(task, units(task))

    def _leave(self, task: str, unit: Sequence[str]) -> None:
        self.forget(task)
        attempt = attempt_of(self.known.facts, unit)
        ready_at, _ = presences(self.known.facts, unit).get((self.robot, attempt), ("", None))
        if ready_at == task and task not in self.known.done:  # it may be ready now at one that begins with this one
            self.say(task, "left", left_content(attempt))

    def _attempt(self, task: str) -> int:
        return attempt_of(self.known.facts, self._units.get(task, (task,)))
