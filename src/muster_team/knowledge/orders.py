"""Orders: the facts by which operators add tasks and move them, and which of them count.

Operators on two sides of a cut may each give an order that fits where it is given, and not beside the other. So whether
an order counts does not follow from where it was given. It follows from all orders that are known: in causal order each
is admitted to the mission with those that were taken before it. Robots that know the same orders find the same.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import dataclass, field, replace

from muster.mission.errors import MissionError
from muster.mission.model import Task
from muster.mission.task_relations import names_in
from muster.mission.value_types import shown
from muster_team.knowledge.facts import in_order
from muster_team.knowledge.messages import ORDERS, Fact
from muster_team.knowledge.new_tasks import task_of
from muster_team.knowledge.rules import Rules
from muster_team.knowledge.verdicts import TAKEN, Refused, Taken, Verdict, Waits


@dataclass
class Orders:
    """The orders that were looked at so far, in causal order.

    Parameters
    ----------
    rules
        the rules of the mission without them.
    verdicts
        what became of each.
    """

    rules: Rules
    verdicts: dict[Fact, Verdict] = field(default_factory=dict)
    _added: dict[str, Fact] = field(default_factory=dict)
    _moved: dict[str, Fact] = field(default_factory=dict)

    @property
    def taken(self) -> tuple[Fact, ...]:
        """The orders that count, in tie order: those that add a task, then the last move of each task."""
        return (*self._added.values(), *self._moved.values())

    @property
    def refused(self) -> Mapping[Fact, str]:
        """The orders that do not count, each with the reason; those that wait among them."""
        return {fact: verdict.reason for fact, verdict in self.verdicts.items() if not isinstance(verdict, Taken)}

    def admit(self, fact: Fact) -> Verdict:
        """Look at the next order."""
        verdict = self.verdicts[fact] = self._verdict(fact)
        if verdict == TAKEN and fact.kind == "added":
            self._added.setdefault(fact.task, fact)
        elif verdict == TAKEN:
            self._moved[fact.task] = fact
        return verdict

    def _verdict(self, fact: Fact) -> Verdict:
        try:
            task = task_of(fact.content)
        except MissionError as error:
            return Refused(str(error))
        if task.id != fact.task:
            return Refused(f"the task {shown(task.id)} under the name {shown(fact.task)}")
        if fact.kind == "added" and self._is_known(task.id):
            is_same = task.id in self._added and self._added[task.id].content == fact.content  # told to several robots
            return TAKEN if is_same else Refused(f"there is a task {shown(task.id)}")
        unknown = tuple(name for name in self._needed(fact, task) if not self._is_known(name))
        if unknown:
            return Waits(unknown)
        if fact.kind == "moved" and not self._keeps_all_but_its_place(task):
            return Refused(f"a move of {shown(task.id)} that changes more than its place")
        reason = self.rules.misfit((*(order.content for order in self.taken), fact.content))
        return Refused(reason) if reason else TAKEN

    def _is_known(self, task: str) -> bool:
        return task in self.rules.tasks or task in self._added

    def _needed(self, fact: Fact, task: Task) -> tuple[str, ...]:
        return names_in(task) if fact.kind == "added" else (task.id, *names_in(task))

    def _keeps_all_but_its_place(self, task: Task) -> bool:
        added = self._added.get(task.id)
        return added is None or replace(task_of(added.content), position=task.position) == task


def orders_among(facts: Collection[Fact], rules: Rules) -> Orders:
    """All orders among these facts, looked at in causal order."""
    orders = Orders(rules)
    for fact in in_order(fact for fact in facts if fact.kind in ORDERS):
        orders.admit(fact)
    return orders
