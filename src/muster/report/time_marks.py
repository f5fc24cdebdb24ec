"""What a mission asks of time, as marks in a time chart: windows, deadlines, due times, lateness, and teams.

Pictures and pages draw the same marks.
"""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from datetime import datetime
from itertools import pairwise
from typing import Any

from muster.mission.model import Task
from muster.mission.values.time_types import clock_text
from muster.report.time_chart import Row, Work

WINDOW, DEADLINE, DUE, LATE, TEAM = "window", "deadline", "due", "late", "team"


@dataclass(frozen=True)
class TimeMark:
    """A mark of one task in the row of a robot that does it.

    Parameters
    ----------
    kind
        a window, from when until when work may begin; a deadline or a due time, at one time; lateness, from the due
        time to the end; or a team: from where the task begins in one row to where it begins in another.
    until_s
        seconds, as `from_s`; None: a window without end.
    to_row
        the other row of a team, else the same one.
    """

    kind: str
    task: str
    row: int
    from_s: float
    until_s: float | None
    to_row: int

    def as_dict(self, words: str) -> dict[str, Any]:
        """The mark as pages take it, with its meaning in words."""
        ends = {"from_s": self.from_s, "until_s": self.until_s}
        return {"kind": self.kind, "task": self.task, "row": self.row, "to_row": self.to_row, **ends, "words": words}


def time_marks(tasks: Iterable[Task], rows: Sequence[Row]) -> tuple[TimeMark, ...]:
    """The marks of those of these tasks that are done, and of who begins tasks together."""
    named = {task.id: task for task in tasks}
    found = [
        mark
        for number, row in enumerate(rows)
        for work in row.work
        if work.task in named
        for mark in _limits(named[work.task], number, work)
    ]
    return (*dict.fromkeys(found), *_teams(rows))  # a robot may try one task again


def _limits(task: Task, row: int, work: Work) -> Iterator[TimeMark]:
    for opens_s, closes_s in task.window_s:
        yield TimeMark(WINDOW, task.id, row, opens_s, closes_s, row)
    for kind, at_s in ((DEADLINE, task.deadline_s), (DUE, task.due_s)):
        if at_s is not None:
            yield TimeMark(kind, task.id, row, at_s, at_s, row)
    if task.due_s is not None and work.ends_s > task.due_s:
        yield TimeMark(LATE, task.id, row, task.due_s, work.ends_s, row)


def _teams(rows: Sequence[Row]) -> Iterator[TimeMark]:
    members: dict[str, list[tuple[int, Work]]] = defaultdict(list)
    for number, row in enumerate(rows):
        for work in row.work:
            members[work.task].append((number, work))
    for task, bars in members.items():
        for (above, work), (below, other) in pairwise(bars):
            if above != below:
                yield TimeMark(TEAM, task, above, work.starts_s, other.starts_s, below)


def page_marks(tasks: Iterable[Task], rows: Sequence[Row], starts_at: str | None) -> dict[str, Any]:
    """The marks as plain data for pages, and when the mission starts by its clock, seconds from midnight."""
    marks = [mark.as_dict(_words(mark, rows, starts_at)) for mark in time_marks(tasks, rows)]
    return {"marks": marks, "clock_start_s": clock_start_s(starts_at)}


def _words(mark: TimeMark, rows: Sequence[Row], starts_at: str | None) -> str:
    def told(seconds: float) -> str:
        return f"{seconds:.1f} s" if starts_at is None else clock_text(seconds, starts_at)

    if mark.kind == TEAM:
        return f"{rows[mark.row].robot} and {rows[mark.to_row].robot} do {mark.task} together"
    if mark.kind == LATE:
        return f"{mark.task} ends {(mark.until_s or mark.from_s) - mark.from_s:.1f} s after it is due"
    if mark.kind == WINDOW:
        until = "" if mark.until_s is None else f" until {told(mark.until_s)}"
        return f"{mark.task} may begin from {told(mark.from_s)}{until}"
    return f"{mark.task}: {'deadline' if mark.kind == DEADLINE else 'due'} {told(mark.from_s)}"


def clock_start_s(starts_at: str | None) -> float | None:
    """When a mission starts, seconds from midnight by its own clock; None where it does not say so."""
    if starts_at is None:
        return None
    start = datetime.fromisoformat(starts_at)
    return start.hour * 3600.0 + start.minute * 60.0 + start.second + start.microsecond / 1e6
