"""The table of tasks that can never be done: a row for all tasks and robots with the same reason."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from muster.cli.tables import print_table, sequence
from muster.mission.plan import Unassigned
from muster.mission.texts.counting import counted

_MOST_ROWS = 12  # of one reason

Row = tuple[str, str, str, str]


def print_impossible(lost: Sequence[Unassigned]) -> None:
    """Print which tasks can never be done and why, reason by reason, the most frequent reason first."""
    tasks_of = _tasks_by_reason(lost)
    reasons = sorted(tasks_of, key=lambda reason: (-len(tasks_of[reason]), reason))
    counts = ", ".join(f"{reason} {len(tasks_of[reason])}" for reason in reasons)
    rows: list[Row] = []
    for reason in reasons:
        own = [row for row in _grouped(lost) if row[2] == reason]
        rows += own[:_MOST_ROWS]
        if len(own) > _MOST_ROWS:
            rows.append(("...", "", reason, f"and {counted(len(own) - _MOST_ROWS, 'more row')}; --format json has all"))
    title = f"{counted(len(lost), 'task')} that can never be done, by reason: {counts}"
    print_table(("task", "robot", "reason", "detail"), rows, title=title)


def _tasks_by_reason(lost: Sequence[Unassigned]) -> dict[str, list[str]]:
    found: dict[str, list[str]] = {}
    for item in lost:
        for reason in dict.fromkeys(reason.reason for reason in item.reasons):
            found.setdefault(reason, []).append(item.task)
    return found


def _grouped(lost: Sequence[Unassigned]) -> Iterator[Row]:
    """Rows of tasks, robots, reason and detail: robots of a task with one reason first, then tasks with the same."""
    tasks: dict[tuple[tuple[str, ...], str, str], list[str]] = {}
    for item in lost:
        robots: dict[tuple[str, str], list[str]] = {}
        for reason in item.reasons:
            robots.setdefault((reason.reason, reason.detail), []).append(reason.robot)
        for (word, detail), names in robots.items():
            tasks.setdefault((tuple(names), word, detail), []).append(item.task)
    for (group, word, detail), ids in tasks.items():
        yield sequence(ids), sequence(group), word, detail
