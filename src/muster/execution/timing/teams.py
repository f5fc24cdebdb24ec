"""Teams as execution has to see them: what robots still lack to do a task together, and tasks that begin together."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from muster.mission.model import Robot, Task, TeamPart
from muster.model.bottleneck import matched

_ROUNDING = 1e-9  # relative; by which abilities may be below what is needed


def lacking(task: Task, robots: Sequence[Robot]) -> str:
    """What robots lack to do a task together, in words; empty if they are enough."""
    if task.needs is not None:
        return ", ".join(_lacking_abilities(task.needs, robots))
    if task.team:
        return _lacking_part(task.team, robots)
    missing = (task.robots_needed or 1) - len(robots)
    return f"{missing} more robot{'s' if missing > 1 else ''}" if missing > 0 else ""


def _lacking_abilities(needs: Mapping[str, float], robots: Sequence[Robot]) -> Iterator[str]:
    for ability, amount in needs.items():
        have = sum((robot.abilities or {}).get(ability, 0.0) for robot in robots)
        if have < amount * (1 - _ROUNDING):
            yield f"{have:g} of {amount:g} {ability}"
    if not robots:
        yield "a robot"


def _lacking_part(parts: Sequence[TeamPart], robots: Sequence[Robot]) -> str:
    """The first part for which no robot is left."""
    places = [part for part in parts for _ in range(part.count)]
    fits = np.array([[part.fits(robot) for robot in robots] for part in places], dtype=np.bool_)
    filled = matched(fits.reshape(len(places), len(robots))).values()
    return next((f"one more {_words(part)}" for k, part in enumerate(places) if k not in filled), "")


def _words(part: TeamPart) -> str:
    sort = " ".join(word for word in (part.kind, part.type) if word) or "robot"
    return f"{sort} with {', '.join(part.requires)}" if part.requires else sort
