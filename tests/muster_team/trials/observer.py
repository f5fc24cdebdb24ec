"""An observer of all robots at every moment, which reports violated guarantees.

Two robots are separated from the time at which one of them enters an epoch without the other, or restarts, until both
have the base of one epoch that contains both. Tasks that they own and begin meanwhile may clash; at any other time they
must not. An at-most-once task is never begun twice, whether robots are separated or not.
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field

from muster_team.negotiators.negotiator import Negotiator

OWNED_TWICE = "owned twice by robots that have not lost each other"
BEGUN_TWICE = "begun twice by robots that have not lost each other"
ONCE_TWICE = "at-most-once, and begun twice"
PROMISED_NEVER = (OWNED_TWICE, BEGUN_TWICE, ONCE_TWICE)


@dataclass
class Observer:
    """Observes the robots of one trial.

    Parameters
    ----------
    nodes
        the running robots, by name.
    once
        at-most-once tasks.
    """

    nodes: Mapping[str, Negotiator]
    once: set[str]
    broken: list[str] = field(default_factory=list)
    counts: Counter[str] = field(default_factory=Counter)
    begun: dict[str, list[str]] = field(default_factory=dict)
    """By task the robots that have begun it, each as often as it began it anew."""
    _lives: set[tuple[str, str]] = field(default_factory=set)  # (robot, task) begun since the robot started
    _lost: set[frozenset[str]] = field(default_factory=set)
    _entered: dict[str, int] = field(default_factory=dict)
    _based: dict[str, bytes] = field(default_factory=dict)
    _seen: dict[str, object] = field(default_factory=dict)
    _owned: dict[str, frozenset[str]] = field(default_factory=dict)

    def started(self, robot: str) -> None:
        """A robot starts or restarts."""
        self._lost |= {frozenset((robot, other)) for other in self._entered if other != robot}
        self._entered.pop(robot, None)
        self._based.pop(robot, None)

    def gone(self, robot: str) -> None:
        self._lives = {(other, task) for other, task in self._lives if other != robot}
        self._owned.pop(robot, None)
        self._seen.pop(robot, None)

    def look(self, robot: str) -> None:
        """Check what has changed after an action of a robot."""
        node = self.nodes[robot]
        self.counts["moments"] += 1
        now = node.epoch.own.epoch, node.incarnation, node.stage, node.known, node.epoch.refused
        if self._seen.get(robot) == now:
            return
        self._seen[robot] = now
        self._look_at_epoch(robot, node)
        owned = frozenset(claim.task for claim in node.route)
        for task in sorted(owned - self._owned.get(robot, frozenset())):
            if task in self.once:
                self._check_sale(node, task)
            for other, theirs in self._owned.items():
                if task in theirs and other != robot:
                    self._clash(task, robot, other)
        self._owned[robot] = owned

    def begins(self, robot: str, task: str, *, again: bool) -> None:
        """A robot begins a task; `again`: it continues it after a restart."""
        before = self.begun.setdefault(task, [])
        self._lives.add((robot, task))
        if again and robot in before:
            return
        if before and task in self.once:
            self.counts[ONCE_TWICE] += 1
            self.broken.append(f"{robot} begins {task}, begun by {', '.join(before)}")
        for other in before:
            self.counts["begun twice"] += 1
            if other != robot and frozenset((robot, other)) not in self._lost and (other, task) in self._lives:
                self.counts[BEGUN_TWICE] += 1
                self.broken.append(f"{robot} begins {task}, begun by {other}, which it has not lost")
        before.append(robot)

    def _look_at_epoch(self, robot: str, node: Negotiator) -> None:
        epoch = node.epoch
        if self._entered.get(robot) != epoch.own.epoch:
            self._entered[robot] = epoch.own.epoch
            self.counts["epochs entered"] += 1
            self._lost |= {frozenset((robot, other)) for other in self._entered if other not in epoch.own.members}
        if epoch.base is None or self._based.get(robot) == epoch.base.digest:
            return
        self._based[robot] = epoch.base.digest
        for other in epoch.own.members:
            theirs = self.nodes.get(other)
            mutual = theirs is not None and robot in theirs.epoch.own.members
            if mutual and self._based.get(other) == epoch.base.digest:
                self._lost.discard(frozenset((robot, other)))

    def _check_sale(self, node: Negotiator, task: str) -> None:
        """Check that an at-most-once task is sold only where more than half of the team is present and remembers."""
        said = [node.epoch.declaration_of(member) for member in node.epoch.own.members]
        know = sum(declared is not None and declared.knows for declared in said)
        if any(sold.task == task for sold in node.epoch.sales) and 2 * know <= len(node.rules.robots):
            self.broken.append(f"{node.robot} has bought {task}, and {know} of {len(node.rules.robots)} know")

    def _won_together(self, task: str, robot: str, other: str) -> bool:
        """Whether robots own a task of a team by the same sale."""
        owners = [self.nodes[name] for name in (robot, other)]
        return task in self.nodes[robot].rules.teams and is_of_one_sale(task, owners)

    def _clash(self, task: str, robot: str, other: str) -> None:
        if frozenset((robot, other)) in self._lost:
            self.counts["owned twice by robots that have lost each other"] += 1
            return
        if self._won_together(task, robot, other):
            return
        began = self.begun.get(task, ())
        if not (robot in began and other in began):
            self.counts[OWNED_TWICE] += 1
            self.broken.append(f"{robot} and {other} both own {task}")


def is_of_one_sale(task: str, nodes: Iterable[Negotiator]) -> bool:
    """Whether those of the robots that own a task won it in the same sale."""
    return len({(claim.price, claim.round) for node in nodes for claim in node.route if claim.task == task}) == 1
