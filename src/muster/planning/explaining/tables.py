"""Explanations as lines and tables, as `muster explain` prints them."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from muster.allocation.remedies.remedy import Remedy
from muster.allocation.stop import Stop
from muster.mission.model import Mission
from muster.mission.plan import Plan
from muster.mission.texts.counting import counted
from muster.model.problem import Problem
from muster.planning.explaining.explanations import LeftOut, OneTask, left_out, one_task, require_fit
from muster.planning.explaining.phrases import (
    award_text,
    ignored,
    lines,
    place,
    reserve,
    short,
    shortfall_lines,
    smallest_change,
    what_then,
)


@dataclass(frozen=True)
class Table:
    """Rows of cells under the names of their columns."""

    title: str
    columns: tuple[str, ...]
    rows: tuple[tuple[str, ...], ...]


Part = str | Table
_MOST_ROWS = 2000  # of reasons, in a table for people
_CUT_SHORT = "time limit: not all was looked for"


@dataclass(frozen=True)
class Explanation:
    """What `muster explain` prints: `data` for programs, lines and tables for people."""

    data: Mapping[str, Any]
    parts: Sequence[Part]


def explained(
    mission: Mission, plan: Plan, task: str | None, ignore: Collection[str], file: str, time_limit: float
) -> Explanation:
    """Why tasks are left out of a plan; of one task, why it is done by this robot, or left out.

    After the time limit, in seconds, nothing more is looked for.

    Raises
    ------
    PlanError
        if the plan does not fit the mission; `file` names it.
    ParameterError
        if the mission has no such task.
    """
    stop = Stop(time_limit=time_limit)
    require_fit(mission, plan, file, ignore)
    if task is None:
        missing = left_out(mission, plan, ignore, stop)
        return Explanation(missing.as_dict(), tables_on_left_out(missing))
    found = one_task(mission, plan, task, ignore, stop)
    return Explanation(found.as_dict(), tables_on_task(found))


def tables_on_left_out(found: LeftOut) -> list[Part]:
    """Which tasks are left out and why, and the smallest changes with which they could be done."""
    left_out, changes = found.unassigned, found.changes
    if not left_out:
        return ["no task is left out; --task T explains a task that is done"]
    title = f"{counted(len(left_out), 'task')} left out"
    rows = tuple((item.task, r.robot, r.reason, r.detail) for item in left_out for r in item.reasons)
    shown = rows[:_MOST_ROWS]
    parts: list[Part] = [
        *ignored(found.problem),
        *shortfall_lines(found.shortfalls),
        Table(title, ("task", "robot", "reason", "detail"), shown),
        _smallest(found.problem, changes),
    ]
    if len(rows) > len(shown):
        parts.append(f"and {len(rows) - len(shown)} more reasons: --format json has all")
    if len(left_out) > len(changes):
        parts.append(f"and {len(left_out) - len(changes)} more: --task T looks for the changes for one task")
    if found.cut_short:
        bare = sum(not item.reasons for item in left_out)
        parts.append(f"{_CUT_SHORT}; {bare} of the tasks left out come without reasons")
    return parts


def tables_on_task(found: OneTask) -> list[Part]:
    """Which robot does the task, the effect of giving it to others, and the changes that each would need."""
    parts: list[Part] = [*place(found), *ignored(found.problem)]
    if found.plan.book is not None and found.award is not None:
        parts.append(award_text(found.problem, found.plan.book, found.award))
    parts += [_alternatives(found), _remedies(found)]
    if found.robot is None and (change := smallest_change(found.problem, found.remedies)):
        parts.append(change)
    if note := reserve(found.problem):
        parts.append(note)
    if found.cut_short:
        parts.append(f"{_CUT_SHORT}: what robots would need")
    return parts


def _alternatives(found: OneTask) -> Table:
    rows = tuple(
        (_named(found, other.robot), "yes", what_then(found, other))
        if other.reason is None
        else (_named(found, other.robot), "no", f"{other.reason.reason}: {other.reason.detail}")
        for other in found.alternatives
    )
    return Table("each robot, the rest of the plan as it is", ("robot", "could", "why, and what then"), rows)


def _remedies(found: OneTask) -> Table:
    rows = tuple((_named(found, r.robot), "\n".join(lines(found.problem, r))) for r in found.remedies)
    return Table(f"to do {found.task} beside all else that the plan does", ("robot", "would need"), rows)


def _smallest(problem: Problem, changes: Mapping[str, Remedy | None]) -> Table:
    rows = tuple(
        (task, "-", "none was found; --task T looks further")
        if remedy is None
        else (task, remedy.robot, short(problem, remedy))
        for task, remedy in changes.items()
    )
    return Table("smallest changes, the rest as it is", ("task", "robot", "change"), rows)


def _named(found: OneTask, robot: str) -> str:
    return f"{robot}  (now)" if robot in found.team else robot
