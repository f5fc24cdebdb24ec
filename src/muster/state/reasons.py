"""Why tasks are left out, in one line a task."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from muster.mission.plan import Reason
from muster.state.task_ledger import some_of


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
