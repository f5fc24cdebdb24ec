"""What tasks that are done, or under way, mean for those that are left: relations, and lags that became windows."""

from __future__ import annotations

import math
from collections.abc import Collection, Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from muster.execution.timing.teams import lacking
from muster.mission.model import Robot, Task
from muster.state.task_ledger import Ledger


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


def binding_of(task: str, ledger: Ledger, under_way: Collection[str], robots: Mapping[str, Robot]) -> Binding:
    """The robots that relations leave to a task."""
    begun = {name: ledger.members(name) for name in (*ledger.ends_s, *under_way)}
    same = [name for name in _related(task, ledger, "same_robot_as") if name in begun]
    other = [name for name in _related(task, ledger, "other_robot_than") if name in begun]
    words = [f"same robot as {name} ({', '.join(begun[name])})" for name in same]
    words += [f"other robot than {name} ({', '.join(begun[name])})" for name in other]
    only = begun[same[0]] if same else None
    unfit = "" if only is None else _why_not_by(ledger.tasks[task], [robots[name] for name in only])
    if unfit:
        only, words = (), [f"{words[0]}, {unfit}"]
    elif len({frozenset(begun[name]) for name in same}) > 1:
        only = ()
    return Binding(
        only=only,
        never=frozenset(robot for name in other for robot in begun[name]),
        reason=f"relation: {', '.join(words)}" if words else "",
    )


def _why_not_by(task: Task, robots: Sequence[Robot]) -> str:
    """Why these robots cannot be the team of a task: too few or too many, or with too little of what it needs."""
    if task.needs is not None:
        lack = lacking(task, robots)
        return f"who have {lack}" if lack else ""
    size = sum(part.count for part in task.team) if task.team else task.robots_needed or 1
    return "" if size == len(robots) else f"and {size} must do it"


def with_whole_team(task: Task, binding: Binding) -> Task:
    """A task free in the number of its robots that is done by the same as another: by all of them."""
    if task.needs is None or not binding.only:
        return task
    return replace(task, needs=None, robots_needed=len(binding.only))


def _related(task: str, ledger: Ledger, relation: str) -> Iterator[str]:
    """The tasks to which a task is related, whichever of the two says so."""
    yield from getattr(ledger.tasks[task], relation)
    yield from (name for name, other in ledger.tasks.items() if task in getattr(other, relation))


def narrowed(task: Task, ledger: Ledger) -> Task:
    """A task whose lags after tasks that have ended are part of its windows; some window must be left."""
    limits = ledger.lag_limits(task.id)
    if not limits:
        return task
    earliest = max(first for first, _ in limits.values())
    latest = min(last for _, last in limits.values())
    lags = {name: lag for name, lag in task.lags.items() if name not in limits}
    windows = []
    for first, last in task.window_s or ((0.0, None),):
        first, last = max(first, earliest), min(math.inf if last is None else last, latest)
        if first <= last:
            windows.append((first, None if last == math.inf else last))
    return replace(task, window_s=tuple(windows), lags=lags) if windows else replace(task, lags=lags)
