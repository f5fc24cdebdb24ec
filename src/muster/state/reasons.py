"""Why tasks are left out or not done, in one line a task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from muster.mission.plan import Reason
from muster.mission.task_relations import IN_ITS_PLACE

MOST_NAMED = 3
"""Robots that a reason names, and one more."""
_CANCELLED = "cancelled at "


def cancelled_at(at_s: float) -> str:
    """Return why a task is not done that was cancelled."""
    return f"{_CANCELLED}{round(at_s, 1):g} s"


def was_cancelled(reason: object) -> bool:
    """Whether a task is not done because it was cancelled; reports and events have it with those that are lost."""
    return str(reason).startswith(_CANCELLED)


def has_stand_in(reason: object) -> bool:
    """Whether a task is not done because another is in its place."""
    return str(reason).endswith(IN_ITS_PLACE)


def is_no_loss(reason: object) -> bool:
    """Whether a task that is not done was not to be done any more: it was cancelled, or another is in its place."""
    return was_cancelled(reason) or has_stand_in(reason)


def begins_with(other: str) -> str:
    """Why a task cannot begin if another cannot; how that one cannot follows."""
    return f"relation: begins with {other}"


def some_of(names: Sequence[str]) -> str:
    """Return a few names, and how many more there are."""
    left = len(names) - MOST_NAMED
    return ", ".join(names) if left <= 1 else f"{', '.join(names[:MOST_NAMED])} and {left} more"


def in_one_line(reasons: Iterable[tuple[str, str]]) -> str:
    """Say why each robot cannot: robots with the same reason together."""
    robots: dict[str, list[str]] = {}
    for robot, why in reasons:
        robots.setdefault(why, []).append(robot)
    return "; ".join(f"{why} ({some_of(names)})" for why, names in robots.items())


def reasons_in_one_line(reasons: Sequence[Reason]) -> str:
    """The reasons of a plan; one that is of no robot is in one line already."""
    if len(reasons) == 1 and not reasons[0].robot:
        return reasons[0].detail
    return in_one_line((reason.robot, f"{reason.reason}: {reason.detail}") for reason in reasons)
