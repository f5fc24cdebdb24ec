"""The interface of one robot's negotiation to the code that carries tasks out: begin, finish, announce, release, ...

`participant` holds the protocol by which robots agree. What is stated here is sent with the next messages that `handle`
or `tick` returns.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping

from muster.mission.errors import ParameterError
from muster.mission.model import Task
from muster.mission.value_types import shown
from muster_team.knowledge.admission import admit
from muster_team.knowledge.effects import Memory
from muster_team.knowledge.joint_statements import Members
from muster_team.knowledge.messages import AUTHORITY, Claim, Fact
from muster_team.knowledge.new_tasks import content_of
from muster_team.knowledge.orders import Orders, orders_among
from muster_team.knowledge.verdicts import Refused
from muster_team.negotiators.joint_starts import JointStarts
from muster_team.negotiators.participant import Participant


class Negotiator(Participant):
    """One robot, which takes part and carries out what it owns. Parameters as for `Participant`."""

    @property
    def rivals(self) -> set[int]:
        """Incarnations of other processes that use this robot's id."""
        return self._identity.rivals

    @property
    def superseded(self) -> bool:
        """Whether a later process uses this robot's id. Then this one sends nothing and owns nothing."""
        return self._identity.superseded

    @property
    def convicted(self) -> frozenset[str]:
        """Robots that have stated two different things."""
        return frozenset(self._convictions.evidence)

    @property
    def revoked(self) -> frozenset[str]:
        """Robots whose keys an operator has revoked."""
        return frozenset(fact.task for fact in self._owned.known.facts if fact.kind == "revoked")

    @property
    def facts(self) -> frozenset[Fact]:
        """All facts that the robot knows."""
        return frozenset(self._owned.known.facts)

    @property
    def orders(self) -> Orders:
        """The orders that the robot knows, and what became of each."""
        return orders_among(self.facts, self.rules)

    def is_final(self, order: Fact) -> bool:
        """Whether what became of an order holds for the whole team: each of its robots has declared that it knows it.

        Robots whose keys were revoked do not count. An order that a robot gives from then on comes after it. Before
        that one may turn up that comes before it.
        """
        base = self._base
        return (
            base is not None and order in base.facts and self.rules.robots.keys() - self.revoked <= base.routes.keys()
        )

    @property
    def known(self) -> int:
        """A digest of `facts`."""
        return self._owned.known.digest

    @property
    def once(self) -> frozenset[str]:
        """Tasks that must not be begun twice."""
        return self._rules.once

    @property
    def held(self) -> frozenset[str]:
        """At-most-once tasks, and tasks that wait for them, that nobody may begin until more robots are here."""
        base = self._base
        return base.held if base else frozenset()

    @property
    def route(self) -> tuple[Claim, ...]:
        """The tasks that this robot owns, in the order of execution; empty before it has heard the other robots."""
        return self._owned.left_of(self.epoch.route()) if self.latest and not self.superseded else ()

    @property
    def memory(self) -> Memory:
        """What to store for the next start; to be stored before the messages returned last are sent."""
        return self._owned.memory(self.epoch.route(), self.stage.epoch, knows=self.knows)

    def may_begin(self, task: str) -> bool:
        """Whether the robot may begin a task now.

        It must own the task by an auction that has ended, and all prerequisites must be done. For an at-most-once task
        a majority of the mission's robots must also know that this robot is going to begin it: see `begin`. What
        several robots begin at the same moment begins by their statements (`joint`), never so.
        """
        return bool(self.route) and self._owned.may_begin(task, self.epoch, self._peer_progress.shown, self.rules)

    def begin(self, task: str) -> bool:
        """Begin a task if that is allowed; return whether it has begun.

        For an at-most-once task the first call announces the intention; a later call begins once enough robots know of
        it.
        """
        if self.may_begin(task):
            self._owned.begin(task)
            return True
        if task in self._rules.once and any(claim.task == task for claim in self.route):
            self._owned.reserve(task)
        return False

    @property
    def joint(self) -> JointStarts:
        """The robot's part in tasks that several robots begin at the same moment."""
        return self._owned.joint

    def owns(self, task: str) -> bool:
        """Whether the robot owns a task that it has not done."""
        return any(claim.task == task for claim in self.route)

    def owners(self, tasks: Collection[str]) -> Members:
        """The members that own one of these tasks, each with its task; none unless an auction with it has ended."""
        return self.epoch.owners(tasks) if self.stage.ended and self.latest and not self.superseded else ()

    @property
    def spans(self) -> Mapping[str, tuple[float, float]]:
        """When tasks begin and end by what was agreed, in mission time; none unless an auction with times has ended."""
        return self.valuer.spans() if self.stage.ended and self.latest and not self.superseded else {}

    def finish(self, task: str) -> None:
        """State that the robot has done a task; of one that several begin all have stated their parts before."""
        if task in self.joint.under_way:
            self.joint.forget(task)
        else:
            self._owned.finish(task)

    def announce(self, task: Task) -> None:
        """Add a task to the mission: it is auctioned at once.

        Raises
        ------
        MissionError, ParameterError
            if the task does not fit into the mission, or there is one of its name.
        """
        orders = self.orders
        given = {
            f.task for f, verdict in orders.verdicts.items() if f.kind == "added" and not isinstance(verdict, Refused)
        }
        if task.id in {*self.rules.tasks, *given}:
            raise ParameterError(f"new task: {shown(task.id)}; expected an id that no task has")
        self._check(task)
        self._owned.say(task.id, "added", content_of(task))

    def move(self, task: Task) -> None:
        """State that a task has another position.

        A robot that owns it and has not begun it gives it back for a new auction.

        Parameters
        ----------
        task
            the whole task, as it is now.

        Raises
        ------
        MissionError, ParameterError
            if the task does not fit into the mission, or no task has its id.
        """
        if task.id not in self._rules.tasks:
            raise ParameterError(f"moved task: {shown(task.id)}; expected the id of a task")
        self._check(task)
        self._owned.say_again(task.id, "moved", content_of(task))

    def cancel(self, task: str) -> None:
        """Take a task out of the mission. A robot that has begun it continues."""
        self._owned.say(task, "cancelled")

    def revoke(self, order: Fact) -> None:
        """Revoke the key of a robot for the whole team: it is counted out, and what it owned is auctioned again.

        Parameters
        ----------
        order
            as `robot_keys.revocation` makes it.

        Raises
        ------
        ParameterError
            if it is no revocation, not of a robot of the mission, or not signed by the authority in the roster.
        """
        verdict = admit(self.rules, order, self.signatures)
        if order.kind != "revoked" or isinstance(verdict, Refused):
            reason = verdict.reason if isinstance(verdict, Refused) else f"a fact of the kind {shown(order.kind)}"
            raise ParameterError(f"revocation: {reason}; expected one signed by the key of {AUTHORITY} in the roster")
        self._owned.unsent += [] if order in self._owned.known.facts else [order]
        self._learn([order])

    def abandon(self, task: str) -> None:
        """Stop a cancelled task that was begun, so that no robot waits for what depends on it."""
        self.joint.forget(task)
        self._owned.abandon(task)

    def release(self, task: str) -> None:
        """Give a task back, even one that was begun. Others may take it; this robot does not bid for it any more.

        Raises
        ------
        ParameterError
            if the task was begun and must not be begun twice.
        """
        self._owned.release(task, self._rules)

    @property
    def offers(self) -> bool:
        """Whether the robot puts what it has not begun up for sale again in the next epoch."""
        return self._owned.offers

    def offer(self, keeps: str = "") -> None:
        """Put all tasks up for sale again that the robot owns and has not begun, and bid for them like the others.

        That happens in the next epoch, for whatever reason that begins: `open_offer` is one.

        Parameters
        ----------
        keeps
            a task that it keeps all the same, as it is on its way there.
        """
        self._owned.offers, self._owned.keeps = True, keeps

    def open_offer(self) -> None:
        """Begin an epoch for what the robot offers."""
        self._owned.epoch_due |= self._owned.offers

    def withdraw(self) -> None:
        """Give back all tasks that were not begun, and do not bid any more."""
        self._owned.withdraw()

    def come_back(self) -> None:
        """Take part again after `withdraw`."""
        self._owned.withdrawn, self._owned.epoch_due = False, True

    def _check(self, task: Task) -> None:
        """Raise MissionError unless a task fits into the mission with all tasks that this robot has heard of."""
        self.valuer.check([*(fact.content for fact in self.orders.taken), content_of(task)])
