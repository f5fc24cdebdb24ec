"""A robot's part in an auction without a centre: what it may do with its tasks, and says of them.

How it agrees with the others who owns which is told in `participant`. What is said here is sent with what `handle` or
`tick` returns next.
"""

from __future__ import annotations

from muster.mission.errors import ParameterError
from muster.mission.model import Task
from muster.mission.value_types import shown
from muster.negotiation.effects import Memory
from muster.negotiation.epoch_base import tasks_added
from muster.negotiation.messages import Claim, Fact
from muster.negotiation.new_tasks import content_of
from muster.negotiation.participant import Participant


class Negotiator(Participant):
    """One robot: it takes part, and carries out what it owns. Parameters are those of `Participant`."""

    @property
    def rivals(self) -> set[int]:
        """Incarnations of other processes under this robot's name."""
        return self._identity.rivals

    @property
    def superseded(self) -> bool:
        """Whether a later process has this robot's name: this one is silent, and owns nothing."""
        return self._identity.superseded

    @property
    def facts(self) -> frozenset[Fact]:
        """What it knows for good."""
        return frozenset(self._work.known.facts)

    @property
    def known(self) -> int:
        """A digest of `facts`."""
        return self._work.known.digest

    @property
    def once(self) -> frozenset[str]:
        """Tasks that nobody may begin twice."""
        return self._rules.once

    @property
    def held(self) -> frozenset[str]:
        """Tasks that nobody who is here may begin, until more are here that know."""
        base = self._base
        return base.held if base else frozenset()

    @property
    def route(self) -> tuple[Claim, ...]:
        """What this robot owns, in the order in which it is going to do it; nothing before it has heard the others."""
        return self._work.left_of(self.epoch.route()) if self.epochs and not self.superseded else ()

    @property
    def memory(self) -> Memory:
        """What to keep to start again where it stopped; to be kept before what was returned last is sent."""
        return self._work.memory(self.epoch.route(), self.stage.epoch, knows=self.knows)

    def may_begin(self, task: str) -> bool:
        """Whether the robot may begin a task now.

        It must own it, by an auction that has ended, and what the task waits for must be done. Of a task that nobody
        may begin twice a majority of the mission's robots must know, too, that this robot is going to: see `begin`.
        """
        return bool(self.route) and self._work.may_begin(task, self.epoch, self._agreement.shown, self.rules)

    def begin(self, task: str) -> bool:
        """Begin a task, if the robot may; whether it has begun.

        For a task that nobody may begin twice the first call tells the others; once enough know, a later call begins.
        """
        if self.may_begin(task):
            self._work.begin(task)
            return True
        if task in self._rules.once and any(claim.task == task for claim in self.route):
            self._work.reserve(task)
        return False

    def finish(self, task: str) -> None:
        """Tell that the robot has done a task."""
        self._work.finish(task)

    def announce(self, task: Task) -> None:
        """Add a task to the mission: it is auctioned at once.

        Raises
        ------
        MissionError, ParameterError
            if the task does not fit into the mission, or there is one of its name.
        """
        if task.id in {*self.rules.tasks, *(fact.task for fact in self.facts if fact.kind == "added")}:
            raise ParameterError(f"new task: {shown(task.id)}; expected an id that no task has")
        self._check(task)
        self._work.say(task.id, "added", content_of(task))

    def move(self, task: Task) -> None:
        """Tell that a task is elsewhere: who has it and has not begun it gives it back, and it is auctioned again.

        Parameters
        ----------
        task
            the whole task, as it is now.

        Raises
        ------
        MissionError, ParameterError
            if it does not fit into the mission, or there is none of its name.
        """
        if task.id not in self._rules.tasks:
            raise ParameterError(f"moved task: {shown(task.id)}; expected the id of a task")
        self._check(task)
        self._work.say_again(task.id, "moved", content_of(task))

    def cancel(self, task: str) -> None:
        """Take a task out of the mission; who has begun it goes on."""
        self._work.say(task, "cancelled")

    def abandon(self, task: str) -> None:
        """Stop with a task that is cancelled, if it was begun: nobody waits any more for what waits for it."""
        self._work.abandon(task)

    def release(self, task: str) -> None:
        """Give a task back, also one that was begun: others may have it, this robot does not bid for it any more.

        Raises
        ------
        ParameterError
            if it was begun and nobody may begin it twice.
        """
        self._work.release(task, self._rules)

    def withdraw(self) -> None:
        """The robot is out: it gives back all that it has not begun, and does not bid any more."""
        self._work.withdraw()

    def come_back(self) -> None:
        """The robot that was out takes part again."""
        self._work.out, self._work.restless = False, True

    def _check(self, task: Task) -> None:
        """Raise MissionError unless a task fits into the mission with all tasks that this robot has heard of."""
        known = [fact.content for fact in tasks_added(self.facts, self.rules)]
        self.valuer.check([*known, content_of(task)])
