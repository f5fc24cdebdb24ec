"""What tasks that are done, or under way, mean for those that are left: who may do these, and when they may begin."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass

from muster.mission.model import Robot, Task
from muster.model.rules.lock import Lock
from muster.model.rules.relation import tied_to
from muster.model.rules.team import by_so_many
from muster.model.rules.window import Window, begun_between
from muster.state.task_ledger import Ledger

BY_WHICH_TASKS_ARE_BOUND = (Lock.word, Window.word)
"""The rules in whose terms tasks that have begun bind others: they hold in what is left, even where the mission's own
locks and windows, without which the tasks are kept, do not."""


@dataclass(frozen=True)
class Binding:
    """Which robots a task may have, as tasks related to it have begun.

    Parameters
    ----------
    only
        the robots of a task that is done by the same; None: any, empty: those cannot do it.
    never
        robots of tasks that are done by others.
    reason
        why, in words.
    """

    only: tuple[str, ...] | None = None
    never: frozenset[str] = frozenset()
    reason: str = ""

    def allows(self, robot: str) -> bool:
        return robot not in self.never and (self.only is None or robot in self.only)


UNBOUND = Binding()
"""The binding of a task that may have any robot."""


def binding_of(task: str, ledger: Ledger, under_way: Collection[str], robots: Mapping[str, Robot]) -> Binding:
    """The robots that tasks which have begun leave to one that the same robots do, or others."""
    by_the_same, by_others = ledger.model.by_the_same(task), ledger.model.by_others(task)
    if not by_the_same and not by_others:
        return UNBOUND
    same, others = (
        {name: ledger.members(name) for name in related if name in ledger.ends_s or name in under_way}
        for related in (by_the_same, by_others)
    )
    reason = tied_to(same, others)
    only = next(iter(same.values()), None)
    unfit = "" if only is None else _why_not_by(task, ledger, [robots[name] for name in only])
    if unfit:
        only, reason = (), f"{tied_to(dict([next(iter(same.items()))]), {})}, {unfit}"
    elif len(set(map(frozenset, same.values()))) > 1:
        only = ()
    return Binding(only, frozenset(robot for crew in others.values() for robot in crew), reason)


def _why_not_by(task: str, ledger: Ledger, robots: Sequence[Robot]) -> str:
    """Why these robots cannot be the crew of a task: too few or too many, or with too little of what it needs."""
    size = ledger.model.crew_size(task)
    if size is None:
        lack = ledger.model.lacking(ledger.tasks[task], robots)
        return f"who have {lack}" if lack else ""
    return "" if size == len(robots) else f"and {size} must do it"


def as_bound(task: Task, binding: Binding, ledger: Ledger, ends_s: Mapping[str, float]) -> Task:
    """A task as it is bound by those that have begun.

    One free in the number of its robots that is done by the same as another is done by all of them, and times after
    tasks that end at known times are times by the clock.
    """
    if binding.only:
        task = by_so_many(task, len(binding.only))
    spans = ledger.model.spans(task.id, ends_s).values()
    if not spans:
        return task
    return begun_between(task, max(earliest for earliest, _ in spans), min(latest for _, latest in spans))
